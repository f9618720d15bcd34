"""Many runs at once: initial states, parameter sets and bodies, with every run's error controlled."""

from .metrics import EnsembleMetrics, MetricOptions
from .simulate import EnsembleResult, simulate_ensemble
from .steps import Tolerances

__all__ = ["EnsembleMetrics", "EnsembleResult", "MetricOptions", "Tolerances", "simulate_ensemble"]
