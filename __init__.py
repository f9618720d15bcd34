"""intermit: optimisation and verification for attitude control with intermittent external torque.

Names are loaded when first used, so that `import intermit` costs nothing.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

__version__ = "0.1.0"

_EXPORTS = {
    "AdaptiveScaling": ".models.laws",
    "Law": ".models.laws",
    "PersistenceFilter": ".models.laws",
    "QuaternionPD": ".models.laws",
    "RigidBody": ".models.rigid_body",
    "Schedule": ".models.schedule",
    "Window": ".models.schedule",
    "build_schedule": ".models.schedule",
    "close_loop": ".models.closed_loop",
}

__all__ = ["__version__", *sorted(_EXPORTS)]


def __getattr__(name: str) -> Any:
    if name not in _EXPORTS:
        raise AttributeError(f"module 'intermit' has no attribute {name!r}")
    return getattr(import_module(_EXPORTS[name], __name__), name)


def __dir__() -> list[str]:
    return sorted(__all__)
