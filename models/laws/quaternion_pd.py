"""Quaternion proportional-derivative feedback through the windows: the laws' common yardstick."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, final

from .base import Control, Expression, Law, PlantSymbols, TimeSymbols


@final
@dataclass(frozen=True)
class QuaternionPD(Law):
    """u = -proportional bv - derivative w, applied as g u.

    Between windows nothing acts, so no stability is claimed in general; the law is here
    because every attitude engineer knows it.

    Attributes
    ----------
    proportional : gain on the quaternion's vector part, N m
    derivative : gain on the body rate, N m s
    """

    name: ClassVar[str] = "quaternion-pd"

    proportional: Fraction
    derivative: Fraction

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
