"""Versions of the adaptive update between the printed and the corrected one, each one term away."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, final

import casadi as ca

from ...models.laws import (
    AdaptiveScaling,
    Control,
    ControllerState,
    Expression,
    Law,
    PlantSymbols,
    TimeSymbols,
)
from ...models.laws.scaled import scaled_torque


@final
@dataclass(frozen=True)
class AdaptiveScalingSignCorrected(Law):
    """The printed update with only its sign corrected: k' = ... + 2 gamma g^2 R |bv|."""

    name: ClassVar[str] = "adaptive-scaling-sign-corrected"

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
        """Torque of the family with kappa = k; the update differs from the corrected one in one term."""
        correct = AdaptiveScaling(self.lambda_, self.gamma, self.R0, self.k0)
        control = correct.control(plant, time, states, {**parameters, "a": ca.SX(1)})
        length = ca.norm_2(plant.bv)
        wrong = 2 * parameters["gamma"] * time.g**2 * states["R"] * (length - length**2)
        k_rate = control.state_rates["k"] + wrong
        torque = scaled_torque(plant, time, states["k"], k_rate)
        return Control(torque, {"R": control.state_rates["R"], "k": k_rate}, states["k"], k_rate)
