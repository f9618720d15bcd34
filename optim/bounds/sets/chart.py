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

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import isqrt
from typing import final

import numpy as np

from ....models.types import Array
from . import polynomials as poly
from .polynomials import Polynomial

Vector = tuple[Fraction, Fraction, Fraction]
Quaternion = tuple[Fraction, Fraction, Fraction, Fraction]

_DIGITS = 96


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
        square = sum((c * c for c in self.middle), Fraction(0))
        x, y, z = (2 * c / (1 + square) for c in self.middle)
        return (1 - square) / (1 + square), x, y, z

    @cached_property
    def region(self) -> Polynomial:
        """F in the scaled coordinates x / outer: >= 0 wherever a path of half arc s can pass."""
        cos_h, sin_h = _circle_point(self.inner)
        cos_s, sin_s = _circle_point(self.outer)
        square = poly.scaled(squared_length(), self.outer**2)
        along = poly.total(*(poly.coordinate(i, self.outer * c) for i, c in enumerate(self.direction)))
        less = poly.total(poly.constant(1), poly.scaled(square, -1))
        more = poly.total(poly.constant(1), square)
        return poly.total(
            poly.scaled(poly.multiplied(less, less), (cos_h / cos_s) ** 2),
            poly.scaled(poly.multiplied(along, along), 4 * (sin_h / sin_s) ** 2) if self.inner else {},
            poly.scaled(poly.multiplied(more, more), -1),
        )

    @cached_property
    def arc_sum(self) -> Fraction:
        """2 s = 4 atan(outer), rounded down: the arc that a path in the region may have."""
        return 4 * arctangent_below(self.outer)

    def coordinates(self, q: Quaternion) -> tuple[Vector, Fraction]:
        """Return (x, e) with the modified Rodrigues vector of m^-1 q/|q| within e of x, each component."""
        r = quaternion_product(_conjugate(self.middle_quaternion), q)
        low, high = square_root(sum((c * c for c in q), Fraction(0)))
        if r[0] + low <= 0:
            raise ValueError("the attitude is opposite to the middle of the chart")
        x = [c / (r[0] + high) for c in r[1:]]
        error = max(abs(c) for c in r[1:]) * (high - low) / (r[0] + low) ** 2
        rounded = [Fraction(round(c * 2**_DIGITS), 2**_DIGITS) for c in x]
        return (rounded[0], rounded[1], rounded[2]), error + Fraction(1, 2**_DIGITS)


def squared_length() -> Polynomial:
    """Return x_1^2 + x_2^2 + x_3^2."""
    return poly.total(*(poly.multiplied(poly.coordinate(i), poly.coordinate(i)) for i in range(3)))


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
    direction = unit_vector_near(n)
    mid = (Fraction(float(middle[0])), Fraction(float(middle[1])), Fraction(float(middle[2])))
    return Chart(mid, direction, inner, max(outer, inner))


def arc_to_identity(unit: Array) -> float:
    """Arc from a unit quaternion (floats) to +1 on the sphere of quaternions, half the rotation angle."""
    one = np.array([1.0, 0.0, 0.0, 0.0])
    return float(2 * np.arctan2(np.linalg.norm(unit - one), np.linalg.norm(unit + one)))


def unit_vector_near(n: Sequence[float] | Array) -> Vector:
    """Rational vector of length exactly 1 within rounding of n (stereographic from the far pole)."""
    values = [float(c) for c in n]
    pole = max(range(3), key=lambda i: abs(values[i]))
    sign = 1 if values[pole] >= 0 else -1
    others = [i for i in range(3) if i != pole]
    u, v = (Fraction(values[i] / (1 + abs(values[pole]))) for i in others)
    square = u * u + v * v
    result = [Fraction(0)] * 3
    result[pole] = sign * (1 - square) / (1 + square)
    result[others[0]], result[others[1]] = 2 * u / (1 + square), 2 * v / (1 + square)
    return result[0], result[1], result[2]


def quaternion_product(a: Quaternion, b: Quaternion) -> Quaternion:
    """Hamilton product, scalar first."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + b[0] * a[1] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] + b[0] * a[2] + a[3] * b[1] - a[1] * b[3],
        a[0] * b[3] + b[0] * a[3] + a[1] * b[2] - a[2] * b[1],
    )


def square_root(x: Fraction) -> tuple[Fraction, Fraction]:
    """Enclose sqrt(x) for x >= 0 between two rationals, about 1e-28 apart relative to 1 or to sqrt(x)."""
    if x < 0:
        raise ValueError(f"square root of {float(x):g}")
    scale = 2 ** (2 * _DIGITS)
    root = isqrt(x.numerator * scale // x.denominator)
    return Fraction(root, 2**_DIGITS), Fraction(root + 1, 2**_DIGITS)


def arctangent_below(t: Fraction) -> Fraction:
    """Rational lower bound of atan(t), 0 <= t < 1, by the alternating series cut after a negative term."""
    value, power = Fraction(0), t
    for k in range(120):
        value += (-power if k % 2 else power) / (2 * k + 1)
        power *= t * t
    return Fraction(int(value * 2**60), 2**60)


def _circle_point(half_tangent: Fraction) -> tuple[Fraction, Fraction]:
    """Cosine and sine of an angle from the tangent of its half."""
    square = half_tangent**2
    return (1 - square) / (1 + square), 2 * half_tangent / (1 + square)


def _conjugate(q: Quaternion) -> Quaternion:
    return q[0], -q[1], -q[2], -q[3]
