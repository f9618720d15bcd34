"""Versions of the adaptive update between the printed and the corrected one, each one term away."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import ClassVar, final

import casadi as ca

from ....models.laws import Expression, PlantSymbols
from ....models.laws.adaptive_scaling import AdaptiveUpdate


@final
@dataclass(frozen=True)
class AdaptiveScalingSignCorrected(AdaptiveUpdate):
    """The printed update with only its sign corrected: k' = ... + 2 gamma g^2 R |bv|."""

    name: ClassVar[str] = "adaptive-scaling-sign-corrected"

    def attitude_term(self, plant: PlantSymbols, parameters: Mapping[str, Expression]) -> Expression:
        """2 |bv|."""
        del parameters
        return 2 * ca.norm_2(plant.bv)
