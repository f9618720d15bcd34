"""Many runs at once: initial states, parameter sets and bodies, with every run's error controlled."""

from .simulate import EnsembleResult, simulate_ensemble
from .steps import Tolerances

__all__ = ["EnsembleResult", "Tolerances", "simulate_ensemble"]
