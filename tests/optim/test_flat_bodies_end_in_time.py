"""A flat body that tumbles turns fast about its small axis: its mesh follows its energy, its work ends."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import LARGEST_COMPONENT
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.optim.peak import MultiStart, NonlinearProgram, Refinement, SequentialConvex, Standing
from intermit.optim.peak.search import finish as finishing
from intermit.optim.peak.search.finish import Finish
from intermit.optim.peak.search.guess import first_guess
from intermit.optim.peak.search.minimum_peak import coarse_mesh, minimum_peak
from intermit.optim.peak.search.result import Search
from intermit.optim.peak.transcription.mesh import build_mesh
from intermit.optim.peak.transcription.scaling import scale
from intermit.optim.peak.transcription.shooting import Shooting
from intermit.optim.problem import TransferProblem, quaternion_from_axis_angle
from transfers import paper_transfer

PLATE = RigidBody(np.diag([0.06, 3.0, 3.02]))


def tumbling(rate=(0.12, 0.15, -0.2)):
    schedule = build_schedule(
        [Window(Fraction(0), Fraction(5)), Window(Fraction(9), Fraction(14))], Hermite()
    )
    attitude = quaternion_from_axis_angle([1, 2, 1], math.radians(70))
    return TransferProblem.through(
        schedule, body=PLATE, horizon=14, attitude=attitude, rate=rate, norm=LARGEST_COMPONENT
    )


def test_no_cell_of_the_first_mesh_turns_far():
    """Half a radian at most without torque, in fewer cells than the largest ratio of inertias asks for."""
    problem = tumbling()
    mesh = coarse_mesh(problem, 36)
    shooting = Shooting(scale(problem), mesh, 1)
    still = shooting.fly(np.zeros((shooting.cells, 3)))
    speed = np.linalg.norm(still.states[:, 4:], axis=1)
    assert (np.maximum(speed[1:], speed[:-1]) * mesh.lengths).max() < 0.5
    ratio = float(PLATE.principal_inertias[-1] / PLATE.principal_inertias[0])
    assert mesh.size < 0.25 * 1.5 * ratio * np.linalg.norm(problem.start_rate) * 14 / 0.35


def finish_with(limit, monkeypatch):
    """Refine one candidate whose fast solver never converges, under a limit of work."""
    monkeypatch.setattr(finishing, "MAX_FALLBACK_WORK", limit)
    problem = paper_transfer(LARGEST_COMPONENT, horizon="11.22")
    mesh = build_mesh(problem.window, [5 if shape else 1 for shape in problem.window.shapes])
    shooting = Shooting(scale(problem), mesh, 1)
    candidate = NonlinearProgram().solve(shooting, first_guess(shooting))
    finish = Finish(problem, SequentialConvex(max_iterations=1), True, Refinement(mesh_gap=1e-4), Search(()))
    return finish, finish(candidate)


def test_the_reference_solver_stops_at_its_limit_and_says_so(monkeypatch):
    finish, answer = finish_with(1, monkeypatch)
    assert answer.standing is Standing.UNDECIDED
    assert "limit of work" in answer.reason
    assert "finer cells would still gain" in answer.reason
    assert finish.fallback.exhausted
    assert answer.history is not None


def test_within_its_limit_the_reference_solver_finishes(monkeypatch):
    finish, answer = finish_with(10**9, monkeypatch)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert not finish.fallback.exhausted
    assert finish.fallback.done > 0


@pytest.mark.slow
def test_a_tumbling_plate_has_an_answer():
    answer = minimum_peak(tumbling(), search=MultiStart(starts=1), refinement=Refinement(mesh_gap=1e-3))
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.flown.feasible
