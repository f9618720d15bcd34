"""Laws and bodies shared by the tests of Lyapunov certificates."""

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

import casadi as ca
from intermit.models.laws import AdaptiveScaling, Control, ControllerState, Law, PersistenceFilter
from intermit.models.rigid_body import RigidBody
from problems import J1, J2

F = Fraction
__all__ = ["J1", "J2"]


def diagonal(*entries):
    return RigidBody.from_rows([[entries[i] if i == j else 0 for j in range(3)] for i in range(3)])


def persistence(lam):
    return PersistenceFilter(F(lam), F(1))


def adaptive(lam, a="1"):
    return AdaptiveScaling(F(lam), F("0.1"), F(1), F("0.2"), F(a))


def tolerance(radius):
    return tuple(tuple(F(radius) for _ in range(3)) for _ in range(3))


@dataclass(frozen=True)
class RateDamping(Law):
    """u = -damping g w: no attitude feedback; kinetic energy never grows."""

    name: ClassVar[str] = "rate-damping"
    damping: Fraction

    def control(self, plant, time, states, parameters) -> Control:
        return Control(-parameters["damping"] * time.g * plant.w)

    def storage(self, plant, time, states, parameters):
        return ca.dot(plant.w, plant.J @ plant.w) / 2


@dataclass(frozen=True)
class PlainDamping(Law):
    """u = -damping w, applied as g u: V' = -g damping |w|^2 has a sign only because g >= 0."""

    name: ClassVar[str] = "plain-damping"
    damping: Fraction

    def control(self, plant, time, states, parameters) -> Control:
        return Control(-parameters["damping"] * plant.w)

    def storage(self, plant, time, states, parameters):
        return ca.dot(plant.w, plant.J @ plant.w) / 2


@dataclass(frozen=True)
class SineFeedback(Law):
    """u = -sin(w): not algebraic, so out of the method's reach."""

    name: ClassVar[str] = "sine-feedback"

    def control(self, plant, time, states, parameters) -> Control:
        return Control(-time.g * ca.sin(plant.w))

    def storage(self, plant, time, states, parameters):
        return ca.dot(plant.w, plant.J @ plant.w) / 2


@dataclass(frozen=True)
class Resetting(PlainDamping):
    """A law that decides anew at stated instants."""

    def reset_instants(self, schedule, start, stop):
        return (start,)


@dataclass(frozen=True)
class HeavierDamping(Law):
    """The persistence filter with `factor` times its damping, V_a of its own with a = 1."""

    name: ClassVar[str] = "heavier-damping"
    lambda_: Fraction
    R0: Fraction
    factor: Fraction

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        return (ControllerState("R", self.R0, "s"),)

    def control(self, plant, time, states, parameters: Mapping) -> Control:
        R, g, J, bv = states["R"], time.g, plant.J, plant.bv
        R_rate = -parameters["lambda"] * R + g**2 * (1 + plant.b0)
        kappa, kappa_rate = 1 / R, -R_rate / R**2
        Omega = plant.w + 2 * g**2 * kappa * bv
        u = (
            -2 * g * kappa * ca.cross(bv, J @ plant.w)
            - 4 * time.g_rate * kappa * (J @ bv)
            - 2 * g * kappa_rate * (J @ bv)
            - 2 * g * kappa * (J @ plant.bv_rate)
            - parameters["factor"] * g / 2 * kappa * (1 + plant.b0) * (J @ Omega)
        )
        return Control(u, {"R": R_rate}, kappa, kappa_rate)

    def storage(self, plant, time, states, parameters):
        R = states["R"]
        Omega = plant.w + 2 * time.g**2 / R * plant.bv
        return R * (2 * (1 - plant.b0) + ca.dot(Omega, plant.J @ Omega))
