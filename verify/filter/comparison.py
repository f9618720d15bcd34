"""What the comparison systems of both laws share: variables, inequalities, data.

Variables of the closed loop (rigid body, Omega = w + 2 g^2 kappa bv):

    y = |Omega|_J = sqrt(Omega' J Omega),     s = sqrt(1 - b0) in [0, sqrt 2],     S = s^2.

From J Omega' = -Omega x J w - (g^2/2) kappa (1 + b0) J Omega, since Omega'(Omega x J w) = 0,

    y' = -(1/2) g^2 kappa (2 - S) y                                      (exactly)

and from b0' = -(1/2) bv.w with w = Omega - 2 g^2 kappa bv and |bv|^2 = S (2 - S),

    s' = bv.Omega / (4 s) - (1/2) g^2 kappa s (2 - S),
    |bv.Omega| / (4 s) <= sqrt(2 - S) |Omega| / 4 <= c A(S) y,
    c = 1/sqrt(8 Jmin),   A(S) = 1 - S/4 - S^2/32 >= sqrt(1 - S/2)       (0 <= S <= 2).

R' = -lambda R + g^2 (2 - S). An upper function of a component whose slope is at least the
greatest slope the component can have when it touches it, the others anywhere within their
bounds, is never crossed; likewise from below (the comparison theorem of Mueller and Walter).
At a step's start a bound may jump to its loose side.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import sqrt
from typing import Any, final

from ...models.rigid_body import RigidBody
from ..exact.ball import ball, float_above
from ..exact.matrix import greatest_eigenvalue_above, least_eigenvalue_below

ATTITUDE_BOUND_LOST = 1.98
"""Above this S = 1 - b0 (337 deg) the error-angle bound counts as having reached 2 pi."""
NO_BOUND = 1.5
"""A value of s that every trajectory stays below (s <= sqrt 2): no bound at all."""
ROUND_UP = 1 + 1e-14
"""Covers the rounding of a few float operations on positive numbers (each 1.2e-16 relative)."""

MIN_RATE_SHARE = 1e-6
"""Least rate, as a share of lambda, at which an upper bound of y lets that of s grow."""
REACH = 1e3
"""How many times lambda r the slack of r may be where r is far below what a window brings."""


@final
@dataclass(frozen=True)
class BodyBounds:
    """What the comparison systems need to know of the inertia.

    Attributes
    ----------
    least, greatest : Fraction
        Rationals around the principal inertias: least <= Jmin, greatest >= Jmax, kg m^2.
    """

    least: Fraction
    greatest: Fraction

    def __post_init__(self) -> None:
        if not 0 < self.least <= self.greatest:
            raise ValueError("principal inertia bounds must satisfy 0 < least <= greatest")

    @classmethod
    def of(cls, body: RigidBody) -> BodyBounds:
        """Bounds of one inertia, within about 1e-12 of its principal inertias."""
        return cls(least_eigenvalue_below(body.exact_inertia), greatest_eigenvalue_above(body.exact_inertia))

    def widened(self, tolerance: Sequence[Sequence[Fraction]]) -> BodyBounds:
        """Bounds that also hold if each entry of J is off by at most the given tolerance.

        A symmetric perturbation moves an eigenvalue by at most its norm, at most the greatest row sum.
        """
        shift = max(sum((abs(x) for x in row), Fraction(0)) for row in tolerance)
        if shift >= self.least:
            raise ValueError("the inertia's tolerance reaches a singular inertia: nothing follows")
        return BodyBounds(self.least - shift, self.greatest + shift)

    @property
    def coupling(self) -> float:
        """A float c >= 1/sqrt(8 Jmin), (kg m^2)^(-1/2)."""
        return float_above(1 / (8 * ball(self.least)).sqrt())


def angle_factor(S: Any) -> Any:
    """A(S) = 1 - S/4 - S^2/32, an upper bound of sqrt(1 - S/2) on 0 <= S <= 2, in any arithmetic."""
    return 1 - S * (8 + S) / 32


TANGENTS = 64
"""Tangents of the angle factor touch it at multiples of 1/TANGENTS."""


MAX_FALL = 1 / 3
"""Share of sqrt(1 - S/2) that may be lost over a step with one tangent."""
NEAR_TARGET = 0.8
"""Above this sqrt(1 - S/2) (S < 0.72, 147 deg) A(S) is within 2 per cent, over a step of any length."""


def rate_factor(S: Any, form: str) -> Any:
    """Return an upper bound of u = sqrt(1 - S/2): A(S), or for any t > 0 the tangent (t^2 + 1 - S/2)/(2 t).

    `form` is "A", or 64 t. Near S = 2, where a body has turned almost all the way round, A(S) is loose.
    """
    if form == "A":
        return angle_factor(S)
    t = Fraction(int(form), TANGENTS)
    return (t * t + 1) / (2 * t) - S / (4 * t)


def factor_near(s: float, drift: float, length: float) -> str:
    """Name the factor for a step of this length (s) from s = sqrt(1 - b0), whose slope is `drift`.

    Empty where u falls by more than a third: one tangent would be loose, and the step is better cut.
    """
    u, middle, end = (
        sqrt(max(1.0 - 0.5 * x * x, 0.0)) for x in (s, s + 0.5 * drift * length, s + drift * length)
    )
    if end > NEAR_TARGET:
        return "A"
    if middle < (1.0 - 0.5 * MAX_FALL) * u and length > 0.0:
        return ""
    return str(min(max(round(TANGENTS * middle), 1), TANGENTS))


def at_least_tiny(value: float) -> float:
    """Raise a positive upper bound to 1e-60, far from underflow; leave 0, which stays 0 by itself."""
    return max(value, 1e-60) if value > 0 else value


def drives_attitude(y: float, s: float, scale: float) -> float:
    """Raise a positive upper bound y so that its share c y in s' is not lost in the rounding of s.

    `scale` is lambda/c. Exactly 0 stays 0: the rate of a body at rest.
    """
    return max(y, 1e-60, MIN_RATE_SHARE * scale * s) if y > 0 else y


def filter_scale(loss: float, peak: float) -> float:
    """Size of the terms of r', 1: of the loss lambda r and of the intake, at most `peak`.

    After a long off-interval r may be 1e-8 of what a window brings; a slack that took its size from
    the window would push it below zero.
    """
    most = REACH * max(loss, 0.0)
    return loss + (peak * most / (peak + most) if most > 0 else 0.0)
