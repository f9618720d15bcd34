"""Support function of an intersection of ellipsoids and slabs, tabulated from above.

For K = {H'M_k H <= g_k^2} and any weights l_k >= 0 and any X, with Q = sum l_k M_k,

    h(n) <= sum_k l_k g_k sqrt(X'M_k X) + g_1 |n - Q X|_1          (first row: the ball |H| <= g_1)

by Cauchy-Schwarz row by row: an upper bound whatever the weights, sharp for the best ones, which
a multiplicative iteration finds. Between the nodes of the triangulated octahedron |n|_1 = 1 the
linear interpolation is again above h. Every operation is a float one with a margin of 1e-12.
"""

from __future__ import annotations

from functools import cached_property
from typing import final

import numpy as np
from numpy.typing import NDArray

from ....models.types import Array

Index = NDArray[np.int64]


@final
class SupportTable:
    """Upper bounds of h at the nodes i + j + k = parts of the eight octants, and interpolation."""

    def __init__(self, matrices: Array, levels: Array, *, parts: int = 32, sweeps: int = 200) -> None:
        self.matrices, self.levels, self.parts = matrices, levels, parts
        self._octants = np.array([[i, j, k] for i in (1, -1) for j in (1, -1) for k in (1, -1)])
        i, j = np.meshgrid(np.arange(parts + 1), np.arange(parts + 1), indexing="ij")
        keep = i + j <= parts
        self._place = np.full((parts + 1, parts + 1), -1)
        self._place[keep] = np.arange(int(keep.sum()))
        simplex = np.stack([i[keep], j[keep], parts - i[keep] - j[keep]], axis=1) / parts
        half = np.concatenate([simplex * signs for signs in self._octants[:4]])
        weights = _weights(matrices, levels, half, sweeps)
        values, points = _bound_at(matrices, levels, half, weights)
        count = len(simplex)
        # h(-n) = h(n): the octant opposite to number o is 7 - o.
        blocks = [values[o * count : (o + 1) * count] for o in range(4)]
        self.values = np.stack(blocks + blocks[::-1])
        lots = [weights[o * count : (o + 1) * count] for o in range(4)]
        self.weights = np.stack(lots + lots[::-1])
        inside = (
            points
            / np.sqrt((np.einsum("ni,kij,nj->nk", points, matrices, points) / levels).max(axis=1))[:, None]
        )
        both = np.concatenate([inside, -inside])
        self.boundary = np.unique(np.round(both / np.abs(both).max(), 7), axis=0) * np.abs(both).max()

    def _locate(self, v: Array) -> tuple[Index, Index, Array, Array]:
        """Octant, cell corner (.., 3), position in the cell (.., 3), and |v|_1."""
        size = np.abs(v).sum(axis=-1)
        safe = np.where(size > 0, size, 1.0)
        octant = (v[..., 0] < 0) * 4 + (v[..., 1] < 0) * 2 + (v[..., 2] < 0) * 1
        scaled = np.abs(v) / safe[..., None] * self.parts
        corner = np.minimum(np.floor(scaled), self.parts).astype(np.int64)
        return octant, corner, scaled - corner, size

    def interpolated(self, v: Array) -> Array:
        """Upper bound of h(v), (..., 3) -> (...)."""
        octant, corner, position, size = self._locate(v)
        i, j = corner[..., 0], corner[..., 1]
        missing = self.parts - corner.sum(axis=-1)
        a, b, c = position[..., 0], position[..., 1], position[..., 2]
        up = missing == 1

        def node(di: int, dj: int) -> Array:
            row, column = np.minimum(i + di, self.parts), np.minimum(j + dj, self.parts)
            place = self._place[row, column]
            return np.where(place >= 0, self.values[octant, np.maximum(place, 0)], np.inf)

        def weighted(weight: Array, value: Array) -> Array:
            return np.where(weight > 0, weight * np.where(weight > 0, value, 0.0), 0.0)

        first = weighted(a, node(1, 0)) + weighted(b, node(0, 1)) + weighted(c, node(0, 0))
        second = weighted(1 - a, node(0, 1)) + weighted(1 - b, node(1, 0)) + weighted(1 - c, node(1, 1))
        corner_only = np.where(missing <= 0, node(0, 0), node(1, 1))
        at_node = (missing <= 0) | (missing >= 3)
        value = np.where(at_node, corner_only, np.where(up, first, second))
        return np.asarray(value * size * (1 + 1e-13))

    def above(self, v: Array) -> Array:
        """Upper bound of h(v): interpolation, or the nearest node's ellipsoid where that is less."""
        metric = self.ellipsoids(v)
        square = (np.einsum("...ij,...j->...i", metric, v) * v).sum(axis=-1)
        by_ellipsoid = np.sqrt(np.maximum(square, 0.0)) * (1 + 1e-12)
        return np.asarray(np.minimum(self.interpolated(v), by_ellipsoid))

    def ellipsoids(self, v: Array) -> Array:
        """Matrices W (n, 3, 3) with h(u)^2 <= u'W u for all u, near equality for u along v (n, 3)."""
        octant, corner, position, _ = self._locate(v)
        nearest = np.rint(corner + position).astype(np.int64)
        i = np.clip(nearest[..., 0], 0, self.parts)
        j = np.clip(nearest[..., 1], 0, self.parts - i)
        return np.asarray(self._metrics[octant, self._place[i, j]])

    @cached_property
    def _metrics(self) -> Array:
        weights = self.weights.copy()
        # A share of the ball keeps Q well conditioned, so that its inverse is good to 1e-10.
        weights = weights / (weights @ self.levels)[..., None]
        weights[..., 0] += 1e-4 / self.levels[0]
        Q = np.einsum("onk,kij->onij", weights, self.matrices)
        return np.asarray(np.linalg.inv(Q) * (weights @ self.levels)[..., None, None] * (1 + 1e-9))


