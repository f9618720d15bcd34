"""Pontryagin's boundary-value problem, solved by shooting: no mesh, no collocation, no solver of ours.

State and costate are integrated together with the torque that maximises the Hamiltonian, p w(t) in
the direction (or with the signs) of the switching function; seven unknowns (costates at the start
and p) meet six terminal conditions and the costate's normalisation. What comes out is the limit
of infinitely fine cells, to the tolerance of the integration.
"""

from __future__ import annotations

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.optim.peak import MultiStart, SequentialConvex, minimum_peak
from intermit.optim.peak.search.guess import first_guess
from intermit.optim.peak.transcription.mesh import build_mesh
from intermit.optim.peak.transcription.scaling import scale
from intermit.optim.peak.transcription.shooting import Shooting
from scipy.integrate import solve_ivp
from transfers import paper_transfer

ONE = MultiStart(starts=1)
TEN_CELLS = {"Euclidean": 0.018999822, "largest component": 0.011976125}
"""What ten equal cells a window give: a constant torque on each cannot follow the best torque."""
CONVERGED = {"Euclidean": 0.01899931675, "largest component": 0.01197509699}
NORMS = (EUCLIDEAN, LARGEST_COMPONENT)


def cross(a, b):
    return np.array([a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]])


class Extremal:
    """Euler's equations, quaternion kinematics and their adjoint, typed here by hand."""

    def __init__(self, problem):
        self.problem, self.J = problem, problem.body.inertia
        self.J_inverse = np.linalg.inv(self.J)
        self.euclidean = problem.norm.is_ball
        q = problem.unit_attitude
        # costates along the quaternion itself do nothing: three directions across it are enough
        self.across = np.linalg.svd(q[None, :])[2][1:].T

    def rate(self, y, p, signs):
        """Derivative of (b0, bv, w, their costates, integral of the support of sigma)."""
        b0, bv, w, l0, lv = y[0], y[1:4], y[4:7], y[7], y[8:11]
        sigma = self.J_inverse @ y[11:14]
        momentum = self.J @ w
        torque, size_of_gain = np.zeros(3), 0.0
        if p > 0:
            size = np.sqrt(sigma @ sigma)
            torque, size_of_gain = (p * sigma / size, size) if self.euclidean else (p * signs, signs @ sigma)
        spin = self.J_inverse @ (torque - cross(w, momentum))
        by_w = (b0 * lv - l0 * bv + cross(lv, bv)) / 2 - cross(momentum, sigma) - self.J @ cross(sigma, w)
        return np.concatenate(
            [
                [-(bv @ w) / 2],
                (b0 * w + cross(bv, w)) / 2,
                spin,
                [-(lv @ w) / 2],
                -(cross(w, lv) - l0 * w) / 2,
                -by_w,
                [size_of_gain],
            ]
        )

    def arc(self, y, start, end, p):
        """One piece, with an event wherever a component of sigma changes sign."""
        while start < end:
            sigma = self.J_inverse @ (y[11:14] + 1e-6 * self.rate(y, 0.0, None)[11:14])
            signs = np.sign(sigma)
            events = []
            if p > 0 and not self.euclidean:
                for row, sign in zip(self.J_inverse, signs, strict=True):

                    def event(t, y, row=row, sign=sign):
                        return sign * (row @ y[11:14])

                    event.terminal, event.direction = True, -1
                    events.append(event)
            part = solve_ivp(
                lambda _, y, signs=signs: self.rate(y, p, signs),
                (start, end),
                y,
                method="DOP853",
                rtol=1e-11,
                atol=1e-13,
                events=events or None,
            )
            y, start = part.y[:, -1], part.t[-1]
            self.switches += part.status == 1
        return y

    def misses(self, unknown):
        """Vector part, rate times tf, and normalisation, all zero at an extremal."""
        y = np.concatenate(
            [
                self.problem.unit_attitude,
                self.problem.start_rate,
                self.across @ unknown[:3],
                unknown[3:6],
                [0.0],
            ]
        )
        self.switches = 0
        for piece in self.problem.window.pieces:
            y = self.arc(y, float(piece.start), float(piece.end), unknown[6] if piece.shape else 0.0)
        return np.concatenate([y[1:4], y[4:7] * float(self.problem.horizon), [y[14] - 1.0]])

    def solve(self, costate, p):
        """Newton's method by differences from a guess of the costates (7,) and of p."""
        unknown = np.concatenate([self.across.T @ costate[:4], costate[4:], [p]])
        unknown[:6] /= 1.0 + self.misses(unknown)[6]
        size = np.concatenate(
            [np.full(3, np.abs(unknown[:3]).max()), np.full(3, np.abs(unknown[3:6]).max()), [p]]
        )
        for _ in range(8):
            miss = self.misses(unknown)
            if np.abs(miss).max() < 1e-8:
                break
            step = 1e-6 * size
            columns = [(self.misses(unknown + move) - miss) / move.sum() for move in np.diag(step)]
            unknown = unknown - np.linalg.solve(np.array(columns).T, miss)
        return unknown, miss


def on_equal_cells(problem, cells):
    mesh = build_mesh(problem.window, [cells if shape else 1 for shape in problem.window.shapes])
    shooting = Shooting(scale(problem), mesh, 1)
    answer = SequentialConvex().solve(shooting, first_guess(shooting))
    assert answer.converged
    return answer.peak * shooting.scaled.units.control


@pytest.mark.parametrize("norm", NORMS, ids=lambda norm: norm.name)
def test_extremal_equals_the_refined_optimum_only(norm):
    problem = paper_transfer(norm)
    answer = minimum_peak(problem, search=ONE)
    extremal = Extremal(problem)
    unknown, miss = extremal.solve(answer.switching.costate[0], answer.peak)
    assert np.abs(miss).max() < 1e-8
    p = unknown[6]
    assert p == pytest.approx(CONVERGED[norm.name], rel=1e-8)
    # constant controls on cells are admissible torques, so their peak is never below the limit
    assert p * (1 - 1e-9) <= answer.peak <= p * (1 + 1e-6)
    assert TEN_CELLS[norm.name] / p - 1 > 2e-5


@pytest.mark.parametrize("norm", NORMS, ids=lambda norm: norm.name)
def test_equal_cells_converge_to_it_from_above(norm):
    problem = paper_transfer(norm)
    excess = [on_equal_cells(problem, n) / CONVERGED[norm.name] - 1 for n in (5, 10, 20)]
    assert on_equal_cells(problem, 10) == pytest.approx(TEN_CELLS[norm.name], rel=1e-7)
    assert all(e > 0 for e in excess)
    assert excess[2] < excess[1] / 2 < excess[0] / 4
