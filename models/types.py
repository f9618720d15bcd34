"""Types that every room uses."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""A float array; its shape stands in the docstring of what takes or returns it."""

ExactMatrix = tuple[tuple[Fraction, ...], ...]
"""A matrix of rationals, by rows."""

Progress = Callable[[str, float], None]
"""Told the stage (in words) and the share of it that is done, 0 to 1."""


def silent(stage: str, share: float) -> None:
    """Report no progress."""
    del stage, share
