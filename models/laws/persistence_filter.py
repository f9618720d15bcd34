"""The persistence-filter law: kappa = 1/R."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar, final

from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .equations import Equation
from .parameters import known
from .scaled import FILTER, TORQUE, filter_rate, scaled_torque

GAIN = Equation(
    "Persistence filter: gain and Lyapunov function",
    r"kappa &= 1/R, \ V &= R (2 (1 - beta_0) + vb(Omega)^top vb(J) vb(Omega))",
    r"\begin{aligned}\kappa&=1/R,\\"
    r"V&=R\,\bigl(2(1-\beta_0)+\bm\Omega^{\top}\bm J\bm\Omega\bigr)\end{aligned}",
)


@final
@dataclass(frozen=True)
class PersistenceFilter(Law):
    """Persistence-filter law, Omega = w + (2 g^2 / R) bv."""

    name: ClassVar[str] = "persistence-filter"
    equations: ClassVar[tuple[Equation, ...]] = (FILTER, TORQUE, GAIN)

    lambda_: Fraction = field(metadata=known("1/s", "> 0", "filter bandwidth"))
    R0: Fraction = field(metadata=known("s", "> 0", "initial filter state R(0)"))

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
        return filter_control(plant, time, states, parameters, gain_rate_weight=None)


def filter_control(
    plant: PlantSymbols,
    time: TimeSymbols,
    states: Mapping[str, Expression],
    parameters: Mapping[str, Expression],
    *,
    gain_rate_weight: Expression | None,
) -> Control:
    """Return the law's torque; `gain_rate_weight` replaces J in its term with kappa'."""
    R = states["R"]
    R_rate = filter_rate(plant, time, R, parameters["lambda"])
    kappa, kappa_rate = 1 / R, -R_rate / R**2
    torque = scaled_torque(plant, time, kappa, kappa_rate, gain_rate_weight=gain_rate_weight)
    return Control(torque, {"R": R_rate}, kappa, kappa_rate)
