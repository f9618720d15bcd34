"""The laws of Ram & Akella (AAS 21-402) as they are printed, each with its one misprint.

They are here to be refuted: the audit and the examples show what each misprint does.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar, final

from .adaptive_scaling import AdaptiveUpdate
from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .equations import Equation
from .parameters import known
from .persistence_filter import GAIN, filter_control
from .scaled import FILTER, TORQUE

PRINTED_TORQUE = Equation(
    "Commanded torque, as printed (erratum E3)",
    r"vb(Omega) &= vb(omega) + 2 g^2 kappa thin vb(beta)_v, \ "
    r"vb(u) &= -2 g kappa thin vb(beta)_v times vb(J) vb(omega) - 4 dot(g) kappa thin vb(J) vb(beta)_v "
    r"- 2 g dot(kappa) thin vb(beta)_v \ "
    r"&quad - 2 g kappa thin vb(J) dot(vb(beta))_v - 1/2 g kappa (1 + beta_0) vb(J) vb(Omega)",
    r"\begin{aligned}\bm\Omega&=\bm\omega+2g^2\kappa\bm\beta_v,\\"
    r"\bm u&=-2g\kappa\,\bm\beta_v\times\bm J\bm\omega-4\dot g\kappa\bm J\bm\beta_v"
    r"-2g\dot\kappa\bm\beta_v\\"
    r"&\quad-2g\kappa\bm J\dot{\bm\beta}_v-\tfrac12g\kappa(1+\beta_0)\bm J\bm\Omega\end{aligned}",
)
PRINTED_GAIN = Equation(
    "Adaptive scaling, as printed (erratum E1): gain and Lyapunov function",
    r"kappa &= k, quad dot(k) = gamma R g^2 ((1 + beta_0) vb(Omega)^top vb(J) vb(Omega) "
    r"- 2 |vb(beta)_v|), \ "
    r"V &= 2 (1 - beta_0) R + R vb(Omega)^top vb(J) vb(Omega) + (k - k^*)^2 / (2 gamma)",
    r"\begin{aligned}\kappa&=k,\qquad\dot k=\gamma Rg^2\bigl((1+\beta_0)\bm\Omega^{\top}\bm J\bm\Omega"
    r"-2|\bm\beta_v|\bigr),\\"
    r"V&=2(1-\beta_0)R+R\,\bm\Omega^{\top}\bm J\bm\Omega+\frac{(k-k^*)^2}{2\gamma}\end{aligned}",
)


@final
@dataclass(frozen=True)
class AdaptiveScalingAsPrinted(AdaptiveUpdate):
    """Adaptive scaling with its update as printed: ... - 2 gamma g^2 R |bv| (erratum E1)."""

    name: ClassVar[str] = "adaptive-scaling-as-printed"
    equations: ClassVar[tuple[Equation, ...]] = (FILTER, TORQUE, PRINTED_GAIN)

    def attitude_term(self, plant: PlantSymbols, parameters: Mapping[str, Expression]) -> Expression:
        """-2 |bv|."""
        import casadi as ca

        del parameters
        return -2 * ca.norm_2(plant.bv)


@final
@dataclass(frozen=True)
class PersistenceFilterAsPrinted(Law):
    """The persistence-filter law with its third term as printed, (2 g R'/R^2) bv without J (erratum E3)."""

    name: ClassVar[str] = "persistence-filter-as-printed"
    equations: ClassVar[tuple[Equation, ...]] = (FILTER, PRINTED_TORQUE, GAIN)

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
        """Torque with the unit matrix in place of J in the term with R'."""
        import casadi as ca

        return filter_control(plant, time, states, parameters, gain_rate_weight=ca.SX.eye(3))
