"""What is best: windowed optimum, certified lower bounds, comparison, tuning.

Names are loaded when first used: the solvers are heavy to import.
"""

from __future__ import annotations

from importlib import import_module
from typing import Any

_EXPORTS = {
    "EUCLIDEAN": "..models.norms",
    "LARGEST_COMPONENT": "..models.norms",
    "MultiStart": ".peak",
    "NonlinearProgram": ".peak",
    "PeakAnswer": ".peak",
    "Refinement": ".peak",
    "SequentialConvex": ".peak",
    "Terminal": ".problem",
    "TransferProblem": ".problem",
    "WindowProfile": ".problem",
    "minimum_impulse": ".peak",
    "minimum_peak": ".peak",
    "minimum_time": ".peak",
    "thrusters": "..models.norms",
}

__all__ = sorted(_EXPORTS)


def __getattr__(name: str) -> Any:
    if name not in _EXPORTS:
        raise AttributeError(f"module 'intermit.optim' has no attribute {name!r}")
    return getattr(import_module(_EXPORTS[name], __name__), name)


def __dir__() -> list[str]:
    return __all__
