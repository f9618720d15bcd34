"""The set of initial states a certificate speaks about, in the comparison systems' variables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.rigid_body import RigidBody
from ..enclosure.balls import ball, float_above, float_below, sqrt_above, sqrt_below
from .comparison import BodyBounds


@final
@dataclass(frozen=True)
class InitialSet:
    """All initial states with s in [s_low, s_high] and y in [y_low, y_high].

    s = sqrt(1 - b0) and y = |Omega(0)|_J; floats are taken at their exact binary value.

    Attributes
    ----------
    s_low, s_high : bounds of sqrt(1 - b0), dimensionless, in [0, sqrt 2]
    y_low, y_high : bounds of |Omega(0)|_J, sqrt(kg m^2) rad/s
    description : the set in the user's words
    """

    s_low: float
    s_high: float
    y_low: float
    y_high: float
    description: str = ""

    def __post_init__(self) -> None:
        if not (0 <= self.s_low <= self.s_high < 1.5 and 0 <= self.y_low <= self.y_high):
            raise ValueError("an initial set needs 0 <= s_low <= s_high <= sqrt 2 and 0 <= y_low <= y_high")

    @classmethod
    def from_angle(cls, error_angle: Fraction, y_high: Fraction) -> InitialSet:
        """All states with 2 acos(b0) <= error_angle (rad, in [0, 2 pi]) and |Omega(0)|_J <= y_high."""
        s_high = float_above((1 - (ball(error_angle) / 2).cos()).sqrt()) if error_angle > 0 else 0.0
        text = f"2 acos(b0) <= {float(error_angle):.6g} rad, |Omega(0)|_J <= {float(y_high):.6g}"
        return cls(0.0, s_high, 0.0, float_above(ball(y_high)) if y_high > 0 else 0.0, text)

    @classmethod
    def from_angle_and_rate(
        cls, bounds: BodyBounds, error_angle: Fraction, rate: Fraction, gain_term: Fraction = Fraction(0)
    ) -> InitialSet:
        """All states with 2 acos(b0) <= error_angle (rad) and |w(0)| <= rate (rad/s).

        `gain_term` is g(0)^2 kappa(0) (1/s), zero where the schedule starts closed; then
        y <= sqrt(Jmax) (rate + 2 g(0)^2 kappa(0) max |bv|).
        """
        base = cls.from_angle(error_angle, Fraction(0))
        reach = rate + 2 * gain_term  # |bv| <= 1
        y_high = sqrt_above(bounds.greatest * reach * reach)
        text = f"2 acos(b0) <= {float(error_angle):.6g} rad, |w(0)| <= {float(rate):.6g} rad/s"
        return cls(0.0, base.s_high, 0.0, y_high, text)

    @classmethod
    def from_state(
        cls,
        body: RigidBody,
        quaternion: Sequence[Fraction],
        rate: Sequence[Fraction],
        gain_term: Fraction = Fraction(0),
    ) -> InitialSet:
        """One state, enclosed; the quaternion is divided by its norm.

        `gain_term` is g(0)^2 kappa(0), 1/s.
        """
        norm = sum((ball(q * q) for q in quaternion), ball(0)).sqrt()
        b0, bv = ball(quaternion[0]) / norm, [ball(q) / norm for q in quaternion[1:]]
        Omega = [ball(w) + 2 * ball(gain_term) * b for w, b in zip(rate, bv, strict=True)]
        J = body.exact_inertia
        square = sum((ball(J[i][j]) * Omega[i] * Omega[j] for i in range(3) for j in range(3)), ball(0))
        s_low, s_high = _root_bounds(1 - b0)
        y_low, y_high = _root_bounds(square)
        at_rest = gain_term == 0 and not any(rate)
        return cls(
            s_low,
            min(s_high, 1.4142135623730954),
            0.0 if at_rest else y_low,
            0.0 if at_rest else y_high,
            "the scenario's initial state",
        )


def _root_bounds(square: object) -> tuple[float, float]:
    """Floats around the root of a ball known to be >= 0."""
    low, high = max(0.0, float_below(square)), max(0.0, float_above(square))
    return sqrt_below(Fraction(low)), sqrt_above(Fraction(high))
