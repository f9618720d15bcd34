"""Costates and switching function: signs, switch times, and Pontryagin's condition as a residual."""

from __future__ import annotations

import math
from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.optim.peak import MultiStart, Refinement, SequentialConvex, minimum_peak
from intermit.optim.peak.check.switching import GAUSS_NODES, switching_function
from intermit.optim.peak.search.guess import first_guess
from intermit.optim.peak.transcription.mesh import build_mesh
from intermit.optim.peak.transcription.scaling import scale
from intermit.optim.peak.transcription.shooting import Shooting
from transfers import HALF_TURN_TIME, TETRAHEDRON, open_transfer, paper_transfer

ONE = MultiStart(starts=1)


def solved(problem, cells):
    mesh = build_mesh(problem.window, [cells if shape else 1 for shape in problem.window.shapes])
    shooting = Shooting(scale(problem), mesh, 1)
    return SequentialConvex().solve(shooting, first_guess(shooting))


def test_bang_bang_turn_switches_once_at_half_time():
    """One axis, unit inertia: sigma is linear in time with its zero in the middle (double integrator)."""
    problem = open_transfer(1.0, (0, 0, 1), Fraction(4), LARGEST_COMPONENT)
    answer = minimum_peak(problem, search=ONE)
    times = [t for t, j in answer.switching.switch_times if j == 2]
    assert times == pytest.approx([2.0], abs=1e-6)
    t, sigma = answer.switching.times.ravel(), answer.switching.sigma[:, :, 2].ravel()
    line = np.polynomial.Polynomial.fit(t, sigma, 1)
    assert np.abs(line(t) - sigma).max() < 1e-9 * np.abs(sigma).max()
    # on cells with an edge at the switch, any zero within the cells beside it is optimal
    assert line(2.0) == pytest.approx(0.0, abs=0.05 * np.abs(sigma).max())


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON])
def test_switching_function_is_the_derivative_of_the_end(norm):
    """sigma integrated over a cell is the change of y . residual by that cell's control, by differences."""
    answer = solved(paper_transfer(norm, horizon="11.22"), 5)
    shooting, trajectory, y = answer.shooting, answer.trajectory, answer.multiplier
    step = 1e-5 * answer.peak
    for cell, j in ((0, 0), (4, 1), (7, 2)):
        ends = []
        for sign in (1, -1):
            control = trajectory.control.copy()
            control[cell, j] += sign * step
            unclipped = shooting.fly(control)
            ends.append(y @ unclipped.residual)
        if norm.limits_torque:
            slope = -(ends[0] - ends[1]) / (2 * step)
            expected = -np.einsum("i,i->", y, answer.sensitivity.terminal[:, cell, j])
            assert slope == pytest.approx(expected, rel=1e-5, abs=1e-7)
    sigma = switching_function(answer)
    w = np.stack([shooting.mesh.window_at(float(s))[sigma.cells] for s in GAUSS_NODES], axis=1)
    weights = np.polynomial.legendre.leggauss(8)[1] / 2
    integral = np.einsum("nq,nqm->nm", w * weights * sigma.length[:, None], sigma.at(GAUSS_NODES))
    expected = -np.einsum("i,ikm->km", y, answer.sensitivity.terminal)
    np.testing.assert_allclose(integral, expected, atol=1e-12 + 1e-10 * np.abs(expected).max())


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON])
def test_residual_falls_with_the_mesh_and_shows_wrong_control(norm):
    answers = [solved(paper_transfer(norm, horizon="19.22"), n) for n in (4, 16)]
    residuals = [switching_function(a).pontryagin_residual for a in answers]
    assert 0 <= residuals[1] < residuals[0] / 4
    assert residuals[1] < 1e-3
    fine = answers[1]
    wrong = replace(fine, trajectory=replace(fine.trajectory, control=fine.trajectory.control[::-1].copy()))
    assert switching_function(wrong).pontryagin_residual > 0.05
    # normalised: the integral of w support(sigma) is one
    sigma = switching_function(fine)
    assert norm.control_support(sigma.at(np.array([0.5]))).sum() > 0


def test_mesh_gap_estimate_covers_what_refinement_gains():
    problem = paper_transfer(EUCLIDEAN, horizon="19.22")
    best = minimum_peak(problem, search=ONE, refinement=Refinement(mesh_gap=2e-7)).peak
    for cells in (3, 6, 12):
        answer = solved(problem, cells)
        gained = answer.peak * answer.shooting.scaled.units.control / best - 1
        estimate = switching_function(answer).total_loss
        assert gained <= 1.5 * estimate + 4e-7
        assert estimate <= 10 * gained + 4e-7


@pytest.mark.slow
def test_half_turn_of_the_cube_has_the_known_number_of_switches():
    """Bilimoria and Wie's half turn has five switches."""
    problem = open_transfer(math.pi, (0, 0, 1), HALF_TURN_TIME, LARGEST_COMPONENT)
    answer = minimum_peak(problem, search=MultiStart(starts=6))
    assert answer.peak == pytest.approx(1.0, abs=5e-4)
    assert len(answer.switching.switch_times) == 5


def test_costates_obey_their_own_equation_on_a_free_arc():
    """Rate costates between windows, against differences of the flow: y . residual is constant along it."""
    problem = paper_transfer(LARGEST_COMPONENT, horizon="11.22")
    answer = solved(problem, 8)
    flown, y = answer.trajectory, answer.multiplier
    arc = int(np.flatnonzero(~answer.shooting.mesh.open)[1])
    first, second = (y @ answer.sensitivity.adjoint[k] for k in (arc, arc + 1))
    rng = np.random.default_rng(4)
    for _ in range(5):
        change = rng.normal(size=7) * 1e-6
        moved = []
        for sign in (1, -1):
            states = flown.states[:-1].copy()
            states[arc] += sign * change
            moved.append(answer.shooting.propagator._single_steps(states, flown.torque)[arc])
        assert first @ change == pytest.approx(second @ (moved[0] - moved[1]) / 2, rel=1e-6)


def test_a_neighbour_is_a_start():
    from intermit.optim.peak import MultiStart, minimum_peak

    first = minimum_peak(paper_transfer(EUCLIDEAN, horizon="11.22"), search=ONE)
    second = minimum_peak(paper_transfer(EUCLIDEAN, horizon="11.12"), search=MultiStart(starts=1), near=first)
    assert second.search.starts[0].iterations <= second.search.starts[1].iterations
    assert len(second.search.starts) == 3
