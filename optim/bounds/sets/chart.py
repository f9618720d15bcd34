r"""Where a short path from the start to the target can be, in coordinates that keep it polynomial.

Attitudes are lifted to the unit quaternions and written as the modified Rodrigues vector x of
m^-1 q, with m near the middle between start and target. Then the kinematics are polynomial,

    x' = 1/4 [ (1 - |x|^2) I + 2 S(x) + 2 x x' ] w,

and nothing else is needed of SO(3): the lift keeps the two target signs apart.

A path of quaternion arc at most 2 s between two points at arc h on either side of m, along the
unit direction n, stays in the spherical ellipse {arc to one + arc to the other <= 2 s}. For
h <= s < pi/2 that is, with t = tan(s/2),

    |x| <= t   and   F(x) = (cos h/cos s)^2 (1 - |x|^2)^2 + 4 (sin h/sin s)^2 (n.x)^2 - (1 + |x|^2)^2 >= 0.

(cos alpha + cos beta = 2 cos h x_m and cos alpha - cos beta = 2 sin h x_n for the arcs alpha,
beta and the components x_m, x_n of the quaternion; with the half sum and half difference of the
arcs these are 2 cos cos and -2 sin sin, and F changes sign exactly where the half sum passes s.)
All data are rational, so F is exact.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import final

import numpy as np

from ....models.attitude import conjugate, quaternion_product
from ....models.types import Array
from ....verify.exact.ball import ROOT_BITS, arctangent_below, length
from ....verify.exact.direction import rational_direction, sphere_point
from ....verify.exact.polynomial import Polynomial
from ....verify.exact.rounding import grid_near
from .polynomials import RING, SQUARED_LENGTH, X

Vector = tuple[Fraction, Fraction, Fraction]
Quaternion = tuple[Fraction, Fraction, Fraction, Fraction]


@final
@dataclass(frozen=True)
class Chart:
    """Coordinates about a middle attitude, and the region of short paths in them.

    Attributes
    ----------
    middle : three Fraction
        Modified Rodrigues vector of m, any rationals.
    direction : three Fraction
        Unit vector n, exactly of length 1 (rational points on the sphere are dense).
    inner : Fraction
        tan(h/2): the model end points are x = +- inner * direction.
    outer : Fraction
        tan(s/2), inner <= outer < 1.
    """

    middle: Vector
    direction: Vector
    inner: Fraction
    outer: Fraction

    def __post_init__(self) -> None:
        if sum(c * c for c in self.direction) != 1:
            raise ValueError("the direction must be of length 1 exactly")
        if not 0 <= self.inner <= self.outer < 1:
            raise ValueError(
                f"expected 0 <= inner <= outer < 1, received {float(self.inner)}, {float(self.outer)}"
            )

    @cached_property
    def middle_quaternion(self) -> Quaternion:
        """m, exactly of length 1."""
        m = sphere_point(self.middle)
        return m[0], m[1], m[2], m[3]

    @cached_property
    def region(self) -> Polynomial:
        """F in the scaled coordinates x / outer: >= 0 wherever a path of half arc s can pass."""
        cos_h, sin_h = sphere_point([self.inner])
        cos_s, sin_s = sphere_point([self.outer])
        square = SQUARED_LENGTH * self.outer**2
        along = sum((x * (self.outer * c) for x, c in zip(X, self.direction, strict=True)), RING.constant(0))
        first = (1 - square) ** 2 * (cos_h / cos_s) ** 2
        second = along**2 * (4 * (sin_h / sin_s) ** 2 if self.inner else 0)
        return first + second - (1 + square) ** 2

    @cached_property
    def arc_sum(self) -> Fraction:
        """2 s = 4 atan(outer), rounded down: the arc that a path in the region may have."""
        return 4 * arctangent_below(self.outer)

    def coordinates(self, q: Quaternion) -> tuple[Vector, Fraction]:
        """Return (x, e) with the modified Rodrigues vector of m^-1 q/|q| within e of x, each component."""
        r = quaternion_product(conjugate(self.middle_quaternion), q)
        low, high = length(q)
        if r[0] + low <= 0:
            raise ValueError("the attitude is opposite to the middle of the chart")
        x = [c / (r[0] + high) for c in r[1:]]
        error = max(abs(c) for c in r[1:]) * (high - low) / (r[0] + low) ** 2
        rounded = [grid_near(c, ROOT_BITS) for c in x]
        return (rounded[0], rounded[1], rounded[2]), error + Fraction(1, 2**ROOT_BITS)


def chart_between(q: Quaternion, arc_sum: float) -> Chart:
    """Build the chart whose model end points are q/|q| and the identity, for paths of arc `arc_sum`.

    The construction is in floats; the chart that comes out is exact, and `Chart.coordinates`
    tells how far the model end points are from the true ones.
    """
    unit = np.array([float(c) for c in q])
    unit /= np.linalg.norm(unit)
    vector = unit[1:]
    size = float(np.linalg.norm(vector))
    n = vector / size if size > 0 else np.array([1.0, 0.0, 0.0])
    if unit[0] < -1 + 1e-12:
        raise ValueError("start and target are opposite quaternions: take another chart")
    arc = arc_to_identity(unit)
    middle = np.tan(arc / 4) * n
    inner = Fraction(float(np.tan(arc / 4)))
    outer = Fraction(round(2**16 * float(np.tan(arc_sum / 4))) + 1, 2**16)
    x, y, z = rational_direction(n.tolist())
    mid = (Fraction(float(middle[0])), Fraction(float(middle[1])), Fraction(float(middle[2])))
    return Chart(mid, (x, y, z), inner, max(outer, inner))


def arc_to_identity(unit: Array) -> float:
    """Arc from a unit quaternion (floats) to +1 on the sphere of quaternions, half the rotation angle."""
    one = np.array([1.0, 0.0, 0.0, 0.0])
    return float(2 * np.arctan2(np.linalg.norm(unit - one), np.linalg.norm(unit + one)))
