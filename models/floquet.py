"""Floquet analysis of a periodic linear system, in floating point."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from numpy.typing import NDArray

from .types import Array

ComplexArray = NDArray[np.complex128]


@final
@dataclass(frozen=True, eq=False)
class Floquet:
    """Monodromy matrix of x' = M(t) x, M of period T, and what follows from it.

    Floats, not enclosures. A multiple multiplier of a defective matrix is found only to a root of
    rounding: a double one to about 1e-8.

    Attributes
    ----------
    period : T, s
    monodromy : (n, n), takes x(0) to x(T)
    """

    period: float
    monodromy: Array

    @cached_property
    def multipliers(self) -> ComplexArray:
        """Eigenvalues of the monodromy matrix, largest modulus first, (n,)."""
        values = np.linalg.eigvals(self.monodromy).astype(complex)
        return np.asarray(values[np.argsort(-np.abs(values), kind="stable")])

    @cached_property
    def exponents(self) -> ComplexArray:
        """log(multiplier)/T with the principal argument, 1/s, (n,); the real part is the growth rate."""
        with np.errstate(divide="ignore"):
            return np.asarray(np.log(self.multipliers) / self.period)

    @property
    def mean_exponent(self) -> float:
        """Mean of the exponents' real parts, 1/s, from the determinant: accurate even where multiple."""
        _, logarithm = np.linalg.slogdet(self.monodromy)
        return float(logarithm / (self.period * len(self.monodromy)))

    @property
    def is_stable(self) -> bool:
        """Whether all multipliers lie inside the unit circle, as computed."""
        return bool(np.abs(self.multipliers).max() < 1)
