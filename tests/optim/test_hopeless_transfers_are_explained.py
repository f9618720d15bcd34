"""Transfers that cannot be are refused with the reason; what is said of them is true."""

from __future__ import annotations

from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, thrusters
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.optim.peak import MultiStart, Refinement, Standing, minimum_peak
from intermit.optim.peak.search.explain import absorption_peak, explain, open_time, travel_peak
from intermit.optim.problem import Terminal, TransferProblem, WindowProfile
from problems import J1, UNIT, paper_schedule
from transfers import paper_transfer

ONE = MultiStart(starts=1)
ROUGH = Refinement(mesh_gap=1e-4)


def tumbling(norm, *, rate=(0.5, -0.3, 0.4), horizon="11.22", profile=WindowProfile.FULL):
    return TransferProblem.through(
        paper_schedule(),
        body=J1,
        horizon=horizon,
        attitude=(1, 1, 1, 1),
        rate=rate,
        norm=norm,
        profile=profile,
    )


def test_no_window_before_the_end():
    schedule = build_schedule([Window(Fraction(5), Fraction(6))], Hermite())
    problem = TransferProblem.through(schedule, body=UNIT, horizon=4, attitude=(1, 1, 0, 0))
    answer = minimum_peak(problem)
    assert answer.standing is Standing.IMPOSSIBLE
    assert "no thruster window opens before tf = 4 s" in answer.reason
    assert answer.next_step


def test_a_start_at_rest_at_the_target_needs_nothing():
    problem = TransferProblem.through(paper_schedule(), body=J1, horizon=8, attitude=(-1, 0, 0, 0))
    answer = minimum_peak(problem, search=ONE)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak == 0.0
    schedule = build_schedule([Window(Fraction(5), Fraction(6))], Hermite())
    before = TransferProblem.through(schedule, body=UNIT, horizon=4, attitude=(1, 0, 0, 0))
    assert minimum_peak(before).standing is Standing.CHECKED


@pytest.mark.parametrize("profile", list(WindowProfile))
@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT])
def test_the_absorption_argument_is_a_bound(norm, profile):
    """The least peak found is never below what the momentum alone needs; the sentence names both."""
    problem = tumbling(norm, profile=profile)
    needs = absorption_peak(problem)
    answer = minimum_peak(problem, search=MultiStart(starts=2), refinement=ROUGH)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert 0 < needs <= answer.peak
    said = explain(problem, 0.9 * needs)
    assert said is not None
    assert not said.impossible
    assert f"needs {needs:.3g} N m" in said.reason
    assert explain(problem, 1.1 * needs) is None


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT])
def test_the_travel_argument_is_a_bound(norm):
    for terminal in (Terminal(), Terminal(attitude=Fraction("0.1"), rate=Fraction("0.01"))):
        problem = paper_transfer(norm, horizon="11.22", terminal=terminal)
        needs = travel_peak(problem)
        answer = minimum_peak(problem, search=ONE, refinement=ROUGH)
        assert 0 < needs < answer.peak
        said = explain(problem, 0.5 * needs)
        assert said is not None
        assert "too short to turn 120 deg" in said.reason


def test_open_time_is_exact():
    problem = paper_transfer(EUCLIDEAN)
    assert open_time(problem) == 7 * Fraction("3.21")


def test_a_missing_direction_is_named_after_a_failed_search():
    one_way = thrusters([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    problem = paper_transfer(one_way, horizon="11.22")
    answer = minimum_peak(problem, search=ONE, refinement=Refinement(cells=8))
    assert answer.standing is Standing.UNDECIDED
    assert answer.search.starts
    assert "no start led to a feasible transfer" in answer.reason
    assert "cannot push along" in answer.reason
    normal = np.array([float(x) for x in answer.reason.split("(")[1].split(")")[0].split(",")])
    assert (one_way.control_matrix.T @ normal).max() <= 1e-9


@pytest.mark.parametrize(("on", "off"), [(0, 1), (30, 31)])
def test_a_short_window_far_from_an_end_is_no_obstacle(on, off):
    """At rest before and after: the same least peak wherever the window lies."""
    schedule = build_schedule([Window(Fraction(on), Fraction(off))], Hermite())
    problem = TransferProblem.through(schedule, body=UNIT, horizon=40, attitude=(1, 1, 1, 1))
    answer = minimum_peak(problem, search=ONE)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak == pytest.approx(4 * np.radians(120), rel=1e-6)
    assert answer.history.edges[-1] == 40
