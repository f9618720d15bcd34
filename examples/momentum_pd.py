"""A user's own law: proportional on the attitude, derivative on the angular momentum."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar, final

from intermit.models.laws import Control, Expression, Law, PlantSymbols, TimeSymbols


@final
@dataclass(frozen=True)
class MomentumPD(Law):
    """u = -stiffness J bv - damping J w, applied as g u; stiffness in 1/s^2, damping in 1/s."""

    name: ClassVar[str] = "momentum-pd"

    stiffness: Fraction
    damping: Fraction

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Both terms, weighted by the inertia."""
        del time, states
        return Control(-plant.J @ (parameters["stiffness"] * plant.bv + parameters["damping"] * plant.w))
