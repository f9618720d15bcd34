"""Optima known in closed form or from the literature, found from a blind start and checked."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.optim.peak import MultiStart, Refinement, SequentialConvex, Standing, minimum_peak
from intermit.optim.peak.search.guess import first_guess
from intermit.optim.peak.transcription.mesh import build_mesh
from intermit.optim.peak.transcription.scaling import scale
from intermit.optim.peak.transcription.shooting import Shooting
from problems import UNIT
from transfers import HALF_TURN_TIME, open_transfer, paper_transfer

ONE = MultiStart(starts=1)


@pytest.mark.parametrize(
    ("angle", "axis"),
    [(0.7, (0, 0, 1)), (2.1, (1, 2, -1)), (math.pi, (1, 1, 0)), (math.pi, (0.3, -0.2, 0.9))],
)
def test_unit_inertia_euclidean_is_four_angle_over_time_squared(angle, axis):
    answer = minimum_peak(open_transfer(angle, axis, Fraction("7.3"), EUCLIDEAN), search=ONE)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak == pytest.approx(4 * angle / 7.3**2, rel=1e-6)
    assert answer.peak >= 4 * angle / 7.3**2 * (1 - 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("seed", [0, 100, 200])
def test_half_turn_of_the_cube_beats_the_eigenaxis_trap(seed):
    problem = open_transfer(math.pi, (0, 0, 1), HALF_TURN_TIME, LARGEST_COMPONENT)
    answer = minimum_peak(problem, search=MultiStart(starts=4, seed=seed))
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak == pytest.approx(1.0, abs=5e-4)
    trap = minimum_peak(problem, search=ONE)
    assert trap.peak == pytest.approx(4 * math.pi / float(HALF_TURN_TIME) ** 2, rel=1e-5)
    assert answer.search.spread > 0.15


@pytest.mark.parametrize(("norm", "expected"), [(LARGEST_COMPONENT, 0.0119761), (EUCLIDEAN, 0.0189998)])
def test_paper_scenario_on_ten_equal_cells_a_window(norm, expected):
    problem = paper_transfer(norm)
    mesh = build_mesh(problem.window, [10 if shape else 1 for shape in problem.window.shapes])
    shooting = Shooting(scale(problem), mesh, 1)
    answer = SequentialConvex().solve(shooting, first_guess(shooting))
    assert answer.converged
    assert answer.peak * shooting.scaled.units.control == pytest.approx(expected, rel=1e-5)


@pytest.mark.parametrize(
    ("norm", "expected"), [(LARGEST_COMPONENT, 0.01197509699), (EUCLIDEAN, 0.01899931675)]
)
def test_paper_scenario_refined(norm, expected):
    answer = minimum_peak(paper_transfer(norm), search=ONE)
    assert answer.standing is Standing.CHECKED, answer.reason
    assert answer.peak == pytest.approx(expected, rel=1e-6)
    assert answer.flown.terminal_excess < 1e-8
    coarse = minimum_peak(paper_transfer(norm), search=ONE, refinement=Refinement(mesh_gap=1e-4))
    assert answer.peak <= coarse.peak <= answer.peak * (1 + 1e-4)


@pytest.mark.parametrize("norm", [EUCLIDEAN, pytest.param(LARGEST_COMPONENT, marks=pytest.mark.slow)])
def test_peak_scales_with_inertia_and_with_time(norm):
    rows = np.array([[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]])
    from intermit.models.rigid_body import RigidBody

    def peak(size, time):
        body = RigidBody.from_rows([[Fraction(str(x)) * size for x in row] for row in rows])
        problem = open_transfer(1.9, (1, -1, 2), Fraction("5.5") * time, norm, body=body)
        return minimum_peak(problem, search=ONE).peak

    base = peak(Fraction(1), Fraction(1))
    assert peak(Fraction(7, 3), Fraction(1)) == pytest.approx(base * 7 / 3, rel=1e-8)
    assert peak(Fraction(1), Fraction(13)) == pytest.approx(base / 169, rel=1e-8)


def test_euclidean_optimum_is_invariant_under_rotation():
    from intermit.models.rigid_body import RigidBody

    turn = np.linalg.qr(np.random.default_rng(5).normal(size=(3, 3)))[0]
    turn *= np.sign(np.linalg.det(turn))
    J, axis = np.diag([1.0, 2.0, 2.5]), np.array([0.3, 0.5, -0.8])
    plain = open_transfer(2.0, axis, Fraction(6), EUCLIDEAN, body=RigidBody.from_rows(J.tolist()))
    rotated = turn @ J @ turn.T
    body = RigidBody.from_rows(((rotated + rotated.T) / 2).tolist())
    turned = open_transfer(2.0, turn @ axis, Fraction(6), EUCLIDEAN, body=body)
    assert minimum_peak(turned, search=ONE).peak == pytest.approx(
        minimum_peak(plain, search=ONE).peak, rel=2e-6
    )
    other = open_transfer(2.0, axis, Fraction(6), EUCLIDEAN, body=UNIT)
    assert minimum_peak(other, search=ONE).peak != pytest.approx(
        minimum_peak(plain, search=ONE).peak, rel=1e-2
    )
