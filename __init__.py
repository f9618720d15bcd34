"""intermit: optimisation and verification for attitude control with intermittent external torque.

Names are loaded when first used, so that `import intermit` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from .errors import InputError as InputError
    from .models.closed_loop import close_loop as close_loop
    from .models.laws import AdaptiveScaling as AdaptiveScaling
    from .models.laws import Law as Law
    from .models.laws import PersistenceFilter as PersistenceFilter
    from .models.laws import QuaternionPD as QuaternionPD
    from .models.norms import EUCLIDEAN as EUCLIDEAN
    from .models.norms import LARGEST_COMPONENT as LARGEST_COMPONENT
    from .models.rigid_body import RigidBody as RigidBody
    from .models.schedule import Schedule as Schedule
    from .models.schedule import Window as Window
    from .models.schedule import build_schedule as build_schedule
    from .scenario import Scenario as Scenario
    from .scenario import ScenarioError as ScenarioError
    from .study.door import bound as bound
    from .study.door import certify as certify
    from .study.door import check as check
    from .study.door import compare as compare
    from .study.door import load as load
    from .study.door import optimum as optimum
    from .study.door import recheck as recheck
    from .study.door import report as report
    from .study.door import simulate as simulate
    from .study.door import tune as tune

__version__ = "0.1.0"

_DOOR = ("bound", "certify", "check", "compare", "load", "optimum", "recheck", "report", "simulate", "tune")
"""What the command line does, each as one call."""
_EXPORTS = {
    "AdaptiveScaling": ".models.laws",
    "EUCLIDEAN": ".models.norms",
    "InputError": ".errors",
    "LARGEST_COMPONENT": ".models.norms",
    "Law": ".models.laws",
    "PersistenceFilter": ".models.laws",
    "QuaternionPD": ".models.laws",
    "RigidBody": ".models.rigid_body",
    "Schedule": ".models.schedule",
    "Window": ".models.schedule",
    "build_schedule": ".models.schedule",
    "close_loop": ".models.closed_loop",
    "Scenario": ".scenario",
    "ScenarioError": ".scenario",
    **dict.fromkeys(_DOOR, ".study.door"),
}

__all__ = ["__version__", *sorted(_EXPORTS)]


def __getattr__(name: str) -> Any:
    if name not in _EXPORTS:
        raise AttributeError(f"module 'intermit' has no attribute {name!r}")
    return getattr(import_module(_EXPORTS[name], __name__), name)


def __dir__() -> list[str]:
    return sorted(__all__)
