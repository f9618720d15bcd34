"""What the paper says of its figures holds on the example, and fails where it should."""

from dataclasses import replace
from fractions import Fraction as F

import pytest
from intermit.optim.comparison.measure import run_law
from intermit.study.paper.statements import StartData, statements, survey
from missions import mission_from
from problems import ADAPTIVE, J1, PERSISTENCE, TILTED, paper_schedule

MISSION = mission_from(J1, paper_schedule(), TILTED, horizon=F(56))


@pytest.fixture(scope="module")
def runs():
    slow = run_law("slow", ADAPTIVE, MISSION)
    fast = run_law("fast", replace(ADAPTIVE, gamma=F(1, 2)), MISSION)
    return slow, fast, run_law("filter", PERSISTENCE, MISSION)


def test_all_five_hold_on_the_example(runs):
    assert [s.holds for s in statements(*runs)] == [True] * 5


def test_each_can_fail(runs):
    slow, fast, reference = runs
    swapped = {s.key: s.holds for s in statements(fast, slow, reference)}
    assert not swapped["gamma_peak"]
    assert not swapped["gamma_settling"]
    other = {s.key: s.holds for s in statements(reference, reference, slow)}
    assert not other["lower_in_transient"]
    wide = run_law("other filter", replace(PERSISTENCE, lambda_=F(1)), MISSION)
    assert not {s.key: s.holds for s in statements(slow, fast, wide)}["same_filter"]


def test_survey_finds_the_start_that_breaks_a_statement():
    """Tumbling with k(0) = 0, a larger gamma lowers the peak: the survey must say so."""
    choices = [StartData(30.0, 0.1, 0.525, 1.0, 0.0), StartData(120.0, 0.0, 0.525, 1.0, 0.2)]
    pairs = [tuple(replace(ADAPTIVE, k0=F(str(c.k0)), gamma=g) for g in (F(1, 10), F(1, 2))) for c in choices]
    found = {s.key: s for s in survey(MISSION, choices, pairs, [PERSISTENCE] * 2)}
    assert found["gamma_peak"].holds == 1
    assert found["gamma_peak"].failures == (choices[0],)
    assert found["lower_in_transient"].holds == 2
