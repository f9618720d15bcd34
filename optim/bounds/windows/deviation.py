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
from typing import Any, final

from ....verify.exact.ball import exponential_above, length, square_root
from ....verify.exact.matrix import greatest_eigenvalue_above, of, skew, trace
from ....verify.exact.rounding import grid_above
from ..sets.chart import Vector
from ..sets.momentum_sets import IDENTITY, MomentumSet
from .travel import WindowTravel

CELLS = 32
"""Parts of a coast, each with the growth of its beginning."""

MAX_GROWTH = 60
"""Exponent of a growth up to which a coast is of any use; the checker ends at 64."""


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
        return (exponential_above(self.distance * duration) + exponential_above(self.momentum * duration)) / 2


def growth_of_deviations(momenta: MomentumSet, momentum: Vector) -> Growth:
    """Bound mu and nu for a start of the given momentum J w, N m s."""
    J, inverse = of(momenta.body.exact_inertia), of(momenta.body.exact_inverse)
    units = [skew(row) for row in IDENTITY]
    turning = [skew(row) for row in momenta.body.exact_inverse]
    stretch = [h * inverse - J * w * inverse for h, w in zip(units, turning, strict=True)]
    size = length(momentum)[1]
    return Growth(_fastest(momenta, stretch) * size, _fastest(momenta, [-w for w in turning]) * size)


def deviation_above(
    windows: WindowTravel, until: Fraction, growth: Growth, *, cells: int = CELLS
) -> Fraction:
    """Upper bound of e(until)/p, s^2: how far the attitude may be from its coast, per unit of the peak."""
    edges = [until * k / cells for k in range(cells + 1)]
    parts = (windows.moment(a, b, until) * growth.factor_above(until - a) for a, b in pairwise(edges))
    return sum(parts, Fraction(0))


def _fastest(momenta: MomentumSet, X: list[Any]) -> Fraction:
    """Largest growth of any row, for |h| = 1, rounded up."""
    rows = momenta.rows
    return max(_row_growth(of(M), X) * rows[0][1] / level for M, level in rows)


def _row_growth(M: Any, X: list[Any]) -> Fraction:
    """Upper bound of the largest eigenvalue of the symmetric part of M sum h_i X_i over |h| = 1."""
    parts = [(M * x + (M * x).transpose()) / 2 for x in X]
    gram = [[trace(p * q) for q in parts] for p in parts]
    if not any(any(row) for row in gram):
        return Fraction(0)
    unit = _power_of_two_near(gram[0][0] + gram[1][1] + gram[2][2]) // 2
    small = [[x / Fraction(4) ** unit for x in row] for row in gram]  # whatever the units of the inertia
    root = square_root(Fraction(2, 3) * greatest_eigenvalue_above(small))[1]
    return grid_above(root, 64) * Fraction(2) ** unit


def _power_of_two_near(x: Fraction) -> int:
    return x.numerator.bit_length() - x.denominator.bit_length()
