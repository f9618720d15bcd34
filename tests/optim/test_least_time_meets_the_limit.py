"""Least transfer time within a limit: closed form, the literature, and consistency with the least peak."""

from __future__ import annotations

import math
from fractions import Fraction

import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.optim.peak import MultiStart, Refinement, Standing, minimum_peak, minimum_time
from transfers import open_transfer, paper_transfer

ONE = MultiStart(starts=1)
ROUGH = Refinement(mesh_gap=1e-5)


def test_unit_inertia_needs_sqrt_of_four_angle_over_limit():
    problem = open_transfer(1.2, (1, 2, 2), Fraction(9), EUCLIDEAN)
    found = minimum_time(problem, 0.3, search=ONE, refinement=ROUGH)
    assert found.answer.standing is Standing.CHECKED
    assert float(found.time) == pytest.approx(math.sqrt(4 * 1.2 / 0.3), rel=2e-5)
    assert found.answer.peak <= 0.3
    assert found.earlier < found.time


@pytest.mark.slow
def test_half_turn_in_the_unit_cube_takes_the_published_time():
    problem = open_transfer(math.pi, (0, 0, 1), Fraction(5), LARGEST_COMPONENT)
    found = minimum_time(
        problem, 1.0, search=MultiStart(starts=4), refinement=ROUGH, resolution=Fraction(1, 10**4)
    )
    assert float(found.time) == pytest.approx(3.2431, rel=5e-4)


def test_windows_are_respected_and_the_least_peak_confirms():
    problem = paper_transfer(EUCLIDEAN, horizon="27.22")
    limit = 1.5 * minimum_peak(problem, search=ONE, refinement=ROUGH).peak
    found = minimum_time(problem, limit, search=ONE, refinement=ROUGH, resolution=Fraction(1, 10**4))
    assert any(piece.start < found.time <= piece.end for piece in problem.open_pieces)
    assert found.answer.peak <= limit
    sooner = minimum_peak(problem.until(found.time - Fraction(1, 50)), search=ONE, refinement=ROUGH)
    assert sooner.peak > limit


def test_a_limit_that_is_too_small_is_said_so():
    problem = paper_transfer(EUCLIDEAN, horizon="11.22")
    found = minimum_time(problem, 1e-3, search=ONE, refinement=ROUGH)
    assert found.time is None
    with pytest.raises(ValueError, match="limit must be > 0"):
        minimum_time(problem, 0.0)
