"""Convex sets of momenta K = -K, seen through their support function h(v) = max v.H over H in K.

A potential whose momentum rate v satisfies h(v) <= c wherever a short path can pass differs
between two attitudes by at most c times the travel, the integral of n where H(t) is in n(t) K.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from typing import final

import numpy as np
from numpy.typing import NDArray

from ....models.rigid_body import RigidBody
from ....models.types import Array
from ....verify.exact.ball import length
from ....verify.exact.matrix import Matrix, greatest_eigenvalue_above, identity, least_eigenvalue_below, rows
from ..program.constraints import ConeConstraint, RateConstraint
from .chart import Vector

IDENTITY = rows(identity(3))
_CORNERS = np.array([[i, j, k] for i in (-1.0, 1.0) for j in (-1.0, 1.0) for k in (-1.0, 1.0)])
_QUADRATIC = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))

EVALUATION_SLACK = 1e-12
"""Relative error, generously, of every float evaluation of a support function in this package."""


@final
@dataclass(frozen=True)
class TaylorBoxes:
    """Vector polynomials v(t), t in [-1, 1]^3, one for each of n boxes.

    Attributes
    ----------
    tables : array (n, 3, m)
        Coefficients in the order of `exponents`: constant, three linear, six quadratic, the rest.
    region : array (n, m)
        Those of a polynomial that is >= -slack wherever v matters.
    slack : float
        >= 0.
    """

    tables: Array
    region: Array
    slack: float

    def of(self, which: NDArray[np.int64]) -> TaylorBoxes:
        """Return some of the boxes."""
        return TaylorBoxes(self.tables[which], self.region[which], self.slack)

    @property
    def middle(self) -> Array:
        """v(0), (n, 3)."""
        return self.tables[:, :, 0]

    @property
    def linear(self) -> Array:
        """Linear part, (n, 3 components, 3 coordinates)."""
        return self.tables[:, :, 1:4]

    def by_corners(self, momenta: MomentumSet) -> Array:
        """Bound by convexity: the largest h of the linear part over the corners, plus the remainder."""
        rest = np.abs(self.tables[:, :, 4:]).sum(axis=2)
        corners = self.middle[:, None, :] + np.einsum("cj,nij->nci", _CORNERS, self.linear)
        return np.asarray(momenta.support_above(corners).max(axis=1) + rest @ momenta.widths())

    def by_square(self, metric: Array) -> Array:
        """Bound of sqrt(v' W v) with W of shape (n, 3, 3) or (3, 3), from the square's own Taylor series.

        Second-order terms of the square are formed before absolute values are taken: where a
        potential is good, v turns but hardly changes in length, and they cancel. At the edge of
        the region the square may rise steeply outwards: a multiple of the region's polynomial,
        which is not negative where v matters, is added so that the slopes cancel.
        """
        factor = np.linalg.cholesky(metric)
        tables = np.einsum("...ji,...jk->...ik", factor, self.tables)
        v, d, q = tables[:, :, 0], tables[:, :, 1:4], tables[:, :, 4:10]
        first = 2 * np.einsum("ni,nij->nj", v, d)
        second = 2 * np.einsum("ni,nij->nj", v, q)
        gram = np.einsum("nij,nik->njk", d, d)
        for place, (j, k) in enumerate(_QUADRATIC):
            second[:, place] += gram[:, j, k] * (1 if j == k else 2)
        square = [j == k for j, k in _QUADRATIC]
        size = np.abs(v)
        turn = np.abs(d).sum(axis=2)
        bend = np.abs(q).sum(axis=2)
        tail = np.abs(tables[:, :, 10:]).sum(axis=2)
        beyond = (2 * (size + turn + bend) * tail + tail * tail + 2 * turn * bend + bend * bend).sum(axis=1)
        noise = 1e-13 * ((size + turn + bend + tail) ** 2).sum(axis=1)
        fixed = (v * v).sum(axis=1) + beyond + noise
        F, slope, curve = self.region[:, 0] + self.slack, self.region[:, 1:4], self.region[:, 4:10]
        rest = np.abs(self.region[:, 10:]).sum(axis=1) + 1e-13 * np.abs(self.region).sum(axis=1)
        best = np.full(len(fixed), np.inf)
        steep = np.maximum(
            -(first * slope).sum(axis=1) / np.maximum((slope * slope).sum(axis=1), 1e-300), 0.0
        )
        for share in (0.0, 0.5, 1.0):
            factor = (share * steep)[:, None]
            bent = second + factor * curve
            known = np.where(square, np.maximum(bent, 0.0), np.abs(bent)).sum(axis=1)
            linear = np.abs(first + factor * slope).sum(axis=1)
            best = np.minimum(best, fixed + linear + known + factor[:, 0] * (F + rest))
        return np.asarray(np.sqrt(np.maximum(best, 0.0)))

    def by_components(self, widths: Array) -> Array:
        """Bound of sum widths_i |v_i|, itself above h: sharp for boxes.

        |v_i| = s_i v_i + 2 max(0, -s_i v_i) with the sign s_i at the middle, so that the terms of
        components that keep their sign are added before absolute values are taken.
        """
        signs = np.where(self.middle >= 0, 1.0, -1.0) * widths
        combined = np.einsum("ni,nik->nk", signs, self.tables)
        reach = np.abs(self.tables[:, :, 1:]).sum(axis=2) - np.abs(self.middle)
        flips = 2 * (np.maximum(reach, 0.0) * widths).sum(axis=1)
        noise = 1e-13 * (np.abs(self.tables).sum(axis=2) * widths).sum(axis=1)
        return np.asarray(combined[:, 0] + np.abs(combined[:, 1:]).sum(axis=1) + flips + noise)


def sharpened(
    bound: Array, boxes: TaylorBoxes, enough: float, other: Callable[[TaylorBoxes], Array]
) -> Array:
    """Lower a bound (n,) to another one where it is above `enough`."""
    loose = np.flatnonzero(bound > enough)
    if len(loose):
        bound[loose] = np.minimum(bound[loose], other(boxes.of(loose)))
    return bound


Row = tuple[Matrix, Fraction]
"""(M, L): H'M H <= L."""


class MomentumSet(ABC):
    """A compact convex symmetric set of momenta with 0 inside; momentum in N m s per unit of travel.

    Attributes
    ----------
    body : RigidBody
    pairs : tuple of (a, b)
        The rows a I + b J^-1 that free motion leaves alone, the first of them (1, 0).
    speed_multipliers : tuple of Fraction
        l >= 0, one of those rows each, with J^-2 <= sum l_k M_k: they prove `fastest_rate`.
    """

    body: RigidBody
    pairs: tuple[tuple[Fraction, Fraction], ...]
    speed_multipliers: tuple[Fraction, ...]

    @property
    @abstractmethod
    def rows(self) -> tuple[Row, ...]:
        """Rows that make up the set, |H|^2 <= L first; the set is {H : H'M H <= L for every row}."""

    @abstractmethod
    def support_above(self, v: Array) -> Array:
        """Upper bound of h(v), shape (..., 3) -> (...), up to the relative `EVALUATION_SLACK`."""

    @abstractmethod
    def support_over_boxes(self, boxes: TaylorBoxes, enough: float) -> Array:
        """Upper bound, box by box, of h over the boxes, up to the relative `EVALUATION_SLACK`.

        Below `enough` it need not be sharp.
        """

    @abstractmethod
    def widths(self) -> Array:
        """Upper bounds of h along the three axes, shape (3,): |H_i| <= widths[i] in K."""

    @abstractmethod
    def fastest_rate(self) -> Fraction:
        """Upper bound of max |J^-1 H| over H in K: turning rate for unit momentum scale."""

    @abstractmethod
    def straight_travel(self, axis: Array, angle: float) -> float:
        """Travel of the rotation by `angle` about a fixed axis: gauge of J axis times angle (float)."""

    @abstractmethod
    def size_above(self, momentum: Vector) -> Fraction:
        """Upper bound of the gauge of a momentum: the least n with H in n K."""

    @abstractmethod
    def size_below(self, momentum: Vector) -> Fraction:
        """Lower bound of the gauge."""

    @abstractmethod
    def size_of_rate(self, rate: Fraction) -> Fraction:
        """Upper bound of the gauge of J w over |w| <= rate."""

    @abstractmethod
    def constraint(self) -> RateConstraint:
        """How a program is told h(v) <= 1; a fresh one for each program."""

    @abstractmethod
    def key(self) -> tuple[object, ...]:
        """What the set is, for caches."""


@final
class UnitBall(MomentumSet):
    """All momenta of Euclidean length at most 1, for one body."""

    def __init__(self, body: RigidBody) -> None:
        self.body = body
        self._fastest = 1 / least_inertia_below(body)
        self.pairs, self.speed_multipliers = ((Fraction(1), Fraction(0)),), (self._fastest**2,)

    @property
    def rows(self) -> tuple[Row, ...]:
        """|H|^2 <= 1."""
        return ((IDENTITY, Fraction(1)),)

    def support_above(self, v: Array) -> Array:
        """Euclidean length."""
        return np.asarray(np.sqrt((v * v).sum(axis=-1)))

    def support_over_boxes(self, boxes: TaylorBoxes, enough: float) -> Array:
        """Bound of the square, or by corners where that is less."""
        return sharpened(boxes.by_square(np.eye(3)), boxes, enough, lambda part: part.by_corners(self))

    def widths(self) -> Array:
        """One along each axis."""
        return np.ones(3)

    def fastest_rate(self) -> Fraction:
        """Reciprocal of the least principal inertia, rounded up."""
        return self._fastest

    def straight_travel(self, axis: Array, angle: float) -> float:
        """Length of J axis times angle."""
        return float(np.linalg.norm(self.body.inertia @ axis) / np.linalg.norm(axis) * angle)

    def size_above(self, momentum: Vector) -> Fraction:
        """Length, rounded up."""
        return length(momentum)[1]

    def size_below(self, momentum: Vector) -> Fraction:
        """Length, rounded down."""
        return length(momentum)[0]

    def size_of_rate(self, rate: Fraction) -> Fraction:
        """Greatest principal inertia times the rate."""
        return greatest_inertia_above(self.body) * rate

    def constraint(self) -> RateConstraint:
        """Cones."""
        return ConeConstraint()

    def key(self) -> tuple[object, ...]:
        """Only the body matters."""
        return ("ball", self.body.exact_inertia)


@lru_cache(maxsize=64)
def least_inertia_below(body: RigidBody) -> Fraction:
    """Rational lower bound of the least principal inertia, about 1e-12 relative."""
    return least_eigenvalue_below(body.exact_inertia)


@lru_cache(maxsize=64)
def greatest_inertia_above(body: RigidBody) -> Fraction:
    """Rational upper bound of the greatest principal inertia, about 1e-12 relative."""
    return greatest_eigenvalue_above(body.exact_inertia)


def has_equal_inertias(body: RigidBody) -> bool:
    """Whether the principal inertias are equal, to 1e-6: rows of J^-1 would say no more than |H|^2 does."""
    least, greatest = least_inertia_below(body), greatest_inertia_above(body)
    return greatest - least <= greatest / 10**6
