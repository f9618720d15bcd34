"""Each norm, window profile, quaternion sign and solver gives the same least peak where it must."""

from __future__ import annotations

from dataclasses import replace
from fractions import Fraction
from importlib import import_module

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, thrusters
from intermit.models.rigid_body import RigidBody
from intermit.optim.peak import (
    MultiStart,
    NonlinearProgram,
    Refinement,
    SequentialConvex,
    Standing,
    minimum_peak,
)
from intermit.optim.problem import TransferProblem, WindowProfile
from problems import J1, paper_schedule
from transfers import TETRAHEDRON, paper_transfer

ONE, TWO = MultiStart(starts=1), MultiStart(starts=2)
ROUGH = Refinement(mesh_gap=1e-5)
AXES = thrusters([[s if i == j else 0 for j in range(3)] for i in range(3) for s in (1, -1)])
"""One thruster each way along each body axis, arm 1 m."""


def peak(problem, search=ONE, **options):
    answer = minimum_peak(problem, search=search, refinement=ROUGH, **options)
    assert answer.standing is Standing.CHECKED, answer.reason
    return answer.peak


def tumbling(norm=None, *, time=1, size=1, **changes):
    """J1 tumbling by 0.1 rad/s through two windows, time and inertia scaled."""
    body = RigidBody.from_rows([[x * size for x in row] for row in J1.exact_inertia])
    problem = TransferProblem.through(
        paper_schedule(),
        body=J1,
        horizon="11.22",
        attitude=(3, 1, -1, 2),
        rate=("0.08", "-0.05", "0.04"),
        norm=norm or EUCLIDEAN,
        **changes,
    )
    window = replace(problem.window, knots=tuple(k * time for k in problem.window.knots))
    rate = tuple(w / time for w in problem.rate)
    return replace(problem, body=body, window=window, rate=rate)


def test_six_thrusters_equal_the_largest_component():
    assert peak(tumbling(AXES)) == pytest.approx(peak(tumbling(LARGEST_COMPONENT)), rel=2e-5)


def test_removing_a_thruster_never_lowers_the_force():
    answer = minimum_peak(paper_transfer(TETRAHEDRON, horizon="11.22"), search=ONE, refinement=ROUGH)
    force = answer.history.control
    assert force.min() >= 0.0
    np.testing.assert_allclose(force.max(), answer.peak, rtol=1e-12)
    torque = answer.history.base_torque
    np.testing.assert_allclose(torque, force @ TETRAHEDRON.control_matrix.T, atol=1e-15)
    more = thrusters((*TETRAHEDRON.axes, (Fraction(-1), Fraction(-1), Fraction(-1))))
    assert peak(paper_transfer(more, horizon="11.22")) < 0.99 * answer.peak


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON], ids=lambda n: n.name)
def test_profile_g_costs_more_than_the_full_window(norm):
    """W = g <= 1 with the same support, so that every torque within p g is within p."""
    full = peak(tumbling(norm))
    answer = minimum_peak(tumbling(norm, profile=WindowProfile.GAIN), search=ONE, refinement=ROUGH)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak > full * (1 + 1e-3)
    t = np.linspace(0, 11.22, 4001)
    effort = norm.peak(answer.history.torque(t))
    assert (effort <= answer.peak * paper_schedule().gain(t) * (1 + 1e-9) + 1e-12).all()
    assert effort.max() > 0.9 * answer.peak


@pytest.mark.parametrize("flip", [1, -1])
def test_the_cheaper_quaternion_sign_is_chosen(flip):
    """The same attitude written with either sign, turning on past 180 deg: one way round is the cheaper."""
    problem = replace(tumbling(), attitude=tuple(flip * Fraction(x) for x in (-1, 4, 0, 0)))
    problem = replace(problem, rate=(Fraction("0.2"), Fraction(0), Fraction(0)))
    each = {sign: peak(replace(problem, signs=(sign,)), TWO) for sign in (1, -1)}
    assert max(each.values()) > 1.05 * min(each.values())
    answer = minimum_peak(problem, search=TWO, refinement=ROUGH)
    assert answer.peak == pytest.approx(min(each.values()), rel=2e-5)
    assert answer.sign == min(each, key=each.get)


