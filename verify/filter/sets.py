"""The set of initial states a certificate speaks about, in the comparison systems' variables."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import inf, nextafter
from typing import final

from ...models.rigid_body import RigidBody
from ..exact.ball import ball, float_above, float_below, sqrt_above, sqrt_below
from ..exact.rounding import rounded_up
from .comparison import BodyBounds

MAX_S = 1.4142135623730954
"""The float above sqrt 2, the largest value of s = sqrt(1 - b0)."""


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
    def from_bounds(
        cls,
        bounds: BodyBounds,
        *,
        max_angle_deg: Fraction,
        max_rate: Fraction | None = None,
        max_weighted_rate: Fraction | None = None,
        gain_term: Fraction = Fraction(0),
    ) -> InitialSet:
        """All states with a bounded error angle and rate; no bound on the rate means at rest.

        Parameters
        ----------
        bounds : BodyBounds
            Principal inertias.
        max_angle_deg : Fraction
            Bound on 2 acos(b0), deg, in [0, 360].
        max_rate : Fraction, optional
            Bound on |w(0)|, rad/s; then y <= sqrt(Jmax) (|w| + 2 g^2 kappa max |bv|).
        max_weighted_rate : Fraction, optional
            Bound on |Omega(0)|_J, sqrt(kg m^2) rad/s.
        gain_term : Fraction
            g(0)^2 kappa(0), 1/s: zero where the schedule starts closed.
        """
        if not 0 <= max_angle_deg <= 360:
            raise ValueError(
                f"the largest error angle must lie in [0, 360] deg, received {float(max_angle_deg):g}"
            )
        s_high = 0.0
        if max_angle_deg > 0:
            s_high = float_above((1 - (ball(max_angle_deg) / 360).cos_pi()).sqrt())
            s_high = min(nextafter(s_high, inf), MAX_S)  # room for a checker with a rational pi
        reaches = []
        if max_rate is not None or max_weighted_rate is None:
            reach = (max_rate or Fraction(0)) + 2 * gain_term * _greatest_bv(s_high)
            reaches.append(sqrt_above(bounds.greatest * reach * reach))
        if max_weighted_rate is not None:
            reaches.append(rounded_up(max_weighted_rate))
        words = [f"2 acos(b0) <= {float(max_angle_deg):.6g} deg"]
        words += [f"|w(0)| <= {float(max_rate):.6g} rad/s"] if max_rate is not None else []
        if max_weighted_rate is not None:
            words.append(f"|Omega(0)|_J <= {float(max_weighted_rate):.6g} sqrt(kg m^2) rad/s")
        elif max_rate is None:
            words.append("at rest")
        return cls(0.0, s_high, 0.0, min(reaches), ", ".join(words))

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
            min(s_high, MAX_S),
            0.0 if at_rest else y_low,
            0.0 if at_rest else y_high,
            "the scenario's initial state",
        )


def _greatest_bv(s_high: float) -> Fraction:
    """Rational bound of |bv| = s sqrt(2 - s^2) over s <= s_high: s sqrt 2, at most 1."""
    return min(Fraction(1), Fraction(s_high) * Fraction(MAX_S))


def _root_bounds(square: object) -> tuple[float, float]:
    """Floats around the root of a ball known to be >= 0."""
    low, high = max(0.0, float_below(square)), max(0.0, float_above(square))
    return sqrt_below(Fraction(low)), sqrt_above(Fraction(high))
