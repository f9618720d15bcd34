"""Sixty random transfers: inertia, windows, angles to 180 deg, tumbling starts, three norms, two profiles."""

from __future__ import annotations

import pytest
from intermit.optim.peak import MultiStart, Standing, minimum_peak, replay
from transfers import random_transfer


@pytest.mark.slow
@pytest.mark.parametrize("decade", range(6))
def test_sixty_random_transfers_are_solved(decade):
    undecided = []
    for number in range(10 * decade, 10 * decade + 10):
        answer = minimum_peak(random_transfer(number), search=MultiStart(starts=2))
        if answer.standing is not Standing.CHECKED:
            assert answer.reason
            assert answer.next_step
            undecided.append((number, answer.reason))
            continue
        again = replay(answer.problem, answer.history)
        assert again.terminal_excess <= 1e-8
        assert answer.optimality_gap <= 1e-6
        assert answer.peak == answer.history.peak
    # 58 of all sixty must be solved: at most one in each decade may be left open
    assert len(undecided) <= (1 if decade < 2 else 0), undecided
