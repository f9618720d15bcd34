r"""Sets of momenta that free motion leaves alone: what a torque set of any shape can reach.

Let T be the set of torques of unit peak and K a convex set with K = -K that contains T and is
mapped into itself by free motion H' = H x J^-1 H. The gauge of K is constant in free motion and
grows (and shrinks) at most p w under torque in p w T. Since |H|^2 and H'J^-1 H are both
conserved, every set {H'M_k H <= g_k^2} with M_k = a I + b J^-1 >= 0 will do, and the least g_k
that lets T in is the largest t'M_k t over the vertices t of T, a convex function. The three rows

    I,   J^-1 - c I,   C I - J^-1      (c <= 1/Jmax, C >= 1/Jmin, rational)

give all the others. For J = c I it is the ball around T. Rows e_i e_i' <= beta_i^2 (no longer
invariant) cut the set down where something else is known about the components.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cached_property
from typing import final

import numpy as np

from ....models.norms import Norm
from ....models.rigid_body import RigidBody
from ....models.types import Array
from ....verify.exact.ball import length, square_root
from ....verify.exact.matrix import Matrix, quadratic_form, shifted, unit
from ..program.constraints import CutConstraint, RateConstraint
from .chart import Vector
from .momentum_sets import (
    MomentumSet,
    Row,
    TaylorBoxes,
    greatest_inertia_above,
    has_equal_inertias,
    least_inertia_below,
    sharpened,
)
from .support_table import SupportTable


@final
class GaugeSet(MomentumSet):
    """{H : H'M_k H <= g_k^2 for every row k}, the first row being the identity.

    Attributes
    ----------
    matrices : tuple of exact (3, 3)
        M_k >= 0.
    levels : tuple of Fraction
        g_k^2 > 0.
    """

    def __init__(
        self,
        body: RigidBody,
        matrices: tuple[Matrix, ...],
        levels: tuple[Fraction, ...],
        speed: Fraction,
        pairs: tuple[tuple[Fraction, Fraction], ...],
        speed_multipliers: tuple[Fraction, ...],
    ) -> None:
        self.body, self.matrices, self.levels = body, matrices, levels
        self.pairs, self.speed_multipliers = pairs, speed_multipliers
        self._speed = speed

    @property
    def rows(self) -> tuple[Row, ...]:
        """The matrices with their levels."""
        return tuple(zip(self.matrices, self.levels, strict=True))

    @cached_property
    def float_rows(self) -> tuple[Array, Array]:
        """Matrices (k, 3, 3) and levels (k,) in floats."""
        M = np.array([[[float(x) for x in row] for row in matrix] for matrix in self.matrices])
        return M, np.array([float(g) for g in self.levels])

    @cached_property
    def table(self) -> SupportTable:
        """Support function at the nodes of a triangulated octahedron."""
        return SupportTable(*self.float_rows)

    def support_above(self, v: Array) -> Array:
        """Less of the piecewise linear interpolation and of the nearest node's ellipsoid."""
        return self.table.above(v)

    def support_over_boxes(self, boxes: TaylorBoxes, enough: float) -> Array:
        """Bound by the nearest ellipsoid, or by components or corners where that is less."""
        bound = boxes.by_square(self.table.ellipsoids(boxes.middle))
        bound = sharpened(bound, boxes, enough, lambda part: part.by_components(self.widths()))
        return sharpened(bound, boxes, enough, lambda part: part.by_corners(self))

    @cached_property
    def _widths(self) -> Array:
        return self.table.above(np.eye(3)) * (1 + 1e-12)

    def widths(self) -> Array:
        """Support along the axes."""
        return self._widths

    def fastest_rate(self) -> Fraction:
        """Bound from the invariant rows: J^-2 <= (c + C)(J^-1 - c I) + c^2 I."""
        return self._speed

    def straight_travel(self, axis: Array, angle: float) -> float:
        """Gauge of J axis times angle."""
        H = self.body.inertia @ axis / np.linalg.norm(axis)
        M, g = self.float_rows
        return float(np.sqrt((np.einsum("i,kij,j->k", H, M, H) / g).max()) * angle)

    def _squares(self, momentum: Vector) -> list[Fraction]:
        return [quadratic_form(M, momentum) / g for M, g in self.rows]

    def size_above(self, momentum: Vector) -> Fraction:
        """Largest sqrt(H'M_k H)/g_k, rounded up."""
        return max(square_root(x)[1] for x in self._squares(momentum)) if any(momentum) else Fraction(0)

    def size_below(self, momentum: Vector) -> Fraction:
        """Largest sqrt(H'M_k H)/g_k, rounded down."""
        return max(square_root(x)[0] for x in self._squares(momentum))

    def size_of_rate(self, rate: Fraction) -> Fraction:
        """Bound through |J w| <= Jmax |w| and the trace of each row."""
        if not rate:
            return Fraction(0)
        factors = [
            square_root((M[0][0] + M[1][1] + M[2][2] if k else Fraction(1)) / g)[1]
            for k, (M, g) in enumerate(zip(self.matrices, self.levels, strict=True))
        ]
        return greatest_inertia_above(self.body) * rate * max(factors)

    def constraint(self) -> RateConstraint:
        """Cuts by boundary points."""
        return CutConstraint(self.table.boundary)

    def key(self) -> tuple[object, ...]:
        """Body and rows."""
        return ("gauge", self.body.exact_inertia, self.matrices, self.levels)

    def with_box(self, half_widths: Sequence[Fraction]) -> GaugeSet:
        """Return the part with |H_i| <= half_widths[i]; with equal inertias all of that box, if larger.

        A ball that cuts off little more than the corners would make every proof long.
        """
        matrices, levels, speed = list(self.matrices), list(self.levels), self._speed
        reach = sum((Fraction(width) ** 2 for width in half_widths), Fraction(0))
        if len(levels) == 1 and reach > levels[0]:
            speed = square_root(speed**2 * reach / levels[0])[1]
            levels[0] = reach
        for i, width in enumerate(half_widths):
            matrices.append(unit(i))
            levels.append(Fraction(width) ** 2)
        parts = tuple(matrices), tuple(levels)
        return GaugeSet(self.body, *parts, speed, self.pairs, self.speed_multipliers)


def invariant_set(body: RigidBody, norm: Norm) -> GaugeSet:
    """Build the invariant set of a norm whose torques have corners around them.

    Raises
    ------
    ValueError
        If they have none, as those of the Euclidean ball (which is its own invariant set).
    """
    vertices = norm.corners()
    inverse = body.exact_inverse
    low = 1 / greatest_inertia_above(body)
    high = 1 / least_inertia_below(body)
    one, zero = Fraction(1), Fraction(0)
    pairs, ways = [(one, zero)], [[high**2]]
    if not has_equal_inertias(body):
        pairs += [(-low, one), (high, -one)]
        ways = [[high**2, zero, zero], [low**2, low + high, zero]]
    rows = tuple(shifted(inverse, b, -a) for a, b in pairs)
    levels = tuple(max(quadratic_form(row, t) for t in vertices) for row in rows)
    squares = [sum((x * g for x, g in zip(way, levels, strict=True)), zero) for way in ways]
    least = squares.index(min(squares))
    speed = square_root(squares[least])[1]
    return GaugeSet(body, rows, levels, speed, tuple(pairs), tuple(ways[least]))


def longest_vertex(norm: Norm) -> tuple[Fraction, Fraction]:
    """Length of the longest torque of unit peak, enclosed."""
    return max(length(t) for t in norm.corners())
