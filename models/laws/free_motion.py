"""No control at all: the motion between windows, and the start of every coast."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, final

from .base import Control, Expression, Law, PlantSymbols, TimeSymbols


@final
@dataclass(frozen=True)
class FreeMotion(Law):
    """u = 0."""

    name: ClassVar[str] = "free-motion"

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Return no torque."""
        del time, states, parameters
        return Control(0 * plant.w)
