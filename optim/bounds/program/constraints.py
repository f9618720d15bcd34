"""How "the rate of a potential is at most 1" is put to the interior-point method."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import final

import numpy as np

from ....models.types import Array
from .interior_point import maximise_in_balls, maximise_in_halfspaces

_CORNERS = np.array([[i, j, k] for i in (-1.0, 1.0) for j in (-1.0, 1.0) for k in (-1.0, 1.0)])


class RateConstraint(ABC):
    """h(v) <= 1 at points, for rates v linear in the coefficients of a potential; one for each program."""

    @abstractmethod
    def begin(self, features: Array) -> None:
        """Constrain the first points: v = features[i] c with features (k, 3, m)."""

    @abstractmethod
    def add(self, features: Array, rates: Array, heights: Array) -> None:
        """Constrain further points, at which the last potential had these rates (k, 3) and h of them (k,)."""

    @abstractmethod
    def maximise(self, objective: Array, *, gap: float) -> Array:
        """Coefficients (m,) that maximise objective . c, to a relative gap."""


@final
class ConeConstraint(RateConstraint):
    """|v| <= 1 at every point."""

    def begin(self, features: Array) -> None:
        """Take them all."""
        self._features = features

    def add(self, features: Array, rates: Array, heights: Array) -> None:
        """Take them all."""
        del rates, heights  # the cone needs no hint where it is touched
        self._features = np.concatenate([self._features, features])

    def maximise(self, objective: Array, *, gap: float) -> Array:
        """Interior-point steps on balls; far too many points are thinned to those near their limit."""
        c = maximise_in_balls(objective, self._features, gap=gap)
        n, _, m = self._features.shape
        if n > 12 * m:
            square = ((self._features.reshape(3 * n, m) @ c).reshape(n, 3) ** 2).sum(axis=1)
            self._features = self._features[square > 0.8]
        return c


@final
class CutConstraint(RateConstraint):
    """v.H <= 1 for boundary points H of the set of momenta, added where they are violated."""

    def __init__(self, boundary: Array) -> None:
        self._boundary = boundary

    def begin(self, features: Array) -> None:
        """Cut with the H along the eight diagonals."""
        first = self._boundary[np.unique(np.argmax(_CORNERS @ self._boundary.T, axis=1))]
        self._rows = np.einsum("kim,ci->kcm", features, first).reshape(-1, features.shape[2])
        self._many = 0

    def add(self, features: Array, rates: Array, heights: Array) -> None:
        """Cut with the H along the rate, stretched to make up for h being known from above only."""
        loads = rates @ self._boundary.T
        stretch = heights / loads.max(axis=1)
        cuts = self._boundary[loads.argmax(axis=1)] * stretch[:, None]
        self._rows = np.concatenate([self._rows, np.einsum("kim,ki->km", features, cuts)])

    def maximise(self, objective: Array, *, gap: float) -> Array:
        """Interior-point steps on halfspaces; idle cuts are dropped, rarely: they may be needed again."""
        c = maximise_in_halfspaces(objective, self._rows, gap=gap)
        if len(self._rows) > self._many:
            self._rows = self._rows[self._rows @ c > 0.6]
            self._many = max(2 * len(self._rows), 60 * len(c))
        return c
