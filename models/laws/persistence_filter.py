"""The persistence-filter law: kappa = 1/R."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, final

import casadi as ca

from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .scaled import filter_rate, scaled_torque


@final
@dataclass(frozen=True)
class PersistenceFilter(Law):
    """Persistence-filter law, Omega = w + (2 g^2 / R) bv.

    Attributes
    ----------
    lambda_ : filter bandwidth lambda, 1/s, > 0
    R0 : initial filter state R(0), s, > 0
    """

    name: ClassVar[str] = "persistence-filter"

    lambda_: Fraction
    R0: Fraction

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        """The filter state R."""
        return (ControllerState("R", self.R0, "s"),)

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Torque of the family with kappa = 1/R."""
        return _control(plant, time, states, parameters, gain_rate_weight=None)


@final
@dataclass(frozen=True)
class PersistenceFilterAsPrinted(Law):
    """The same law with its third term as printed, (2 g R'/R^2) bv without J (erratum E3)."""

    name: ClassVar[str] = "persistence-filter-as-printed"

    lambda_: Fraction
    R0: Fraction

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        """The filter state R."""
        return (ControllerState("R", self.R0, "s"),)

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Torque with the unit matrix in place of J in the term with R'."""
        return _control(plant, time, states, parameters, gain_rate_weight=ca.SX.eye(3))


def _control(
    plant: PlantSymbols,
    time: TimeSymbols,
    states: Mapping[str, Expression],
    parameters: Mapping[str, Expression],
    *,
    gain_rate_weight: Expression | None,
) -> Control:
    R = states["R"]
    R_rate = filter_rate(plant, time, R, parameters["lambda"])
    kappa, kappa_rate = 1 / R, -R_rate / R**2
    torque = scaled_torque(plant, time, kappa, kappa_rate, gain_rate_weight=gain_rate_weight)
    return Control(torque, {"R": R_rate}, kappa, kappa_rate)
