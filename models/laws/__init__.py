"""Control laws, one a file; `LAWS` names those a scenario file can ask for."""

from .adaptive_scaling import AdaptiveScaling
from .as_printed import AdaptiveScalingAsPrinted, PersistenceFilterAsPrinted
from .base import Control, ControllerState, Expression, Law, PlantSymbols, TimeSymbols
from .equations import Equation
from .free_motion import FreeMotion
from .parameters import Parameter, known
from .persistence_filter import PersistenceFilter
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
    "Equation",
    "Expression",
    "FreeMotion",
    "Law",
    "Parameter",
    "PersistenceFilter",
    "PersistenceFilterAsPrinted",
    "PlantSymbols",
    "QuaternionPD",
    "TimeSymbols",
    "known",
]
