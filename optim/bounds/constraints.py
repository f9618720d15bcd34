"""How "the rate of a potential is at most 1" is put to the interior-point method."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import final

import numpy as np
from numpy.typing import NDArray

from .barrier import BallBarrier, maximise, maximise_linear

Array = NDArray[np.float64]


class RateConstraint(ABC):
    """h(v) <= 1 at points, for rates v linear in the coefficients of a potential."""

    @abstractmethod
    def maximise(self, objective: Array, features: Array) -> Array:
        """Coefficients (m,) that maximise objective . c with h(features[i] c) <= 1, features (n, m, 3)."""


@final
class ConeConstraint(RateConstraint):
    """|v| <= 1 at every point."""

    def maximise(self, objective: Array, features: Array) -> Array:
        """Interior-point steps on second-order cones."""
        return maximise(objective, BallBarrier.from_features(features))


@final
class CutConstraint(RateConstraint):
    """v.H <= 1 for boundary points H of the set of momenta, added where they are violated.

    One object serves one program: it remembers which pairs of point and H have mattered, so that
    later calls, with more points at the end, start from there.
    """

    def __init__(self, boundary: Array) -> None:
        self._boundary = boundary
        compass = np.array(
            [[i, j, k] for i in (-1, 0, 1) for j in (-1, 0, 1) for k in (-1, 0, 1)], dtype=float
        )
        corners = compass[(compass != 0).sum(axis=1) == 3]
        self._first = np.unique(np.argmax(corners @ boundary.T, axis=1))
        self._points = np.zeros(0, dtype=np.int64)
        self._cuts = np.zeros(0, dtype=np.int64)
        self._known = 0

    def maximise(self, objective: Array, features: Array) -> Array:
        """Solve, add violated cuts, and again until few are violated."""
        fresh = np.arange(self._known, len(features))
        self._points = np.concatenate([self._points, np.repeat(fresh, len(self._first))])
        self._cuts = np.concatenate([self._cuts, np.tile(self._first, len(fresh))])
        self._known = len(features)
        coefficients = np.zeros(len(objective))
        for _ in range(3):
            rows = np.einsum("nmi,ni->nm", features[self._points], self._boundary[self._cuts])
            coefficients = maximise_linear(objective, rows)
            loose = rows @ coefficients < 0.7
            rates = np.einsum("nmi,m->ni", features, coefficients) @ self._boundary.T
            highest = rates.argmax(axis=1)
            over = np.flatnonzero(rates.max(axis=1) > 1 + 1e-3)
            if len(rows) > 4 * len(features):
                self._points, self._cuts = self._points[~loose], self._cuts[~loose]
            if not len(over):
                break
            self._points = np.concatenate([self._points, over])
            self._cuts = np.concatenate([self._cuts, highest[over]])
        return coefficients
