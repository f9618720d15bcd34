"""Least impulse within a torque limit: closed form, bang-off-bang, orderings, and checks that bite."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.optim.peak import (
    MultiStart,
    Refinement,
    SequentialConvex,
    Standing,
    minimum_impulse,
    minimum_peak,
    replay,
)
from intermit.optim.peak.check.switching import switching_function
from intermit.optim.peak.search.guess import first_guess
from intermit.optim.peak.solvers.goal import LeastImpulse
from intermit.optim.peak.transcription.mesh import build_mesh
from intermit.optim.peak.transcription.scaling import scale
from intermit.optim.peak.transcription.shooting import Shooting
from transfers import TETRAHEDRON, open_transfer, paper_transfer, random_transfer

ONE = MultiStart(starts=1)
ROUGH = Refinement(mesh_gap=1e-4)
TURN, TIME = 1.2, 6.0


def bang_off_bang(limit: float) -> float:
    """Impulse of a unit inertia: full thrust for t1, coast, full thrust for t1; limit t1 (T - t1) = A.

    |w| is at most the impulse spent so far, and at most the impulse still to come, and its integral is
    at least A: spending as early, and again as late, as the limit allows does best.
    """
    return limit * (TIME - math.sqrt(TIME**2 - 4 * TURN / limit))


def found(problem, limit, **options):
    least = minimum_impulse(problem, limit, search=ONE, **options)
    assert least.found
    assert least.answer.standing is Standing.CHECKED, least.answer.reason
    assert least.answer.peak <= limit
    return least


@pytest.mark.parametrize("limit", [0.14, 0.3, 10.0])
@pytest.mark.parametrize("axis", [(0, 0, 1), (1, 2, 2)])
def test_unit_inertia_is_the_closed_form(limit, axis):
    least = found(open_transfer(TURN, axis, Fraction(6), EUCLIDEAN), limit)
    assert least.impulse == pytest.approx(bang_off_bang(limit), rel=2e-6)
    assert least.impulse >= bang_off_bang(limit) * (1 - 1e-9)
    first = least.impulse / limit / 2
    times = [t for t, _ in least.answer.switching.switch_times]
    assert times == pytest.approx([first, TIME - first], abs=1e-4 * TIME)


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT])
def test_torque_is_full_or_off_but_for_the_cells_of_a_switch(norm):
    problem = paper_transfer(norm, horizon="27.22")
    limit = 2 * minimum_peak(problem, search=ONE, refinement=ROUGH).peak
    least = found(problem, limit)
    history = least.answer.history
    control = np.abs(history.control[history.open])
    share = (np.linalg.norm(control, axis=1) if norm.is_ball else control) / limit
    between = (share > 1e-4) & (share < 1 - 1e-4)
    length = np.diff(history.edges)[history.open]
    held = between * (length if share.ndim == 1 else length[:, None])
    # each switch may fall inside one cell, which is short after refinement
    assert between.sum() <= len(least.answer.switching.switch_times) + 2
    assert held.sum() < 0.05 * length.sum()
    assert (share < 1e-4).any()


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON])
def test_more_limit_or_more_time_never_costs_impulse(norm):
    problem = paper_transfer(norm, horizon="19.22")
    peak = minimum_peak(problem, search=ONE, refinement=ROUGH)
    impulses = [found(problem, k * peak.peak, refinement=ROUGH).impulse for k in (1.001, 1.3, 2.5)]
    assert all(later < earlier for earlier, later in pairwise(impulses))
    assert impulses[-1] < peak.impulse
    longer = found(paper_transfer(norm, horizon="27.22"), 1.3 * peak.peak, refinement=ROUGH).impulse
    assert longer < impulses[1]


def test_never_below_what_the_path_needs():
    """|J w| is at most half the impulse, whatever the limit, and its integral at least Jmin angle."""
    problem = paper_transfer(EUCLIDEAN, horizon="27.22")
    least = found(problem, 1.0, refinement=ROUGH)
    floor = 2 * problem.body.principal_inertias[0] * problem.angle / float(problem.horizon)
    assert least.impulse > floor


def test_scaling_laws():
    """J -> c J with the limit c L multiplies the impulse by c; time -> s T with L / s^2 divides it by s."""
    from intermit.models.rigid_body import RigidBody

    def impulse(size, time):
        J = [[2 * size, 0, 0], [0, 3 * size, 0], [0, 0, Fraction(5, 2) * size]]
        problem = open_transfer(1.9, (1, -1, 2), 5 * time, EUCLIDEAN, body=RigidBody.from_rows(J))
        return found(problem, float(size / time**2), refinement=ROUGH).impulse

    base = impulse(Fraction(1), Fraction(1))
    assert impulse(Fraction(7, 3), Fraction(1)) == pytest.approx(base * 7 / 3, rel=1e-7)
    assert impulse(Fraction(1), Fraction(13)) == pytest.approx(base / 13, rel=1e-7)


@pytest.mark.slow
@pytest.mark.parametrize("number", [1, 3, 4, 9, 11, 22, 23, 30])
def test_random_transfers_meet_the_standard(number):
    problem = random_transfer(number)
    peak = minimum_peak(problem, search=ONE, refinement=ROUGH)
    least = minimum_impulse(problem, 1.5 * peak.peak, search=ONE, refinement=ROUGH)
    assert least.found
    assert least.answer.standing is Standing.CHECKED, least.answer.reason
    again = replay(problem, least.answer.history)
    assert again.feasible
    assert least.answer.peak <= least.limit
    assert least.impulse <= peak.impulse * (1 + 1e-6)


def test_a_limit_below_the_least_peak_is_said_so():
    problem = paper_transfer(EUCLIDEAN, horizon="11.22")
    least = minimum_impulse(problem, 1e-3, search=ONE, refinement=ROUGH)
    assert not least.found
    assert math.isinf(least.impulse)
    assert least.answer.peak > 1e-3
    with pytest.raises(ValueError, match="limit must be > 0"):
        minimum_impulse(problem, 0.0)


def test_a_start_at_the_target_spends_nothing():
    problem = paper_transfer(EUCLIDEAN, horizon="11.22")
    problem = replace(problem, attitude=tuple(Fraction(x) for x in (1, 0, 0, 0)))
    assert minimum_impulse(problem, 1.0, search=ONE).impulse == 0.0


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON])
def test_the_gap_and_the_residual_catch_a_transfer_that_wastes(norm):
    """The least-peak transfer is feasible within the limit, but no one may call its impulse least."""
    problem = paper_transfer(norm, horizon="19.22")
    mesh = build_mesh(problem.window, [10 if shape else 1 for shape in problem.window.shapes])
    shooting = Shooting(scale(problem), mesh, 1)
    wasteful = SequentialConvex().solve(shooting, first_guess(shooting))
    goal = LeastImpulse(1.5 * wasteful.peak)
    best = SequentialConvex().solve(shooting, wasteful.trajectory.control, goal=goal)
    assert best.converged
    value = goal.value(shooting, wasteful.trajectory.control)
    assert best.value < 0.95 * value
    dual, _ = goal.dual(shooting, wasteful.trajectory, wasteful.sensitivity, best.multiplier)
    assert (value - dual) / value > 0.01
    true = switching_function(best).pontryagin_residual
    false = switching_function(replace(best, trajectory=wasteful.trajectory, value=value)).pontryagin_residual
    assert 0 <= true < 0.02
    assert false > 2 * true + 0.02