def test_tumbling_optimum_scales_with_inertia_and_time():
    base = peak(tumbling())
    assert peak(tumbling(size=Fraction(7, 3))) == pytest.approx(base * 7 / 3, rel=1e-8)
    assert peak(tumbling(time=Fraction(13))) == pytest.approx(base / 169, rel=1e-8)
    # the start rate must be scaled too
    assert peak(replace(tumbling(time=Fraction(13)), rate=tumbling().rate)) > 1.01 * base / 169


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON], ids=lambda n: n.name)
def test_both_solvers_alone_reach_the_same_refined_optimum(norm):
    problem = tumbling(norm)
    fast, reference = (peak(problem, solver=solver) for solver in (SequentialConvex(), NonlinearProgram()))
    assert fast == pytest.approx(reference, rel=2e-5)


def test_the_default_falls_back_on_the_reference(monkeypatch):
    problem = paper_transfer(LARGEST_COMPONENT, horizon="19.22")
    expected = peak(problem)
    module = import_module("intermit.optim.peak.search.minimum_peak")
    monkeypatch.setattr(module, "SequentialConvex", lambda: SequentialConvex(max_iterations=3))
    answer = minimum_peak(problem, search=ONE, refinement=ROUGH)
    assert answer.solver == "nonlinear program"
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak == pytest.approx(expected, rel=2e-5)
    # without the fallback the same handicap is owned up to
    alone = minimum_peak(problem, solver=SequentialConvex(max_iterations=3), search=ONE, refinement=ROUGH)
    assert alone.standing is Standing.UNDECIDED
    assert alone.reason
    assert alone.next_step


def test_a_lower_peak_that_could_not_be_checked_is_told(monkeypatch):
    finish = import_module("intermit.optim.peak.search.finish").Finish
    honest, calls = finish.__call__, []

    def doubtful(self, candidate):
        calls.append(candidate)
        answer = honest(self, candidate)
        return answer if len(calls) > 1 else replace(answer, standing=Standing.UNDECIDED, reason="doubt")

    monkeypatch.setattr(finish, "__call__", doubtful)
    problem = paper_transfer(EUCLIDEAN, horizon="11.22")
    answer = minimum_peak(problem, search=ONE, refinement=ROUGH)
    assert answer.standing is Standing.CHECKED
    assert "lower peak" in answer.reason
    assert answer.reason.endswith("doubt")
    monkeypatch.undo()
    assert not minimum_peak(problem, search=ONE, refinement=ROUGH).reason


def test_an_optimum_that_failed_its_check_is_not_refined_again(monkeypatch):
    """Both starts towards +1 find the same optimum of this problem: it is refined once."""
    finish = import_module("intermit.optim.peak.search.finish").Finish
    honest, signs = finish.__call__, []

    def doubtful(self, candidate):
        signs.append(candidate.shooting.sign)
        return replace(honest(self, candidate), standing=Standing.UNDECIDED, reason="doubt")

    monkeypatch.setattr(finish, "__call__", doubtful)
    problem = paper_transfer(EUCLIDEAN, horizon="11.22")
    answer = minimum_peak(problem, search=MultiStart(starts=2), refinement=ROUGH)
    assert answer.standing is Standing.UNDECIDED
    assert len(answer.search.starts) == 4
    assert signs.count(1) == 1
    assert -1 in signs


def test_starts_seeds_and_local_optima_are_recorded():
    answer = minimum_peak(tumbling(LARGEST_COMPONENT), search=MultiStart(starts=3, seed=7), refinement=ROUGH)
    starts = answer.search.starts
    assert [(s.sign, s.seed) for s in starts] == [(g, k) for k in (None, 7, 8) for g in (1, -1)]
    best = min(s.peak for s in starts)
    assert answer.peak <= best * (1 + 1e-9)
    assert answer.search.local_optima[0] == pytest.approx(best)
    assert answer.search.spread == pytest.approx(answer.search.local_optima[-1] / best - 1)
