"""The paper's adaptive scaling: kappa = k with its own update."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar, final

from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .equations import Equation
from .parameters import known
from .scaled import FILTER, TORQUE, augmented_rate, filter_rate, scaled_torque

GAIN = Equation(
    "Adaptive scaling: gain and Lyapunov function",
    r"kappa &= k, quad dot(k) = gamma R g^2 ((1 + beta_0) vb(Omega)^top vb(J) vb(Omega) "
    r"+ 2 a |vb(beta)_v|^2), \ "
    r"V &= 2 a (1 - beta_0) R + R vb(Omega)^top vb(J) vb(Omega) + (k - k^*)^2 / (2 gamma)",
    r"\begin{aligned}\kappa&=k,\qquad\dot k=\gamma Rg^2\bigl((1+\beta_0)\bm\Omega^{\top}\bm J\bm\Omega"
    r"+2a|\bm\beta_v|^2\bigr),\\"
    r"V&=2a(1-\beta_0)R+R\,\bm\Omega^{\top}\bm J\bm\Omega+\frac{(k-k^*)^2}{2\gamma}\end{aligned}",
)


@dataclass(frozen=True)
class AdaptiveUpdate(Law):
    """Adaptive law with Omega = w + 2 g^2 k bv, k' = gamma R g^2 [(1 + b0) Omega'J Omega + attitude term]."""

    lambda_: Fraction = field(metadata=known("1/s", "> 0", "filter bandwidth"))
    gamma: Fraction = field(metadata=known("1/(kg m^2 s)", "> 0", "learning rate"))
    R0: Fraction = field(metadata=known("s", "> 0", "initial filter state R(0)"))
    k0: Fraction = field(metadata=known("1/s", ">= 0", "initial gain k(0)"))

    @abstractmethod
    def attitude_term(self, plant: PlantSymbols, parameters: Mapping[str, Expression]) -> Expression:
        """The update's term in the attitude alone, kg m^2/s^2: what the versions differ in."""

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        """The filter state R and the gain k."""
        return (ControllerState("R", self.R0, "s"), ControllerState("k", self.k0, "1/s", least=Fraction(0)))

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Torque of the family with kappa = k."""
        import casadi as ca

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
    """

    name: ClassVar[str] = "adaptive-scaling"
    equations: ClassVar[tuple[Equation, ...]] = (FILTER, TORQUE, GAIN)

    a: Fraction = field(
        default=Fraction(1), metadata=known("kg m^2/s^2", "> 0", "weight of the attitude term")
    )

    def attitude_term(self, plant: PlantSymbols, parameters: Mapping[str, Expression]) -> Expression:
        """2 a |bv|^2."""
        import casadi as ca

        return 2 * parameters["a"] * ca.sumsqr(plant.bv)
