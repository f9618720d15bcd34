"""Time cells: an edge at every window edge and knot, control cells inside windows, arcs outside.

A control is constant on a cell; the torque is w(t) times the control, so it follows the window's
own profile inside the cell. Cells outside the windows carry no control: they are only integrated.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from numpy.typing import NDArray

from ....models.schedule import PiecewisePolynomial
from ....models.types import Array


@final
@dataclass(frozen=True)
class Mesh:
    """Cells of [0, 1] (solver time).

    Attributes
    ----------
    edges : (n + 1,)
        Strictly increasing.
    piece : (n,) int
        Piece of the window profile each cell lies in.
    profile : (n, d + 1)
        w on each cell in s = (t - start) / length, lowest power first.
    """

    edges: Array
    piece: NDArray[np.int64]
    profile: Array

    @property
    def size(self) -> int:
        """Number of cells."""
        return len(self.piece)

    @cached_property
    def lengths(self) -> Array:
        """Cell durations, (n,)."""
        return np.diff(self.edges)

    @cached_property
    def open(self) -> NDArray[np.bool_]:
        """Whether the cell lies in a window, (n,)."""
        return np.asarray(np.any(self.profile != 0.0, axis=1))

    @cached_property
    def impulse(self) -> Array:
        """Integral of w over each cell, (n,)."""
        powers = 1.0 / np.arange(1, self.profile.shape[1] + 1)
        return np.asarray(self.lengths * (self.profile @ powers))

    def window_at(self, s: float) -> Array:
        """W at the fraction s of every cell, (n,)."""
        return np.asarray(self.profile @ s ** np.arange(self.profile.shape[1]))

    def halves(self) -> tuple[Mesh, Mesh]:
        """First and second halves of every cell: two lists of cells, not meshes of [0, 1]."""
        half = np.full(self.size, 0.5)
        parts = [_compose_affine(self.profile, shift, half) for shift in (np.zeros(self.size), half)]
        shorter = np.concatenate([[0.0], np.cumsum(self.lengths / 2)])
        return Mesh(shorter, self.piece, parts[0]), Mesh(shorter, self.piece, parts[1])


def build_mesh(window: PiecewisePolynomial, parts: Sequence[int]) -> Mesh:
    """Mesh with piece i cut into parts[i] equal cells."""
    horizon = float(window.knots[-1])
    knots = [float(k) / horizon for k in window.knots]
    edges = np.concatenate(
        [np.linspace(a, b, n + 1)[:-1] for a, b, n in zip(knots, knots[1:], parts, strict=False)]
        + [[knots[-1]]]
    )
    return mesh_on(window, edges)


def mesh_on(window: PiecewisePolynomial, edges: Array) -> Mesh:
    """Mesh with the given edges, which must include every knot of the window profile."""
    horizon = float(window.knots[-1])
    knots = np.array([float(k) / horizon for k in window.knots])
    middle = (edges[1:] + edges[:-1]) / 2
    piece = np.searchsorted(knots, middle) - 1
    degree = max((len(shape) for shape in window.shapes), default=1) - 1
    table = np.zeros((len(window.shapes), max(degree, 0) + 1))
    for row, shape in zip(table, window.shapes, strict=True):
        row[: len(shape)] = [float(c) for c in shape]
    span = np.diff(knots)[piece]
    shift, slope = (edges[:-1] - knots[piece]) / span, np.diff(edges) / span
    return Mesh(edges, piece, _compose_affine(table[piece], shift, slope))


def _compose_affine(coefficients: Array, shift: Array, slope: Array) -> Array:
    """Rows of polynomials p(shift + slope s), by Horner's rule on whole columns."""
    result = np.zeros_like(coefficients)
    for column in coefficients.T[::-1]:
        moved = np.zeros_like(result)
        moved[:, 1:] = result[:, :-1] * slope[:, None]
        result = result * shift[:, None] + moved
        result[:, 0] += column
    return result


def split(
    mesh: Mesh, window: PiecewisePolynomial, points: Sequence[Sequence[float]]
) -> tuple[Mesh, NDArray[np.int64]]:
    """Cut cell i at the fractions points[i]; returns the mesh and the old cell of each new cell."""
    edges: list[float] = []
    parents: list[int] = []
    for i, inside in enumerate(points):
        start, length = float(mesh.edges[i]), float(mesh.lengths[i])
        edges.append(start)
        edges.extend(start + length * s for s in inside)
        parents.extend([i] * (len(inside) + 1))
    edges.append(float(mesh.edges[-1]))
    return mesh_on(window, np.array(edges)), np.array(parents)
