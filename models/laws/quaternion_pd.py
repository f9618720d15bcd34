"""Quaternion proportional-derivative feedback through the windows: the laws' common yardstick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from typing import ClassVar, final

from .base import Control, Expression, Law, PlantSymbols, TimeSymbols
from .equations import Equation
from .parameters import known

TORQUE = Equation(
    "Quaternion PD: commanded torque",
    r"vb(u) = -p thin vb(beta)_v - d thin vb(omega)",
    r"\bm u=-p\,\bm\beta_v-d\,\bm\omega",
)


@final
@dataclass(frozen=True)
class QuaternionPD(Law):
    """u = -proportional bv - derivative w, applied as g u.

    Between windows nothing acts, so no stability is claimed in general; the law is here
    because every attitude engineer knows it.
    """

    name: ClassVar[str] = "quaternion-pd"
    equations: ClassVar[tuple[Equation, ...]] = (TORQUE,)

    proportional: Fraction = field(metadata=known("N m", ">= 0", "gain p on the quaternion's vector part"))
    derivative: Fraction = field(metadata=known("N m s", ">= 0", "gain d on the body rate"))

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Proportional and derivative terms."""
        del time, states
        return Control(-parameters["proportional"] * plant.bv - parameters["derivative"] * plant.w)
