"""R(0) is compared with 2 max g^2 / lambda exactly, and the bound it gives holds along runs."""

from __future__ import annotations

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.laws import PersistenceFilter
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import simulate
from intermit.verify.schedule.filter_start import filter_start_claim, greatest_gain
from intermit.verify.verdict import Verdict

SCHEDULE = build_schedule([Window(F(1, 100), F(321, 100))], Hermite(), period=F(8))


def test_greatest_gain_of_the_papers_profile_is_one() -> None:
    low, high = greatest_gain(SCHEDULE)
    assert low <= 1 <= high <= low + F(1, 10**12)


@pytest.mark.parametrize(
    ("initial", "verdict"), [(F(1), Verdict.PROVED), (F(4), Verdict.PROVED), (F(401, 100), Verdict.REFUTED)]
)
def test_bound_is_met_up_to_its_edge_and_not_beyond(initial: F, verdict: Verdict) -> None:
    assert filter_start_claim(SCHEDULE, decay=F(1, 2), initial=initial).verdict is verdict


@pytest.mark.parametrize("initial", [F(1), F(6)])
def test_filter_stays_below_its_ceiling_along_a_run(initial: F) -> None:
    (ceiling,) = filter_start_claim(SCHEDULE, decay=F(1, 2), initial=initial).quantities
    body = RigidBody.from_rows([[3, 0, 0], [0, 2, 0], [0, 0, 2]])
    law = PersistenceFilter(lambda_=F(1, 2), R0=initial)
    run = simulate(law, body, SCHEDULE, quaternion=[0.8, 0, 0.6, 0], rate=[0, 0, 0], horizon=F(24))
    assert run.controller_state("R", np.linspace(0, 24, 2001)).max() <= ceiling.high * (1 + 1e-9)


def test_nonpositive_input_is_refused() -> None:
    with pytest.raises(ValueError, match="> 0"):
        filter_start_claim(SCHEDULE, decay=F(1, 2), initial=F(0))
