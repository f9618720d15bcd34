r"""How far torque can take a body from its coast.

Let the body coast: from its start, without torque, to the attitude C(t), its momentum H0 fixed in
space. Under torque in p w T the momentum is H0 + D. With d = D in body axes, and e the distance
from C(t) to the attitude, the least travel (gauge N of the momentum set) that joins them,

    N(d)' <= p w + nu N(d),        e' <= N(d) + mu e,        e(s) <= p int_0^s w(t) f(s - t) dt,

f(u) = u (exp(mu u) + exp(nu u))/2. So the travel from C(s) to the target is at most e(s) and what
the rest of the transfer allows: the target is compared with where the coast leads, not with the start.

Proof. d' = torque - w x d with w = J^-1 (h + d), h = H0 in body axes; rows M = a I + b J^-1 of N
have d'M (J^-1 d x d) = 0, so only h makes N(d) grow: nu. A path from C to the attitude, carried
along by the motions of momentum H0, stretches as y' = h x J^-1 y - J (J^-1 h x J^-1 y), y = J eta
for a small body rotation eta: mu. Its far end moves off by momentum d: N(d). f is the integral
of exp(mu (u - v) + nu v) over [0, u], convex in v, by its end points.

A row's growth is y'M X y/(y'M y) with X linear in h; on the boundary of the set y'M y = L and
|y|^2 <= L_0, so it is at most L_0/L times the largest eigenvalue of the symmetric part S = sum h_i S_i
of M X. In principal axes S has no diagonal: its trace is 0, so its eigenvalues are at most
sqrt(2/3) |S|_F, and |S|_F^2 = h'G h with G_ij = tr S_i S_j.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import final

from ....verify.exact.ball import ball, exact_above
from ....verify.exact.matrix import greatest_eigenvalue_above
from ..sets.chart import Vector, square_root
from ..sets.momentum_sets import MomentumSet, length_above
from ..sets.rate import ExactMatrix, exact_inverse
from .travel import WindowTravel

CELLS = 32
"""Parts of a coast, each with the growth of its beginning."""

MAX_GROWTH = 60
"""Exponent of a growth up to which a coast is of any use; the checker ends at 64."""

_FINE = 2**64


@final
@dataclass(frozen=True)
class Growth:
    """Upper bounds of what makes a deviation grow.

    Attributes
    ----------
    distance : Fraction
        mu, 1/s.
    momentum : Fraction
        nu, 1/s.
    """

    distance: Fraction
    momentum: Fraction

    def allows(self, duration: Fraction) -> bool:
        """Whether a deviation stays within numbers worth writing down."""
        return max(self.distance, self.momentum) * duration <= MAX_GROWTH

    def factor_above(self, duration: Fraction) -> Fraction:
        """Upper bound of (exp(mu u) + exp(nu u))/2."""
        return (
            _exponential_above(self.distance * duration) + _exponential_above(self.momentum * duration)
        ) / 2


def growth_of_deviations(momenta: MomentumSet, momentum: Vector) -> Growth:
    """Bound mu and nu for a start of the given momentum J w, N m s."""
    J = momenta.body.exact_inertia
    inverse = exact_inverse(J)
    units = [_skew(_unit(i)) for i in range(3)]
    turning = [_skew(_times(inverse, _unit(i))) for i in range(3)]
    stretch = []
    for h, w in zip(units, turning, strict=True):
        stretch.append(_difference(_product(h, inverse), _product(J, _product(w, inverse))))
    size = length_above(momentum)
    return Growth(
        _fastest(momenta, stretch) * size, _fastest(momenta, [_negative(w) for w in turning]) * size
    )


def deviation_above(
    windows: WindowTravel, until: Fraction, growth: Growth, *, cells: int = CELLS
) -> Fraction:
    """Upper bound of e(until)/p, s^2: how far the attitude may be from its coast, per unit of the peak."""
    edges = [until * k / cells for k in range(cells + 1)]
    parts = (windows.moment(a, b, until) * growth.factor_above(until - a) for a, b in pairwise(edges))
    return sum(parts, Fraction(0))


def _fastest(momenta: MomentumSet, X: list[ExactMatrix]) -> Fraction:
    """Largest growth of any row, for |h| = 1, rounded up."""
    rows = momenta.rows
    return max(_row_growth(M, X) * rows[0][1] / level for M, level in rows)


def _row_growth(M: ExactMatrix, X: list[ExactMatrix]) -> Fraction:
    """Upper bound of the largest eigenvalue of the symmetric part of M sum h_i X_i over |h| = 1."""
    parts = [_symmetric(_product(M, x)) for x in X]
    gram = [[_inner(p, q) for q in parts] for p in parts]
    if not any(any(row) for row in gram):
        return Fraction(0)
    unit = _power_of_two_near(gram[0][0] + gram[1][1] + gram[2][2]) // 2
    small = [[x / Fraction(4) ** unit for x in row] for row in gram]  # whatever the units of the inertia
    root = square_root(Fraction(2, 3) * greatest_eigenvalue_above(small))[1]
    return Fraction((root * _FINE).__ceil__(), _FINE) * Fraction(2) ** unit


def _power_of_two_near(x: Fraction) -> int:
    return x.numerator.bit_length() - x.denominator.bit_length()


def _exponential_above(x: Fraction) -> Fraction:
    return exact_above(ball(x).exp())


def _unit(axis: int) -> Vector:
    return Fraction(int(axis == 0)), Fraction(int(axis == 1)), Fraction(int(axis == 2))


def _skew(a: Vector) -> ExactMatrix:
    """S(a) with S(a) b = a x b."""
    zero = Fraction(0)
    return (zero, -a[2], a[1]), (a[2], zero, -a[0]), (-a[1], a[0], zero)


def _times(A: ExactMatrix, x: Vector) -> Vector:
    y = [sum((a * b for a, b in zip(row, x, strict=True)), Fraction(0)) for row in A]
    return y[0], y[1], y[2]


def _product(A: ExactMatrix, B: ExactMatrix) -> ExactMatrix:
    columns = [_times(A, (B[0][j], B[1][j], B[2][j])) for j in range(3)]
    return tuple((columns[0][i], columns[1][i], columns[2][i]) for i in range(3))


def _difference(A: ExactMatrix, B: ExactMatrix) -> ExactMatrix:
    return tuple((a[0] - b[0], a[1] - b[1], a[2] - b[2]) for a, b in zip(A, B, strict=True))


def _negative(A: ExactMatrix) -> ExactMatrix:
    return tuple((-a[0], -a[1], -a[2]) for a in A)


def _symmetric(A: ExactMatrix) -> ExactMatrix:
    rows = [[(A[i][j] + A[j][i]) / 2 for j in range(3)] for i in range(3)]
    return tuple((row[0], row[1], row[2]) for row in rows)


def _inner(A: ExactMatrix, B: ExactMatrix) -> Fraction:
    return sum((A[i][j] * B[i][j] for i in range(3) for j in range(3)), Fraction(0))
