"""What is not known of a spacecraft: its inertia, what thrusters make of a command, what else pushes."""

from __future__ import annotations

from dataclasses import dataclass, fields
from fractions import Fraction
from typing import Literal, final

from .rigid_body import ExactMatrix

ZERO = Fraction(0)
MAX_MISALIGNMENT_DEG = 30


@final
@dataclass(frozen=True, kw_only=True)
class Uncertainty:
    """Sets of bodies, thrusters and disturbances around what the controller believes; zero is nominal.

    The controller computes with the inertia J0 of the scenario and with its schedule's g; attitude and
    rate are measured exactly. Every number is exact and every set contains its bounds.

    Attributes
    ----------
    inertia_tolerance : (3, 3), largest deviation of each entry of J from J0, kg m^2, or None
    inertia_relative : rho, (1 - rho) J0 <= J <= (1 + rho) J0 as quadratic forms, in [0, 1)
    inertia_scale : (low, high), J may be multiplied by 1 + e with e between them; low > -1
    thrust_error : (low, high), torques come out as 1 + d times what was asked; low > -1
    thrust_error_varies : whether d stays for all time or may differ from one firing to the next
    misalignment_deg : torques come out turned by at most this angle, deg, about any fixed axis
    disturbance : Euclidean bound of a torque that acts at all times, varying at will, N m
    """

    inertia_tolerance: ExactMatrix | None = None
    inertia_relative: Fraction = ZERO
    inertia_scale: tuple[Fraction, Fraction] = (ZERO, ZERO)
    thrust_error: tuple[Fraction, Fraction] = (ZERO, ZERO)
    thrust_error_varies: Literal["never", "per-firing"] = "per-firing"
    misalignment_deg: Fraction = ZERO
    disturbance: Fraction = ZERO

    def __post_init__(self) -> None:
        for name, value, most in (
            ("inertia_relative", self.inertia_relative, 1),
            ("misalignment_deg", self.misalignment_deg, MAX_MISALIGNMENT_DEG),
        ):
            if not 0 <= value < most:
                raise ValueError(f"{name} must lie in [0, {most}), received {float(value):g}")
        if self.disturbance < 0:
            raise ValueError(f"disturbance must be >= 0 N m, received {float(self.disturbance):g}")
        for name, (low, high) in (("inertia_scale", self.inertia_scale), ("thrust_error", self.thrust_error)):
            if not -1 < low <= 0 <= high:
                raise ValueError(
                    f"{name} must be [low, high] with -1 < low <= 0 <= high, "
                    f"received [{float(low):g}, {float(high):g}]"
                )

    @property
    def is_nominal(self) -> bool:
        """Whether nothing is uncertain."""
        return not self.channels

    @property
    def channels(self) -> tuple[str, ...]:
        """Names of what is uncertain, in the words of the scenario's keys."""
        return tuple(
            f.name
            for f in fields(self)
            if f.name != "thrust_error_varies" and _is_something(getattr(self, f.name))
        )


def _is_something(value: object) -> bool:
    if isinstance(value, tuple):
        return any(_is_something(entry) for entry in value)
    return bool(value)


NOMINAL = Uncertainty()
"""Nothing uncertain."""
