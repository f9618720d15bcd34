"""How far torque takes a body from its coast, component by component."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from .exact_numbers import Matrix, Vector, require
from .matrices import inverse_matrix, matrix_product
from .peak_coast import CoastNode
from .peak_gauge import Gauge
from .peak_numbers import (
    PEAK_CELLS,
    axis_matrix,
    combination,
    exponential_above,
    image,
    length_interval,
    magnitude,
    quaternion_times,
    root_interval,
)
from .peak_window import PeakWindow
from .polynomials import cross

# The coast has attitude C, body momentum h; the body R, H. Let D = H - h, in body components.
#   The path s -> R(s) C(s)' C(c), s in [0, c], leads from C(c) to R(c), and its momentum is
#   J Q J^-1 D(s), Q = C(c)' C(s): a rotation that the coast alone decides. So its travel is
#       int_0^c N(J Q J^-1 D) ds.
#   D' = torque + X(h) D + D x J^-1 D,    X(h) y = h x J^-1 y - (J^-1 h) x y.
# With |X(h)_ij| <= G_ij (i != j), X(h)_ii <= G_ii and growth nu of the gauge N of K under X(h),
#   N(D) <= p n,  n' = w + nu n;      |D_i| <= p m_i,  m' = w (1, 1, 1) + G m + kappa p n^2
# where |(Y x J^-1 Y)_i| <= kappa_i for Y in K, |Y_j| <= B_j, |Y_i| >= floor: at a first instant with
# |D_i| = p m_i, D/(p n) is such a Y if m_j <= B_j n and m_i >= floor n. As functions over up = int w,
#   n/up <= scale,    m_i/up <= rise_i + p (swell kappa)_i,    1 <= m_i/up, n/up.


@dataclass(frozen=True)
class Stretch:
    """Growth between two nodes of a coast: G and nu."""

    growth: Matrix
    scale: Fraction


@dataclass(frozen=True)
class ShortForm:
    """Quadratic form in few bits, rounded upwards: entries 11, 22, 33, 23, 13, 12 in a unit.

    Entries within a unit of the true ones change the form by at most 3 units |x|^2.
    """

    entries: list[int]
    unit: Fraction

    @classmethod
    def of(cls, M: Matrix) -> ShortForm:
        """Round a matrix."""
        unit = Fraction(2) ** (magnitude(max(abs(x) for row in M for x in row)) - 80)
        places = ((0, 0), (1, 1), (2, 2), (1, 2), (0, 2), (0, 1))
        return cls([math.floor(M[i][j] / unit) + 3 * (i == j) for i, j in places], unit)

    def largest(self, g: list[int]) -> Fraction:
        """Largest value over the corners +-g of a box."""
        a, b, c, p, q, r = self.entries
        x, y, z = g
        p, q, r = 2 * p * y * z, 2 * q * x * z, 2 * r * x * y
        mixed = max(p + q + r, p - q - r, q - p - r, r - p - q)
        return (a * x * x + b * y * y + c * z * z + mixed) * self.unit


@dataclass(frozen=True)
class WayEnd:
    """A = J Q J^-1 at a node; A'M A for each row M of K, and a bound of x'(A'M A - M)x/L over K."""

    matrix: Matrix
    forms: list[ShortForm]
    excess: Vector

    @classmethod
    def of(cls, gauge: Gauge, A: Matrix) -> WayEnd:
        """Compute the forms."""
        transposed = [list(column) for column in zip(*A, strict=True)]
        forms = [matrix_product(matrix_product(transposed, M), A) for M in gauge.rows]
        gaps = [
            combination([Fraction(1), Fraction(-1)], pair) for pair in zip(forms, gauge.rows, strict=True)
        ]
        excess = [size_above(gap) * gauge.levels[0] / L for gap, L in zip(gaps, gauge.levels, strict=True)]
        return cls(A, [ShortForm.of(M) for M in forms], excess)

    def reach(self, g: Vector) -> Vector:
        """Largest components of A x over the box |x_i| <= g_i."""
        return [sum((abs(a) * x for a, x in zip(row, g, strict=True)), Fraction(0)) for row in self.matrix]


@dataclass(frozen=True)
class Way:
    """J Q J^-1 between two nodes: within `bend` (spectral norm) of a mean of the ends."""

    ends: list[WayEnd]
    bend: Fraction


@dataclass(frozen=True)
class DriftCell:
    """Part of [0, c]: int up, and over up the bounds of n (scale) and of m (rise, swell)."""

    area: Fraction
    scale: Fraction
    rise: Vector
    swell: Matrix
    stretch: int


UNIT: Matrix = combination([Fraction(1)] * 3, [axis_matrix(i) for i in range(3)])


def still() -> Stretch:
    """Return what rest makes grow: nothing."""
    return Stretch(combination([Fraction(0)], [UNIT]), Fraction(0))


def straight(gauge: Gauge) -> Way:
    """Return the way of a body that stays where it is."""
    return Way([WayEnd.of(gauge, UNIT)], Fraction(0))


def short_above(x: Fraction) -> Fraction:
    """Round a number >= 0 up to 80 significant bits."""
    unit = Fraction(2) ** (magnitude(x) - 80) if x else Fraction(1)
    return math.ceil(x / unit) * unit


def root_above(x: Fraction) -> Fraction:
    """Upper bound of a square root, to 80 significant bits whatever the units."""
    if x == 0:
        return x
    half = magnitude(x) // 2
    return short_above(root_interval(x / Fraction(4) ** half)[1] * Fraction(2) ** half)


def length_above(values: Sequence[Fraction]) -> Fraction:
    """Upper bound of a Euclidean length."""
    return root_above(sum((x * x for x in values), Fraction(0)))


def size_above(A: Matrix) -> Fraction:
    """Upper bound of the Frobenius norm."""
    return length_above([x for row in A for x in row])


def fastest_turn(J: Matrix, H: Vector) -> Fraction:
    """Upper bound of |J^-1 h| along the coast of momentum H: |h| = |H|, and |J^-1|^4 <= |J^-4|_F."""
    square = matrix_product(inverse_matrix(J), inverse_matrix(J))
    return root_above(root_above(size_above(matrix_product(square, square)))) * length_above(H)


def stretches(gauge: Gauge, nodes: list[CoastNode], step: Fraction) -> list[Stretch]:
    """Growth between nodes: X is linear in h, and |h''| <= 2 |h| turn^2 bounds h off the chord."""
    require(gauge.rows[0] == UNIT and gauge.box is None, "the first row of the set must be the identity")
    size, turn = length_above(nodes[0].momentum), fastest_turn(gauge.J, nodes[0].momentum)
    bases = [drift_matrix(gauge.inverse, h) for h in UNIT]
    reach = [[length_above([X[i][j] for X in bases]) for j in range(3)] for i in range(3)]
    grams = [growth_gram(M, bases) for M in gauge.rows]
    found = []
    for a, b in pairwise(nodes):
        off = size * (step * turn) ** 2 / 4 + max(a.off, b.off)
        ends = [combination(node.momentum, bases) for node in (a, b)]
        largest = [[max(*(entry(X, i, j) for X in ends), Fraction(0)) for j in range(3)] for i in range(3)]
        growth = combination([Fraction(1), off], [largest, reach])
        rates = [
            gauge.levels[0] / L * largest_growth(gram, [a.momentum, b.momentum], off)
            for gram, L in zip(grams, gauge.levels, strict=True)
        ]
        found.append(Stretch(short_matrix(growth), short_above(max(rates))))
    return found


def entry(X: Matrix, i: int, j: int) -> Fraction:
    """How much component j makes the size of component i grow."""
    return X[i][j] if i == j else abs(X[i][j])


def drift_matrix(inverse: Matrix, h: Vector) -> Matrix:
    """Matrix of y -> h x J^-1 y - (J^-1 h) x y."""
    w = image(inverse, h)
    columns = [[a - b for a, b in zip(cross(h, image(inverse, e)), cross(w, e), strict=True)] for e in UNIT]
    return [list(row) for row in zip(*columns, strict=True)]


def growth_gram(M: Matrix, bases: list[Matrix]) -> Matrix:
    """Gram matrix of the symmetric parts of M X(e_i); they have no trace."""
    parts: list[Vector] = []
    for X in bases:
        A = matrix_product(M, X)
        S = [[(A[i][j] + A[j][i]) / 2 for j in range(3)] for i in range(3)]
        require(S[0][0] + S[1][1] + S[2][2] == 0, "a growth of volumes")
        parts.append([x for row in S for x in row])
    return [[sum((x * y for x, y in zip(p, q, strict=True)), Fraction(0)) for q in parts] for p in parts]


def largest_growth(gram: Matrix, ends: Sequence[Vector], off: Fraction) -> Fraction:
    """Largest eigenvalue of the symmetric part S of M X(h), h near a chord: S has no trace."""
    squares = [sum((x * y for x, y in zip(h, image(gram, h), strict=True)), Fraction(0)) for h in ends]
    trace = gram[0][0] + gram[1][1] + gram[2][2]
    return root_above(max(squares) * 2 / 3) + root_above(trace * 2 / 3) * off


def ways(gauge: Gauge, nodes: list[CoastNode], step: Fraction) -> list[Way]:
    """J Q J^-1 to the last node: |Q''| <= 2 turn^2 bounds Q off the chord."""
    end, bend = nodes[-1].attitude, (step * fastest_turn(gauge.J, nodes[0].momentum)) ** 2 / 4
    ends, errors = [], []
    for node in nodes:
        p = quaternion_times([end[0], -end[1], -end[2], -end[3]], node.attitude)
        square = sum((c * c for c in p), Fraction(0))
        Q = [[Fraction(math.floor(x / square * 2**72), 2**72) for x in row] for row in rotation(p)]
        A = matrix_product(matrix_product(gauge.J, Q), gauge.inverse)
        ends.append(WayEnd.of(gauge, [[Fraction(math.floor(x * 2**72), 2**72) for x in row] for row in A]))
        errors.append(turn_of(node) + turn_of(nodes[-1]) + Fraction(6, 2**72))
    stretch = size_above(gauge.J) * size_above(gauge.inverse)
    return [
        Way([A, B], short_above(stretch * (bend + max(a, b))))
        for (A, B), (a, b) in zip(pairwise(ends), pairwise(errors), strict=True)
    ]


def turn_of(node: CoastNode) -> Fraction:
    """Upper bound of the rotation between a node and the coast: twice asin(error/length)."""
    length = length_interval(node.attitude)[0]
    require(2 * node.error < length, "the coast is not enclosed")
    return Fraction(22, 7) * node.error / length


def rotation(p: Vector) -> Matrix:
    """Rotation matrix of a quaternion times the square of its length."""
    s, x, y, z = p
    return [
        [s * s + x * x - y * y - z * z, 2 * (x * y - s * z), 2 * (x * z + s * y)],
        [2 * (x * y + s * z), s * s - x * x + y * y - z * z, 2 * (y * z - s * x)],
        [2 * (x * z - s * y), 2 * (y * z + s * x), s * s - x * x - y * y + z * z],
    ]


def drift_cells(window: PeakWindow, until: Fraction, growths: list[Stretch]) -> Iterator[DriftCell]:
    """Cut [0, until], with stretches of equal lengths, and bound n and m on each cell.

    Over a cell [a, b] both n/up and m/up grow at most by their own growth, because they are >= 1;
    the part of m in kappa p is at most its value at b, over up(a).
    """
    inside = {k for k in window.knots if 0 < k < until}
    marks = {until * k / PEAK_CELLS for k in range(PEAK_CELLS + 1)}
    count = len(growths)
    edges = sorted(marks | inside | {until * k / count for k in range(count + 1)})
    n, m, Z, plain = Fraction(0), [Fraction(0)] * 3, combination([Fraction(0)], [UNIT]), True
    for a, b in pairwise(edges):
        up, area, opened = window.up(a), window.opened(b) - window.opened(a), window.up(b) - window.up(a)
        if area == 0:
            continue
        stretch = min(int(a * count / until), count - 1)
        E = matrix_exponential_above(growths[stretch].growth, b - a)
        e = exponential_above(growths[stretch].scale * (b - a))
        scale = short_above(e * (n / up if up else Fraction(1)))
        rise = image(E, [x / up for x in m] if up else [Fraction(1)] * 3)
        square = scale * scale * (window.squared(b) - window.squared(a))
        Z = short_matrix(matrix_product(E, combination([Fraction(1), square], [Z, UNIT])))
        ratio = window.opened(b) if not up else min(window.opened(b), window.squared(b) / up)
        plain = plain and growths[stretch] == still()
        if plain:
            swell = combination([short_above(ratio)], [UNIT])
        elif up:
            swell = short_matrix([[x / up for x in row] for row in Z])
        else:
            swell = short_matrix(combination([scale * scale * ratio], [E]))
        n = short_above(e * (n + opened))
        m = [short_above(x) for x in image(E, [x + opened for x in m])]
        yield DriftCell(short_above(area), scale, [short_above(x) for x in rise], swell, stretch)


def short_matrix(A: Matrix) -> Matrix:
    """Round every entry up."""
    return [[short_above(x) for x in row] for row in A]


def matrix_exponential_above(G: Matrix, time: Fraction) -> Matrix:
    """Upper bound, entry by entry, of exp(G time) for G >= 0: the series to second order and its rest."""
    X = [[x * time for x in row] for row in G]
    size = max(sum(row, Fraction(0)) for row in X)
    require(size <= Fraction(1, 2), "a component of a deviation grows too fast for the cells")
    rest = size**3 / 5
    square = matrix_product(X, X)
    return [[UNIT[i][j] + X[i][j] + square[i][j] / 2 + rest for j in range(3)] for i in range(3)]
