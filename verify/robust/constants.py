"""Bounds of how an unknown inertia, thrust and misalignment enter the closed loop.

The controller uses J0, the body has J with (1 - rho_-) J0 <= J <= (1 + rho_+) J0, and the torque asked for
acts through a rotation M by at most theta (a constant thrust factor 1 + d is an inertia J/(1 + d)). With
zeta = 2 g^2 kappa bv, F = J^-1 M J0, Phi = F - 1 and x = w + F zeta, exactly

    J x' = -w x J w - M (zeta x J0 w) - (g^2/2) kappa (1 + b0) M J0 (x - Phi zeta) + (torques not asked for),
    S'   = bv.x/2 - g^2 kappa bv'F bv,          S = 1 - b0,

in which neither g' nor kappa' is left. With B(p, q) = F p x J q - M (p x J0 q), n = |bv|, y = |x|_J:

    x'M J0 x               >= damping y^2
    -bv'Phi bv             <= braking n^2
    |Phi|                  <= mismatch
    |x.B(bv, x)|           <= gyroscopic n y^2
    |J^-1/2 (2 sigma M J0 Phi bv - 4 B(bv, F bv))| <= forcing sqrt(S),  sigma = 1 - S/2

Write Q = J0^1/2 J^-1 J0^1/2 and J^-1 J0 = 1 + m + J0^-1/2 P J0^1/2 with P = P', |P| <= r: m is the common
factor, r the shape; a common factor drops out of B. With lo, hi the least and greatest eigenvalue of J0,
q = sqrt(hi/lo), mu = |M - 1| and |J0^1/2 b| |J0^-1/2 b| <= K = (q + 1/q)/2 for |b| = 1 (Kantorovich):

- damping: the symmetric part of J0^-1/2 M J0^1/2 is cos(theta) + (1 - cos(theta)) sym(p p'^-1) + sin(theta)
  times a matrix with zero diagonal, of norm at most (q - 1/q)/sqrt 3.
- B(b, x) = P~b x J x - b x J P~x with P~ = J0^-1/2 P J0^1/2, and |x x J x| <= y^2 (q_J - 1/q_J)/2,
  q_J = q sqrt((1 + rho)/(1 - rho)) the same ratio of J.
- forcing without misalignment: both terms depend on the body through P~b alone,
  |J^-1/2 N Phi b| <= sqrt(hi/(1 - rho_-)) (alpha |m| + r sqrt(alpha^2 + beta^2 tau^2 + 2 alpha beta chi)),
  N = alpha J0 + beta (S(b) J0 + S(J0 b)), as J0^-1/2 S(J0 b) J0^-1/2 = S(J0^3/2 b)/sqrt(det J0) is skew:
  tau = hi^1.5/sqrt(det J0) + q, chi = (q - 1/q)/sqrt 3.

All numbers are rational and on the safe side.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import accumulate
from typing import final

from ..exact.ball import ball, float_above, sqrt_above, sqrt_below
from .inertia_set import InertiaBin

ONE, ZERO = Fraction(1), Fraction(0)
CELLS = 256
"""Equal cells of S in [0, 2]; a step takes its constants at the upper end of one of them."""
MAX_EXCESS = Fraction(2)
"""Largest rho_+: up to it |e|/(1 + e)^(3/2) grows with e."""


def root_above(value: Fraction) -> Fraction:
    """Return a rational >= sqrt(value)."""
    return Fraction(sqrt_above(value))


def root_below(value: Fraction) -> Fraction:
    """Return a rational in [0, sqrt(value)]."""
    return Fraction(sqrt_below(value))


@final
@dataclass(frozen=True)
class Misalignment:
    """A rotation by at most theta: bounds of its sine, of 1 - cos, and of mu = 2 sin(theta/2)."""

    sine: Fraction
    versine: Fraction
    mu: Fraction

    @classmethod
    def of(cls, degrees: Fraction) -> Misalignment:
        """Bounds for an angle in degrees, 0 <= degrees < 90."""
        if not degrees:
            return cls(ZERO, ZERO, ZERO)
        half = Fraction(float_above((ball(degrees) / 360).sin_pi()))
        return cls(Fraction(float_above((ball(degrees) / 180).sin_pi())), 2 * half * half, 2 * half)


@final
@dataclass(frozen=True)
class Constants:
    """The module's constants for one bin of bodies.

    Attributes
    ----------
    inertia : bounds of the body's inertia around the controller's
    turn : bounds of the misalignment
    boost : greatest thrust factor of a thrust error that differs from firing to firing, else 1
    """

    inertia: InertiaBin
    turn: Misalignment
    boost: Fraction = ONE

    def __post_init__(self) -> None:
        if self.inertia.above > MAX_EXCESS:
            raise ValueError("the inertia may be more than three times the controller's: nothing follows")
        if self.braking > 1:
            raise ValueError("the thrust may push away from the target: the uncertainty is too large")

    @cached_property
    def q(self) -> Fraction:
        """sqrt(hi/lo), rounded up; it enters increasing terms only."""
        return root_above(self.inertia.hi / self.inertia.lo)

    @cached_property
    def skew(self) -> Fraction:
        """(q - 1/q)/sqrt 3, rounded up."""
        return (self.q - 1 / self.q) / root_below(Fraction(3))

    @cached_property
    def damping(self) -> Fraction:
        """X'M J0 x >= damping |x|_J^2."""
        loss = self.turn.sine * self.skew + self.q * self.turn.versine
        return max(ZERO, 1 - loss) / (1 + self.inertia.above)

    @cached_property
    def braking(self) -> Fraction:
        """-bv'Phi bv <= braking |bv|^2, and >= 0."""
        q, i = self.q, self.inertia
        shape = max(-i.mean(e) + i.spread(e) * (q + 1 / q) / 2 for e in (i.scale_low, i.scale_high))
        return max(ZERO, shape + self.turn.mu * (q * q + 1) / (2 * (1 - i.below)))

    @cached_property
    def accelerating(self) -> Fraction:
        """Bv'Phi bv <= accelerating |bv|^2, and >= 0."""
        q, i = self.q, self.inertia
        shape = max(i.mean(e) + i.spread(e) * (q + 1 / q) / 2 for e in (i.scale_low, i.scale_high))
        return max(ZERO, shape + self.turn.mu * (q * q + 1) / (2 * (1 - i.below)))

    @cached_property
    def measured_mismatch(self) -> Fraction:
        """|J0^1/2 Phi bv| <= measured_mismatch |bv|, kg^1/2 m: J0^1/2 Phi = (m + P) J0^1/2."""
        i = self.inertia
        return root_above(i.hi) * (
            i.greatest_mean + i.greatest_spread + self.turn.mu * self.q / (1 - i.below)
        )

    @cached_property
    def metric_ratio(self) -> Fraction:
        """|x| in J0 is at most this times |x| in the metric of y."""
        return root_above(self.inertia.lo / self.inertia.least)

    @cached_property
    def mismatch(self) -> Fraction:
        """|Phi| <= mismatch."""
        i = self.inertia
        return i.greatest_mean + i.greatest_spread * self.q + self.turn.mu * self.q**2 / (1 - i.below)

    @cached_property
    def gyroscopic(self) -> Fraction:
        """|x.B(bv, x)| <= gyroscopic |bv| |x|_J^2."""
        q, i, mu, r = self.q, self.inertia, self.turn.mu, self.inertia.greatest_spread
        if not (r or mu):
            return ZERO
        ratio = q * root_above((1 + i.shape) / (1 - i.shape))
        turned = mu * q * q / (1 - i.below)
        whirl = (r * q + turned) * (ratio - 1 / ratio) / 2
        return whirl + q * r * (1 + i.above) / (1 - i.below) + mu * q / (1 - i.below)

    @cached_property
    def coupling(self) -> Fraction:
        """1/sqrt(8 Jmin) or more, for the inertia in which |x| is measured."""
        return Fraction(float_above(1 / (8 * ball(self.inertia.least)).sqrt()))

    @cached_property
    def inverse_root(self) -> Fraction:
        """1/sqrt(Jmin) or more: |x| <= inverse_root |x|_J."""
        return Fraction(float_above(1 / ball(self.inertia.least).sqrt()))

    def forcing(self, cell: int) -> Fraction:
        """Bound of the forcing over sqrt(S), for S up to the upper end of a cell, kg^1/2 m."""
        return self._forcings[cell]

    @cached_property
    def _forcings(self) -> list[Fraction]:
        if not (self.inertia.greatest_mean or self.inertia.greatest_spread or self.turn.mu):
            return [ZERO] * CELLS
        return list(accumulate((self._forcing(cell) for cell in range(CELLS)), max))

    def _forcing(self, cell: int) -> Fraction:
        """Bound on one cell: what falls with S at its lower end, what grows at its upper end."""
        low, high = cell_end(cell - 1), cell_end(cell)
        n, sigma, fall = greatest_n(high), 1 - low / 2, root_above(2 - low)
        i = self.inertia
        if self.turn.mu:
            joint = 2 * sigma * self._wrench + 4 * n * self._swirl
        else:
            alpha, beta = 2 * sigma, 4 * n
            square = alpha**2 + (beta * self._tau) ** 2 + 2 * alpha * beta * self.skew
            size = alpha * i.greatest_mean + i.greatest_spread * root_above(square)
            joint = root_above(i.hi / (1 - i.below)) * size
        return Fraction(sqrt_above((joint * fall) ** 2 * self.boost))

    @cached_property
    def _tau(self) -> Fraction:
        return root_above(self.inertia.hi**3 / self.inertia.determinant) + self.q

    @cached_property
    def _wrench(self) -> Fraction:
        """|J^-1/2 M J0 Phi b| for |b| = 1."""
        i, mu, q = self.inertia, self.turn.mu, self.q
        rest = 1 - i.below
        excess = max(e / root_below((1 + s * e) ** 3) for e, s in ((i.above, 1), (i.below, -1)))
        change = max(i.above / (1 + i.above), i.below / rest)
        turned = q * mu / root_below(rest) * ((1 + q * mu) / rest + change)
        return root_above(i.hi) * (excess + turned)

    @cached_property
    def _swirl(self) -> Fraction:
        """|J^-1/2 B(b, F b)| for |b| = 1."""
        i, mu, q = self.inertia, self.turn.mu, self.q
        turned = mu * (1 + self.mismatch) + mu * (q * q + q) / (1 - i.below)
        size = i.greatest_spread * (q + 1) + turned
        return i.hi * size / root_below((1 - i.below) * i.lo)


def cell_end(cell: int) -> Fraction:
    """Upper end of a cell of S."""
    return Fraction(2 * (cell + 1), CELLS)


def greatest_n(S: Fraction) -> Fraction:
    """Bound of |bv| = sqrt(S' (2 - S')) over S' <= S."""
    return root_above(S * (2 - S)) if S < 1 else ONE
