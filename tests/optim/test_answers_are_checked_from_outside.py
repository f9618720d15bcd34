"""The check of a torque history catches what a solver might get wrong, and is done by another method."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.optim.peak import (
    MultiStart,
    NonlinearProgram,
    Refinement,
    SequentialConvex,
    Standing,
    minimum_peak,
    replay,
)
from intermit.optim.peak.search.guess import first_guess
from intermit.optim.peak.transcription.mesh import build_mesh
from intermit.optim.peak.transcription.scaling import scale
from intermit.optim.peak.transcription.shooting import Shooting
from transfers import TETRAHEDRON, paper_transfer, random_transfer

ONE = MultiStart(starts=1)
ROUGH = Refinement(mesh_gap=1e-3)


@pytest.fixture(scope="module")
def answer():
    return minimum_peak(paper_transfer(EUCLIDEAN, horizon="19.22"), search=ONE, refinement=ROUGH)


def test_a_good_history_is_feasible(answer):
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.flown.feasible
    assert answer.defect < 1e-10
    assert answer.optimality_gap < 1e-8
    assert 0 <= answer.switching.residual < 2e-3


def test_a_torque_slightly_off_is_caught(answer):
    off = replace(answer.history, control=answer.history.control * (1 + 1e-6))
    assert not replay(answer.problem, off).feasible


def test_torque_outside_the_windows_is_caught(answer):
    control = answer.history.control.copy()
    control[~answer.history.open] = 1e-9
    flown = replay(answer.problem, replace(answer.history, control=control))
    assert flown.outside_torque == pytest.approx(1e-9)
    assert not flown.feasible


def test_reported_peak_is_the_peak_of_the_history(answer):
    t = np.linspace(0, float(answer.problem.horizon), 20001)
    seen = np.linalg.norm(answer.history.torque(t), axis=-1).max()
    assert answer.peak == pytest.approx(seen, rel=1e-12)


def test_independent_integration_agrees_with_a_textbook_one(answer):
    """Euler's equations typed here by hand, integrated by a third method, cell by cell."""
    from scipy.integrate import solve_ivp

    J = answer.problem.body.inertia
    x = np.r_[answer.problem.unit_attitude, answer.problem.start_rate]
    for k, torque in enumerate(answer.history.base_torque):

        def field(t, x, torque=torque):
            b, w = x[:4], x[4:]
            rate = np.linalg.solve(J, torque - np.cross(w, J @ w))
            return np.r_[-0.5 * b[1:] @ w, 0.5 * (b[0] * w + np.cross(b[1:], w)), rate]

        span = answer.history.edges[k : k + 2]
        x = solve_ivp(field, span, x, method="Radau" if k % 7 == 0 else "RK45", rtol=1e-10, atol=1e-12).y[
            :, -1
        ]
    np.testing.assert_allclose(x, answer.flown.states[-1], atol=1e-8)


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON])
def test_two_solvers_agree_to_one_in_a_million(norm):
    problem = paper_transfer(norm, horizon="27.22")
    mesh = build_mesh(problem.window, [6 if shape else 1 for shape in problem.window.shapes])
    shooting = Shooting(scale(problem), mesh, 1)
    guess = first_guess(shooting)
    fast, reference = SequentialConvex().solve(shooting, guess), NonlinearProgram().solve(shooting, guess)
    assert fast.violation < 1e-8
    assert reference.violation < 1e-8
    assert fast.peak == pytest.approx(reference.peak, rel=1e-6)


@pytest.mark.parametrize("number", [1, 4, 5, 8, 12, 15])
def test_random_transfers_meet_the_standard(number):
    answer = minimum_peak(random_transfer(number), search=ONE, refinement=Refinement(mesh_gap=1e-4))
    assert answer.standing is Standing.CHECKED, answer.reason
