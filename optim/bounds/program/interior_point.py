"""Primal-dual interior-point methods for programs with few unknowns and many simple constraints.

Maximise b.c subject to |V_i c| <= 1 (balls) or a_i.c <= 1 (halfspaces). Both take predictor and
corrector steps; every step costs one product of a tall matrix with its transpose. (A sparse
solver of cone programs takes ten times as long here: the matrix is dense and tall.) The answers
are feasible up to rounding, and trusted by no one.
"""

from __future__ import annotations

import numpy as np

from ....models.types import Array

MAX_STEPS = 60


def maximise_in_halfspaces(objective: Array, rows: Array, *, gap: float) -> Array:
    """Maximise objective . c subject to rows c <= 1, rows (n, m), to a relative gap."""
    b = objective / np.linalg.norm(objective)
    n, m = rows.shape
    c, slack = np.zeros(m), np.ones(n)
    y = np.full(n, 1.0 / n)
    for _ in range(MAX_STEPS):
        short = b - rows.T @ y
        if float(slack @ y) <= gap * max(float(b @ c), 1e-9) and np.linalg.norm(short) <= 1e-5:
            break
        weighted = rows * np.sqrt(y / slack)[:, None]
        hessian = _Factor(weighted.T @ weighted)
        # Newton: rows.T dy = short, dslack = -rows dc, y dslack + slack dy = right.
        right = -slack * y
        ds = -rows @ hessian.solve(short - rows.T @ (right / slack))
        right = _corrected(slack, y, ds, (right - y * ds) / slack)
        dc = hessian.solve(short - rows.T @ (right / slack))
        ds = -rows @ dc
        dy = (right - y * ds) / slack
        first, second = 0.99 * _longest(slack, ds), 0.99 * _longest(y, dy)
        c, slack, y = c + first * dc, slack + first * ds, y + second * dy
    largest = float((rows @ c).max())
    return c / largest if largest > 0 else c


def maximise_in_balls(objective: Array, features: Array, *, gap: float) -> Array:
    """Maximise objective . c subject to |V_i c| <= 1, features V (n, 3, m), to a relative gap.

    The constraints are taken as f_i(c) = (|V_i c|^2 - 1)/2 <= 0, with slacks of their own: their
    curvature makes them violated by the square of a step, which the next step takes back.
    """
    b = objective / np.linalg.norm(objective)
    n, _, m = features.shape
    rows = features.reshape(3 * n, m)
    c, slack = np.zeros(m), np.full(n, 0.5)
    y = np.full(n, 1.0 / n)
    v = np.zeros((n, 3))
    for _ in range(MAX_STEPS):
        over = 0.5 * (v * v).sum(axis=1) - 0.5 + slack
        short = b - rows.T @ (y[:, None] * v).ravel()
        value = max(float(b @ c), 1e-9)
        if float(slack @ y) <= gap * value and np.linalg.norm(short) <= 1e-5 and over.max() <= gap:
            break
        hessian = _Factor(_curvature(features, v, y, y / slack))
        # dy = pull + ratio (V c).(V dc) with pull = (right + y over) / slack.
        right = -slack * y
        dc = hessian.solve(short - rows.T @ (((right + y * over) / slack)[:, None] * v).ravel())
        ds = -over - (v * (rows @ dc).reshape(n, 3)).sum(axis=1)
        right = _corrected(slack, y, ds, (right - y * ds) / slack)
        dc = hessian.solve(short - rows.T @ (((right + y * over) / slack)[:, None] * v).ravel())
        ds = -over - (v * (rows @ dc).reshape(n, 3)).sum(axis=1)
        dy = (right - y * ds) / slack
        first, second = 0.99 * _longest(slack, ds), 0.99 * _longest(y, dy)
        length = min(first, second)
        c, slack, y = c + length * dc, slack + length * ds, y + length * dy
        v = (rows @ c).reshape(n, 3)
    largest = float(np.sqrt((v * v).sum(axis=1).max()))
    return c / largest if largest > 0 else c


def _curvature(features: Array, v: Array, y: Array, ratio: Array) -> Array:
    """Sum of y V'V + ratio (V'v)(V'v)': the 3 by 3 weight y I + ratio v v' is split as (p I + q v v')^2."""
    square = (v * v).sum(axis=1)
    p = np.sqrt(y)
    q = (np.sqrt(y + ratio * square) - p) / np.maximum(square, 1e-12)
    root = p[:, None, None] * np.eye(3) + (q[:, None] * v)[:, :, None] * v[:, None, :]
    tall = np.matmul(root, features).reshape(-1, features.shape[2])
    return np.asarray(tall.T @ tall)


class _Factor:
    """A positive definite matrix, a little lifted, to solve with more than once."""

    def __init__(self, matrix: Array) -> None:
        matrix[np.diag_indices_from(matrix)] += 1e-13 * np.trace(matrix) / len(matrix)
        self._inverse = np.linalg.inv(matrix)
        self._matrix = matrix

    def solve(self, right: Array) -> Array:
        """Solve by the inverse, with one step of refinement."""
        x = self._inverse @ right
        return np.asarray(x + self._inverse @ (right - self._matrix @ x))


def _corrected(slack: Array, y: Array, ds: Array, dy: Array) -> Array:
    """Right side of complementarity after the predictor (ds, dy): centred, with the product ds dy."""
    mean = float(slack @ y) / len(y)
    ahead = float((slack + _longest(slack, ds) * ds) @ (y + _longest(y, dy) * dy)) / len(y)
    return np.asarray((ahead / mean) ** 3 * mean - slack * y - ds * dy)


def _longest(x: Array, step: Array) -> float:
    """Largest share of a step (at most 1) that keeps x >= 0."""
    falling = step < 0
    return float(min(1.0, (-x[falling] / step[falling]).min())) if falling.any() else 1.0
