"""One member of an uncertain family: the law works with the inertia it believes in, the body has its own.

A member is a law around the law, so that runs and ensembles of members are runs and ensembles: the inertia
that the law sees is a number, the thrusters turn and scale what it asks for, and a torque acts beside them.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar, Literal, final

import casadi as ca
import numpy as np

from .laws import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .laws.scaled import augmented_rate
from .rigid_body import RigidBody
from .types import Array

Direction = Literal["fixed", "rate", "attitude", "momentum"]
"""Where a disturbance points: a fixed vector, or along w, bv or Omega at every instant."""
SOFT = 1e-4
"""A disturbance of size D along x is D x/(|x| + SOFT): it turns without a jump, and stays below D."""


@final
@dataclass(frozen=True)
class Member(Law):
    """A law that believes in one inertia, behind thrusters that are off, with a disturbance.

    Attributes
    ----------
    law : the law flown
    believed : the body that the law computes with
    toward : what the disturbance follows
    thrust : (9,) row by row, what the thrusters make of a torque; exact or float
    disturbance : (3,), N m: a fixed torque, or with another direction its size in the first entry
    """

    name: ClassVar[str] = "member"

    law: Law
    believed: RigidBody
    toward: Direction
    t11: float = 1.0
    t12: float = 0.0
    t13: float = 0.0
    t21: float = 0.0
    t22: float = 1.0
    t23: float = 0.0
    t31: float = 0.0
    t32: float = 0.0
    t33: float = 1.0
    d1: float = 0.0
    d2: float = 0.0
    d3: float = 0.0

    @classmethod
    def of(
        cls, law: Law, believed: RigidBody, *, thrust: Array | None = None, disturbance: Array | None = None,
        toward: Direction = "fixed",
    ) -> Member:  # fmt: skip
        """Build from arrays: thrust (3, 3), the unit matrix by default; disturbance (3,), N m."""
        T = np.eye(3) if thrust is None else np.asarray(thrust, float)
        d = np.zeros(3) if disturbance is None else np.asarray(disturbance, float)
        return cls(law, believed, toward, *T.ravel().tolist(), *d.tolist())

    @property
    def _own(self) -> dict[str, Fraction]:
        names = [f"t{i}{j}" for i in (1, 2, 3) for j in (1, 2, 3)] + ["d1", "d2", "d3"]
        return {f"member_{name}": Fraction(getattr(self, name)) for name in names}

    @property
    def parameters(self) -> dict[str, Fraction]:
        """The law's parameters, then the member's numbers."""
        return {**self.law.parameters, **self._own}

    @property
    def controller_states(self) -> tuple[ControllerState, ...]:
        """The law's."""
        return self.law.controller_states

    @property
    def signals(self) -> Any:
        """The law's."""
        return self.law.signals

    def reset_instants(self, *arguments: Any) -> tuple[Fraction, ...]:
        """The law's."""
        return self.law.reset_instants(*arguments)

    def reset(
        self, plant: PlantSymbols, states: Mapping[str, Expression], parameters: Mapping[str, Expression]
    ) -> Mapping[str, Expression]:
        """The law's, with the inertia it believes in."""
        return self.law.reset(self._seen(plant), states, parameters)

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """What the law asks for, and what becomes of it."""
        own = {name: parameters[name] for name in self._own}
        asked = self.law.control(
            self._seen(plant), time, states, {n: v for n, v in parameters.items() if n not in own}
        )
        values = list(own.values())
        thrust = ca.vertcat(*(ca.horzcat(*values[3 * i : 3 * i + 3]) for i in range(3)))
        return Control(
            asked.torque, asked.state_rates, asked.gain, asked.gain_rate,
            thrust, self._disturbance(plant, time, asked, ca.vertcat(*values[9:])),
        )  # fmt: skip

    def _seen(self, plant: PlantSymbols) -> PlantSymbols:
        J = ca.SX(ca.DM(self.believed.inertia))
        return PlantSymbols(plant.b0, plant.bv, plant.w, J, plant.b0_rate, plant.bv_rate)

    def _disturbance(
        self, plant: PlantSymbols, time: TimeSymbols, asked: Control, torque: Expression
    ) -> Expression:
        if self.toward == "fixed":
            return torque
        if self.toward == "momentum" and asked.gain is not None:
            way = augmented_rate(plant, time, asked.gain)
        else:
            way = plant.bv if self.toward == "attitude" else plant.w
        return torque[0] * way / (ca.norm_2(way) + SOFT)
