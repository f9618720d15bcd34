"""A small interior-point method for programs with few unknowns and many simple constraints.

Maximise b.c subject to |V_i c| <= 1 (rows of three): c = 0 is strictly inside, so a
path-following logarithmic barrier with Newton steps needs no first phase, and every step costs
one product of a tall matrix with its transpose. (A sparse solver of cone programs takes ten
times as long here: the matrix is dense and tall.) For halfspaces a_i.c <= 1 there is a primal-dual
method of predictor and corrector steps. The answers are not trusted by anyone.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


GROWTH = 20.0
"""Factor between the weights of the objective in successive centrings."""


class Barrier(ABC):
    """-log of the slack of constraints on c, all satisfied strictly at c = 0."""

    @property
    @abstractmethod
    def parameter(self) -> float:
        """Barrier parameter: the gap on the central path is this over t."""

    @abstractmethod
    def scale(self, c: Array) -> float:
        """Return the least s with c / s feasible (0 if every multiple is)."""

    @abstractmethod
    def derivatives(self, c: Array) -> tuple[float, Array, Array]:
        """Value, gradient (m,) and Hessian (m, m)."""

    @abstractmethod
    def value(self, c: Array) -> float:
        """Value; inf outside."""


@final
@dataclass(frozen=True)
class BallBarrier(Barrier):
    """|V_i c| <= 1 for features (n, m, 3)."""

    rows: Array

    @classmethod
    def from_features(cls, features: Array) -> BallBarrier:
        """Lay the three rows of each point behind each other: (3 n, m)."""
        return cls(np.ascontiguousarray(features.transpose(0, 2, 1)).reshape(-1, features.shape[1]))

    @property
    def parameter(self) -> float:
        """Two for each cone."""
        return 2.0 * len(self.rows) / 3

    def scale(self, c: Array) -> float:
        """Largest |V_i c|."""
        v = (self.rows @ c).reshape(-1, 3)
        return float(np.sqrt((v * v).sum(axis=1).max()))

    def value(self, c: Array) -> float:
        """Minus the sum of log(1 - |V_i c|^2)."""
        v = (self.rows @ c).reshape(-1, 3)
        slack = 1 - (v * v).sum(axis=1)
        return float(-np.log(slack).sum()) if slack.min() > 0 else np.inf

    def derivatives(self, c: Array) -> tuple[float, Array, Array]:
        """Exact derivatives; the 3 by 3 weights a I + b v v' are split as (p I + q v v')^2."""
        v = (self.rows @ c).reshape(-1, 3)
        square = (v * v).sum(axis=1)
        slack = 1 - square
        gradient = self.rows.T @ (2 * v / slack[:, None]).ravel()
        p = np.sqrt(2 / slack)
        full = np.sqrt(2 / slack + 4 * square / slack**2)
        q = np.where(square > 1e-12, (full - p) / np.maximum(square, 1e-12), 0.0)
        blocks = self.rows.reshape(len(v), 3, -1)
        along = np.einsum("ni,nim->nm", v, blocks)
        weighted = p[:, None, None] * blocks + (q[:, None] * v)[:, :, None] * along[:, None, :]
        tall = weighted.reshape(self.rows.shape)
        return float(-np.log(slack).sum()), gradient, tall.T @ tall


def maximise_linear(objective: Array, rows: Array, *, gap: float = 1e-4, most: int = 40) -> Array:
    """Maximise objective . c subject to rows c <= 1, by predictor and corrector steps; c is feasible."""
    size = float(np.linalg.norm(objective))
    b = objective / size
    n, m = rows.shape
    c, slack = np.zeros(m), np.ones(n)
    y = np.full(n, 1.0 / n)
    for _ in range(most):
        short = b - rows.T @ y
        value = float(b @ c)
        mean = float(slack @ y) / n
        if float(slack @ y) <= gap * max(value, 1e-9) and np.linalg.norm(short) <= 1e-6:
            break
        weight = y / slack
        hessian = (rows * weight[:, None]).T @ rows
        hessian += _ridge(hessian)
        # Newton: rows.T dy = short, dslack = -rows dc, y dslack + slack dy = right.
        right = -slack * y
        dc = np.linalg.solve(hessian, short - rows.T @ (right / slack))
        ds = -rows @ dc
        dy = (right - y * ds) / slack
        first, second = _longest(slack, ds), _longest(y, dy)
        ahead = float((slack + first * ds) @ (y + second * dy)) / n
        right = (ahead / mean) ** 3 * mean - slack * y - ds * dy
        dc = np.linalg.solve(hessian, short - rows.T @ (right / slack))
        ds = -rows @ dc
        dy = (right - y * ds) / slack
        first, second = 0.99 * _longest(slack, ds), 0.99 * _longest(y, dy)
        c, slack, y = c + first * dc, slack + first * ds, y + second * dy
    largest = float((rows @ c).max())
    return c / largest if largest > 0 else c


def _longest(x: Array, step: Array) -> float:
    """Largest share of a step (at most 1) that keeps x >= 0."""
    falling = step < 0
    return float(min(1.0, (-x[falling] / step[falling]).min())) if falling.any() else 1.0


def maximise(objective: Array, barrier: Barrier, *, gap: float = 3e-4) -> Array:
    """Maximise objective . c from c = 0 to a relative gap; the answer touches a constraint."""
    c = np.zeros(len(objective))
    hessian = barrier.derivatives(c)[2]
    local = np.sqrt(max(float(objective @ np.linalg.solve(hessian + _ridge(hessian), objective)), 1e-300))
    t = 3.0 / local
    for _ in range(40):
        c = _centred(objective, barrier, c, t)
        if barrier.parameter / t <= gap * float(objective @ c):
            break
        t *= GROWTH
    size = barrier.scale(c)
    return c / size if size > 0 else c


def _centred(objective: Array, barrier: Barrier, c: Array, t: float) -> Array:
    """Newton steps towards the minimum of barrier - t objective.c."""
    for _ in range(30):
        value, gradient, hessian = barrier.derivatives(c)
        slope = gradient - t * objective
        step = -np.linalg.solve(hessian + _ridge(hessian), slope)
        decrement = -float(slope @ step)
        if decrement <= 0.3:
            return np.asarray(c + step) if np.isfinite(barrier.value(c + step)) else c
        merit = value - t * float(objective @ c)
        length = 1.0
        while length > 1e-10:
            trial = c + length * step
            if barrier.value(trial) - t * float(objective @ trial) <= merit - 0.1 * length * decrement:
                break
            length *= 0.5
        else:
            return c
        c = trial
    return c


def _ridge(hessian: Array) -> Array:
    return np.asarray(1e-13 * np.trace(hessian) / len(hessian) * np.eye(len(hessian)))
