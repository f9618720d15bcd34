"""Control laws, one a file; `LAWS` names those a scenario file can ask for."""

from .adaptive_scaling import AdaptiveScaling, AdaptiveScalingAsPrinted
from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .free_motion import FreeMotion
from .persistence_filter import PersistenceFilter, PersistenceFilterAsPrinted
from .quaternion_pd import QuaternionPD

LAWS: dict[str, type[Law]] = {
    law.name: law
    for law in (
        AdaptiveScaling,
        AdaptiveScalingAsPrinted,
        PersistenceFilter,
        PersistenceFilterAsPrinted,
        QuaternionPD,
    )
}

__all__ = [
    "LAWS",
    "AdaptiveScaling",
    "AdaptiveScalingAsPrinted",
    "Control",
    "ControllerState",
    "Expression",
    "FreeMotion",
    "Law",
    "PersistenceFilter",
    "PersistenceFilterAsPrinted",
    "PlantSymbols",
    "QuaternionPD",
    "TimeSymbols",
]
