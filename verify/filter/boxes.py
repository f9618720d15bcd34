"""Bounds on stretches of time: one box, and many as arrays."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from ...models.types import Array

Interval = tuple[Array, Array]
"""Least and greatest values, (n,) each."""
OUTWARD = 1 + 1e-12
"""Covers fewer than 1000 roundings (1.2e-16 each) of operations on numbers of one sign."""


@final
@dataclass(frozen=True)
class Box:
    """Bounds that hold at every t in [start, stop] for every trajectory of the initial set.

    Attributes
    ----------
    start, stop : time, s
    cosine_gap : upper bound of S = 1 - b0; it may exceed 2 in a tail, where it is scaled down
    weighted_rate : upper bound of y = |Omega|_J, sqrt(kg m^2) rad/s
    filter_low, filter_high : bounds of R, s
    gain_low, gain_high : bounds of kappa, 1/s
    gain_min, gain_max : lower bound of g (0 where it is below) and bound of |g| in the interval
    slope_low, slope_high : bounds of g' in the interval, 1/s
    """

    start: float
    stop: float
    cosine_gap: float
    weighted_rate: float
    filter_low: float
    filter_high: float
    gain_low: float
    gain_high: float
    gain_min: float
    gain_max: float
    slope_low: float
    slope_high: float


@final
@dataclass(frozen=True)
class BoxColumns:
    """Boxes as arrays, (n,) each.

    Attributes
    ----------
    S, y : upper bounds of 1 - b0 and of |Omega|_J, kg^1/2 m rad/s
    low_filter, R : bounds of R from below and from above, s
    low, high : bounds of kappa, 1/s
    g_low, g, slope_low, slope_high : bounds of g >= 0 and of |g|, bounds of g', 1/s
    start, stop : s
    """

    S: Array
    y: Array
    low_filter: Array
    R: Array
    low: Array
    high: Array
    g_low: Array
    g: Array
    slope_low: Array
    slope_high: Array
    start: Array
    stop: Array

    @property
    def b0_low(self) -> Array:
        """Lower bound of b0."""
        low: Array = 1.0 - np.minimum(self.S, 2.0)
        return low

    @classmethod
    def of(cls, boxes: Iterable[Box]) -> BoxColumns:
        """Gather boxes, at least one."""
        rows = [
            (b.cosine_gap, b.weighted_rate, b.filter_low, b.filter_high, b.gain_low, b.gain_high,
             b.gain_min, b.gain_max, b.slope_low, b.slope_high, b.start, b.stop)
            for b in boxes
        ]  # fmt: skip
        return cls(*np.array(rows).T)

    def later(self, shift: float, scale: float) -> BoxColumns:
        """The same `shift` s later, s = sqrt(S) and y at most `scale` times theirs, S and y rounded up."""
        if scale == 1.0:
            return replace(self, start=self.start + shift, stop=self.stop + shift)
        return replace(
            self,
            S=np.nextafter(self.S * scale * scale * OUTWARD, np.inf),
            y=np.nextafter(self.y * scale, np.inf),
            start=self.start + shift,
            stop=self.stop + shift,
        )


def greatest_bv(S: Array) -> Array:
    """Bound of |bv| = sqrt(S' (2 - S')) over S' <= S."""
    inside = np.minimum(S, 1.0)
    bound: Array = np.sqrt(inside * (2.0 - inside)) * OUTWARD
    return bound


def summed(terms: Sequence[Interval]) -> Interval:
    """Add intervals, widened by their rounding."""
    zero: Array = np.zeros_like(terms[0][0])
    size = sum((np.maximum(np.abs(a), np.abs(b)) for a, b in terms), zero)
    allowance = size * (OUTWARD - 1)
    return sum((a for a, _ in terms), zero) - allowance, sum((b for _, b in terms), zero) + allowance
