"""The paper's adaptive scaling: kappa = k with its own update."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, final

import casadi as ca

from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .scaled import augmented_rate, filter_rate, scaled_torque


@final
@dataclass(frozen=True)
class AdaptiveScaling(Law):
    """Adaptive scaling law, Omega = w + 2 g^2 k bv.

    k' = gamma R g^2 [ (1 + b0) Omega'J Omega + 2 a |bv|^2 ]; a = 1 is the update of
    Ram & Akella (AAS 21-402) with its last term corrected in sign and power (erratum E1).

    Attributes
    ----------
    lambda_ : filter bandwidth lambda, 1/s, > 0
    gamma : learning rate, > 0, 1/(kg m^2 s)
    R0 : initial filter state R(0), s, > 0
    k0 : initial gain k(0), 1/s, >= 0
    a : weight of the attitude term, kg m^2/s^2, > 0
    """

    name: ClassVar[str] = "adaptive-scaling"

    lambda_: Fraction
    gamma: Fraction
    R0: Fraction
    k0: Fraction
    a: Fraction = Fraction(1)

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        """The filter state R and the gain k."""
        return (ControllerState("R", self.R0, "s"), ControllerState("k", self.k0, "1/s"))

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Torque of the family with kappa = k."""
        attitude_term = 2 * parameters["a"] * ca.sumsqr(plant.bv)
        return _control(plant, time, states, parameters, attitude_term)


@final
@dataclass(frozen=True)
class AdaptiveScalingAsPrinted(Law):
    """The same law with its update as printed: ... - 2 gamma g^2 R |bv| (erratum E1)."""

    name: ClassVar[str] = "adaptive-scaling-as-printed"

    lambda_: Fraction
    gamma: Fraction
    R0: Fraction
    k0: Fraction

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        """The filter state R and the gain k."""
        return (ControllerState("R", self.R0, "s"), ControllerState("k", self.k0, "1/s"))

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Torque of the family with kappa = k and the printed update."""
        return _control(plant, time, states, parameters, -2 * ca.norm_2(plant.bv))


def _control(
    plant: PlantSymbols,
    time: TimeSymbols,
    states: Mapping[str, Expression],
    parameters: Mapping[str, Expression],
    attitude_term: Expression,
) -> Control:
    R, k = states["R"], states["k"]
    Omega = augmented_rate(plant, time, k)
    rate_term = (1 + plant.b0) * ca.dot(Omega, plant.J @ Omega)
    k_rate = parameters["gamma"] * R * time.g**2 * (rate_term + attitude_term)
    R_rate = filter_rate(plant, time, R, parameters["lambda"])
    return Control(scaled_torque(plant, time, k, k_rate), {"R": R_rate, "k": k_rate}, k, k_rate)
