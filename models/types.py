"""Types that every room uses."""

from __future__ import annotations

from collections.abc import Callable
from fractions import Fraction
from typing import Any

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]
"""A float array; its shape stands in the docstring of what takes or returns it."""

ExactMatrix = tuple[tuple[Fraction, ...], ...]
"""A matrix of rationals, by rows."""

Progress = Callable[[str, float], None]
"""Told the stage (in words) and the share of it that is done, 0 to 1."""


class Interrupted(KeyboardInterrupt):
    """An interrupt that brings along what was found before it.

    Attributes
    ----------
    found : the study so far, of the kind that the study would have returned
    left_out : what is not in it, in words
    """

    def __init__(self, found: Any, left_out: str) -> None:
        self.found, self.left_out = found, left_out
        super().__init__(left_out)


def silent(stage: str, share: float) -> None:
    """Report no progress."""
    del stage, share