def _weights(matrices: Array, levels: Array, n: Array, sweeps: int) -> Array:
    """Weights near the best for each direction n (m, 3): at the best ones l_k > 0 only on active rows."""
    weights = np.ones((len(n), len(levels))) / levels / len(levels)
    ridge = 1e-13 * np.eye(3) / levels[0]
    for _ in range(sweeps):
        Q = np.einsum("nk,kij->nij", weights, matrices)
        H = np.linalg.solve(Q + ridge, n[..., None])[..., 0]
        H /= np.sqrt(np.einsum("ni,ni->n", n, H))[:, None]
        load = np.einsum("ni,kij,nj->nk", H, matrices, H) / levels
        weights = weights * np.sqrt(np.maximum(load, 0.0) + 1e-12)
        weights /= (weights @ levels)[:, None]
    return weights


def _bound_at(matrices: Array, levels: Array, n: Array, weights: Array) -> tuple[Array, Array]:
    """Proved bound of h at n for the weights, and the maximisers X."""
    Q = np.einsum("nk,kij->nij", weights, matrices)
    X = np.linalg.solve(Q + 1e-13 * np.eye(3) / levels[0], n[..., None])[..., 0]
    forms = np.einsum("ni,kij,nj->nk", X, matrices, X)
    sizes = np.abs(matrices).sum(axis=(1, 2))
    forms = np.maximum(forms, 0.0) + 1e-14 * (X * X).sum(axis=1)[:, None] * sizes
    rest = np.abs(n - np.einsum("nij,nj->ni", Q, X)).sum(axis=1) + 1e-14 * np.abs(X).sum(
        axis=1
    ) * sizes.max() * (np.abs(weights).sum(axis=1))
    value = (weights * np.sqrt(levels) * np.sqrt(forms)).sum(axis=1) + np.sqrt(levels[0]) * rest
    return value * (1 + 1e-12), X
