"""The derivative of a storage function over sampled states: evidence, and witnesses, never proof."""

from .claim import ContradictionError, SampledDerivative, interpret, with_samples
from .domain import SampledDomain
from .function import DerivativeFunction, derivative_function
from .sampling import DerivativeSamples, Sampling, sample_derivative
from .witness import exact_witness

__all__ = [
    "ContradictionError",
    "DerivativeFunction",
    "DerivativeSamples",
    "SampledDerivative",
    "SampledDomain",
    "Sampling",
    "derivative_function",
    "exact_witness",
    "interpret",
    "sample_derivative",
    "with_samples",
]
