"""Numbers of the bound of the peak: limits, enclosures of roots and arcs, small vectors."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction
from math import isqrt, lcm
from typing import TypeVar

from .exact_numbers import Matrix, Vector, require

# No torque in p w(t) T with p < peak takes the start to the target; T is the unit ball, the cube or
# the torques of one-sided thrusters. Proof. H = J w obeys H' = H x J^-1 H + torque. |H|^2 and H'J^-1 H
# are conserved in free motion, so every row M = a I + b J^-1 >= 0 gives a size sqrt(H'M H/L), L the
# largest t'M t over T, that changes at most p w; so does the largest of them, the gauge N of
# K = {H'M_k H <= L_k}. Five arguments follow.
#   momentum    N(start) - N(end) <= p int w.
#   axis        the same of one component, where (H x J^-1 H)_i = 0 for every H: an axis of symmetry.
#   path        travel = int N dt <= N0 s + Nf (tf - s) + p A(s) for any instant s, and it must be at
#               least D: by the rotation angle, or by a potential phi of the modified Rodrigues vector
#               x of m^-1 q with max over K of |phi'| <= rate wherever a path of travel below D can
#               pass, a spherical ellipse {F >= 0, |x| <= outer}. The way may be counted from where a
#               coast leads; see `Departure`.
#   braking     the same against a coast that slows down; see `require_braking`.
#   components  (cube) K is cut down by |H_i| <= beta_i; see `require_components` and `peak_drift`.
# Maxima over K go by multipliers: G <= sum l_k M_k gives H'G H <= sum l_k L_k.
# Polynomials live on boxes as integers in units of 2^-PEAK_BITS; every rounding is counted. Floats
# only choose multipliers, which are then rounded and checked in integers.


PEAK_BITS = 100
PEAK_BOXES = 150_000
PEAK_CELLS = 96
PEAK_DRIFT_NODES, PEAK_BRAKING_CELLS = 48, 64
PEAK_DEGREE = 12
PEAK_COAST_BITS, PEAK_COAST_ORDER, PEAK_COAST_STEPS, PEAK_COAST_CELLS = 192, 40, 400, 32
PEAK_DATA_BITS = 4096
"""Of an inertia's or a window's common denominator: products of longer numbers take minutes."""
Solid = list[list[list[int]]]
"""Coefficients [i][j][k], i + j + k <= degree, of a polynomial of t in [-1, 1]^3."""
Cubic = dict[tuple[int, int, int], Fraction]
Local = tuple[list[int], int]
"""Of a polynomial: constant, slopes 1 to 3, squares 1 to 3, products 23, 13, 12; and a bound of the rest."""
Number = TypeVar("Number", int, Fraction)
PI = (
    Fraction(31415926535897932384626433832795028841, 10**37),
    Fraction(31415926535897932384626433832795028842, 10**37),
)
"""Below and above."""
Six = list[float]
"""Symmetric 3 by 3 matrix: 11, 12, 13, 22, 23, 33."""


def root_interval(value: Fraction) -> tuple[Fraction, Fraction]:
    """Enclose the square root of a number >= 0."""
    require(value >= 0, "square root of a negative number")
    root = isqrt((value.numerator << 192) // value.denominator)
    return Fraction(root, 1 << 96), Fraction(root + 1, 1 << 96)


def require_short(numbers: Sequence[Fraction], what: str) -> None:
    """Refuse numbers whose sums and products would be too long to compute with."""
    common = 1
    for x in numbers:
        common = lcm(common, x.denominator)
        longest = max(common.bit_length(), x.numerator.bit_length())
        require(longest <= PEAK_DATA_BITS, f"the numbers of the {what} are too long")


def length_interval(values: Sequence[Fraction]) -> tuple[Fraction, Fraction]:
    """Enclose a Euclidean length."""
    return root_interval(sum((x * x for x in values), Fraction(0)))


def arctangent_below(t: Fraction) -> Fraction:
    """Lower bound of atan(t), t >= 0."""
    if t > 1:
        return PI[0] / 4 + arctangent_below((t - 1) / (t + 1))
    return PI[0] / 4 - _arctangent((1 - t) / (1 + t), 45) if 2 * t > 1 else _arctangent(t, 44)


def arctangent_above(t: Fraction) -> Fraction:
    """Upper bound of atan(t), t >= 0."""
    if t > 1:
        return PI[1] / 4 + arctangent_above((t - 1) / (t + 1))
    return PI[1] / 4 - _arctangent((1 - t) / (1 + t), 44) if 2 * t > 1 else _arctangent(t, 45)


def _arctangent(t: Fraction, terms: int) -> Fraction:
    """Alternating series of atan(t), 0 <= t <= 1/2: an odd number of terms is above, an even below."""
    away = math.ceil if terms % 2 else math.floor
    power = t = Fraction(away(t * 2**100), 2**100)
    value, square = Fraction(0), t * t
    for k in range(terms):
        value += (-power if k % 2 else power) / (2 * k + 1)
        power *= square
    return Fraction(away(value * 2**96), 2**96)


def quadratic(M: Matrix, x: Vector) -> Fraction:
    """Return x'M x."""
    return sum((x[i] * M[i][j] * x[j] for i in range(3) for j in range(3)), Fraction(0))


def combination(weights: Sequence[Fraction], matrices: Sequence[Matrix]) -> Matrix:
    """Sum of 3 by 3 matrices with weights."""
    pairs = list(zip(weights, matrices, strict=True))
    return [[sum((l * M[i][j] for l, M in pairs), Fraction(0)) for j in range(3)] for i in range(3)]


def axis_matrix(i: int) -> Matrix:
    """Return e_i e_i'."""
    return [[Fraction(int(j == k == i)) for k in range(3)] for j in range(3)]


def rounded_up(x: Fraction) -> Fraction:
    """Round up to a multiple of 2^-80."""
    return Fraction(math.ceil(x * 2**80), 2**80)


def quaternion_times(a: Sequence[Number], b: Sequence[Number]) -> list[Number]:
    """Hamilton product, scalar first."""
    return [
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + b[0] * a[1] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] + b[0] * a[2] + a[3] * b[1] - a[1] * b[3],
        a[0] * b[3] + b[0] * a[3] + a[1] * b[2] - a[2] * b[1],
    ]


def image(A: Matrix, x: Vector) -> Vector:
    """Return A x."""
    return [sum((a * b for a, b in zip(row, x, strict=True)), Fraction(0)) for row in A]


def exponential_above(x: Fraction) -> Fraction:
    """Upper bound of exp(x), x >= 0: the series at x/2^k <= 1/2, squared k times."""
    require(0 <= x <= 64, "the growth of a deviation is out of bounds")
    halvings = max(0, math.ceil(2 * x).bit_length())
    x = rounded_up(x / 2**halvings)
    value = term = Fraction(1)
    for k in range(1, 24):
        term = rounded_up(term * x / k)
        value += term
    value += term  # the rest is less than the last term
    for _ in range(halvings):
        value = rounded_up(value * value)
    return value


def magnitude(x: Fraction) -> int:
    """Exponent e with x near 2^e."""
    return x.numerator.bit_length() - x.denominator.bit_length()
