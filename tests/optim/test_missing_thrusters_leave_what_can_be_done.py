"""Thrusters that cannot push every way: what can be done is found, never refused unseen."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, thrusters
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.optim.peak import MultiStart, NonlinearProgram, Refinement, Standing, minimum_peak
from intermit.optim.peak.search.guess import first_guess
from intermit.optim.peak.search.minimum_peak import coarse_mesh
from intermit.optim.peak.solvers.curvature import lagrangian_curvature
from intermit.optim.peak.transcription.scaling import scale
from intermit.optim.peak.transcription.shooting import Shooting
from intermit.optim.problem import TransferProblem, quaternion_from_axis_angle
from problems import UNIT, paper_schedule
from scipy.optimize import linprog

NO_DOWN = [[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]]
ROUGH = Refinement(mesh_gap=1e-4)


def turn(rows, axis, degrees, *, body=UNIT, horizon=12):
    schedule = build_schedule([Window(Fraction(0), Fraction(horizon))], Hermite())
    attitude = quaternion_from_axis_angle(axis, math.radians(degrees))
    norm = thrusters(rows)
    return TransferProblem.through(schedule, body=body, horizon=horizon, attitude=attitude, norm=norm)


@pytest.mark.parametrize(("axis", "inertia"), [([1, 0, 0], 3.0), ([0, 1, 0], 2.0)])
def test_a_turn_about_an_axis_with_both_jets_needs_no_third(axis, inertia):
    """At most 4 J A / tf^2, by the pair about that axis alone."""
    body = RigidBody(np.diag([3.0, 2.0, 1.6]))
    answer = minimum_peak(turn(NO_DOWN, axis, 30, body=body), search=MultiStart(starts=2), refinement=ROUGH)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.flown.feasible
    assert answer.peak <= 4 * inertia * math.radians(30) / 12**2 * (1 + 1e-4)
    assert (answer.history.control >= 0).all()


def test_one_pair_alone_turns_about_its_own_axis():
    """In closed form: 4 A / tf^2 for unit inertia, and there is no other way."""
    answer = minimum_peak(turn(NO_DOWN[:2], [1, 0, 0], 30), search=MultiStart(starts=1), refinement=ROUGH)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak == pytest.approx(4 * math.radians(30) / 12**2, rel=1e-6)


def test_one_pair_alone_never_turns_about_another_axis():
    answer = minimum_peak(
        turn(NO_DOWN[:2], [0, 1, 0], 30), search=MultiStart(starts=1), refinement=Refinement(cells=8)
    )
    assert answer.standing is Standing.UNDECIDED
    assert "cannot push along" in answer.reason


@pytest.mark.parametrize("rows", [NO_DOWN[:2], NO_DOWN[:4], [[1, 2, 0], [-3, 1, 0], [0, -1, 0]]])
def test_the_peak_of_a_flat_set_is_its_least_largest_force(rows):
    """Against a linear program; a torque out of the plane is beyond any force."""
    norm = thrusters(rows)
    B, count = norm.control_matrix, len(rows)
    rng = np.random.default_rng(5)
    for force in rng.uniform(0, 1, (12, count)):
        torque = B @ force
        found = linprog(
            np.r_[np.zeros(count), 1.0],
            A_ub=np.c_[np.eye(count), -np.ones(count)],
            b_ub=np.zeros(count),
            A_eq=np.c_[B, np.zeros(3)],
            b_eq=torque,
        )
        assert float(norm.peak(torque)) == pytest.approx(found.x[-1], rel=1e-7, abs=1e-9)
        assert norm.peak(torque + np.array([0.0, 0.0, 0.1])) == np.inf


def test_no_positive_curvature_is_no_error():
    """The plane of no curvature at all: an empty set of directions, of the right width."""
    problem = turn(NO_DOWN, [1, 0, 0], 30)
    shooting = Shooting(scale(problem), coarse_mesh(problem, 8), 1)
    flight = shooting.fly(first_guess(shooting))
    found = lagrangian_curvature(shooting, flight, shooting.sensitivity(flight), np.zeros(6), 1.0)
    assert found.rows.shape == (0, 5 * shooting.cells)
    assert found.values.shape == (0,)


def test_an_inertia_of_one_two_three_through_many_windows():
    """A transfer whose Lagrangian has at some step no positive curvature."""
    problem = TransferProblem.through(
        paper_schedule(),
        body=RigidBody(np.diag([1.0, 2.0, 3.0])),
        horizon="25.2",
        attitude=quaternion_from_axis_angle([1, 1, 1], math.radians(30)),
        norm=EUCLIDEAN,
    )
    answer = minimum_peak(problem, search=MultiStart(starts=1), refinement=ROUGH)
    assert answer.standing is Standing.CHECKED, answer.reason


@pytest.mark.slow
def test_a_jet_too_weak_to_matter_is_as_none():
    """A turn about the weak axis goes round by the others, and no solver's overflow is seen."""
    weak = [*NO_DOWN, [0, 0, -1e-7]]
    answer = minimum_peak(
        turn(weak, [0, 0, 1], 30, horizon=20), search=MultiStart(starts=2), refinement=ROUGH
    )
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak <= 0.0423
    assert answer.solver in ("sequential convex program", NonlinearProgram().name)
