"""The paper's adaptive scaling: kappa = k with its own update."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, final

import casadi as ca

from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .scaled import augmented_rate, filter_rate, scaled_torque


@dataclass(frozen=True)
class AdaptiveUpdate(Law):
    """Adaptive law with Omega = w + 2 g^2 k bv, k' = gamma R g^2 [(1 + b0) Omega'J Omega + attitude term].

    Attributes
    ----------
    lambda_ : filter bandwidth lambda, 1/s, > 0
    gamma : learning rate, > 0, 1/(kg m^2 s)
    R0 : initial filter state R(0), s, > 0
    k0 : initial gain k(0), 1/s, >= 0
    """

    lambda_: Fraction
    gamma: Fraction
    R0: Fraction
    k0: Fraction

    @abstractmethod
    def attitude_term(self, plant: PlantSymbols, parameters: Mapping[str, Expression]) -> Expression:
        """The update's term in the attitude alone, kg m^2/s^2: what the versions differ in."""

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
        R, k = states["R"], states["k"]
        Omega = augmented_rate(plant, time, k)
        rate_term = (1 + plant.b0) * ca.dot(Omega, plant.J @ Omega)
        k_rate = parameters["gamma"] * R * time.g**2 * (rate_term + self.attitude_term(plant, parameters))
        R_rate = filter_rate(plant, time, R, parameters["lambda"])
        return Control(scaled_torque(plant, time, k, k_rate), {"R": R_rate, "k": k_rate}, k, k_rate)


@final
@dataclass(frozen=True)
class AdaptiveScaling(AdaptiveUpdate):
    """Adaptive scaling law: k' = gamma R g^2 [(1 + b0) Omega'J Omega + 2 a |bv|^2].

    a = 1 is the update of Ram & Akella (AAS 21-402) with its last term corrected in sign and power
    (erratum E1).

    Attributes
    ----------
    a : weight of the attitude term, kg m^2/s^2, > 0
    """

    name: ClassVar[str] = "adaptive-scaling"

    a: Fraction = Fraction(1)

    def attitude_term(self, plant: PlantSymbols, parameters: Mapping[str, Expression]) -> Expression:
        """2 a |bv|^2."""
        return 2 * parameters["a"] * ca.sumsqr(plant.bv)


@final
@dataclass(frozen=True)
class AdaptiveScalingAsPrinted(AdaptiveUpdate):
    """The same law with its update as printed: ... - 2 gamma g^2 R |bv| (erratum E1)."""

    name: ClassVar[str] = "adaptive-scaling-as-printed"

    def attitude_term(self, plant: PlantSymbols, parameters: Mapping[str, Expression]) -> Expression:
        """-2 |bv|."""
        del parameters
        return -2 * ca.norm_2(plant.bv)
