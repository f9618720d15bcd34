"""A proved witness of one initial set, and the boxes read off it."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property, lru_cache
from itertools import chain
from math import comb, inf
from typing import final

import numpy as np

from ...models.schedule import polynomial as poly
from ...models.types import Array
from ..exact.bernstein import lower_bound
from ..exact.rounding import rounded_down, rounded_up
from ..flow.stepping import Step
from .boxes import Box
from .sets import InitialSet
from .tail import PeriodicSystem, Tail

PARTS = 8
"""Equal parts of a step, each of which gets its own box."""
ROUNDING = 1e-14
"""Relative allowance for the rounding of a convex combination of fewer than 20 floats (2e-15)."""


class LawComparison(PeriodicSystem):
    """A comparison system of one law with Omega = w + 2 g^2 kappa bv, and the names of what it bounds.

    Attributes
    ----------
    floor_component : the component that bounds the law's filter state R from below, or None
    """

    floor_component: str | None = None

    @abstractmethod
    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """Values at t = 0, on the safe side of the initial set."""

    @abstractmethod
    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Box fields from least and greatest values of the components; in the tail too.

        cosine_gap, weighted_rate, gain_low, gain_high, and where there is a filter filter_low, filter_high.
        """


@final
@dataclass(frozen=True)
class Flowpipe:
    """Proved bounds of every trajectory that starts in `initial`.

    Attributes
    ----------
    steps : proved steps from t = 0
    tail : repeating steps from the end of `steps` on, or None
    failed_at : instant from which nothing could be proved, s, or None
    """

    system: LawComparison
    initial: InitialSet
    steps: tuple[Step, ...]
    tail: Tail | None = None
    failed_at: Fraction | None = None

    @cached_property
    def floor(self) -> float:
        """A proved lower bound of R over the time covered, s; inf of a law without filter."""
        if self.system.floor_component is None:
            return inf
        least = Fraction(10**9)
        everything = [s.controls[self.system.floor_component] for s in self.all_steps()]
        for controls in sorted(everything, key=min):
            if min(controls) >= least:
                break
            least = min(least, lower_bound(controls, 5))
        return rounded_down(least)

    def all_steps(self) -> Iterator[Step]:
        """Steps of the transient and of the tail's first period."""
        return chain(self.steps, self.tail.steps if self.tail else ())

    @property
    def end(self) -> Fraction:
        """End of the time covered by steps, s (a tail covers all later time)."""
        return self.steps[-1].stop if self.steps else Fraction(0)

    @cached_property
    def boxes(self) -> tuple[Box, ...]:
        """Boxes of the transient."""
        return tuple(chain.from_iterable(step_boxes(self.system, s) for s in self.steps))

    @cached_property
    def tail_boxes(self) -> tuple[Box, ...]:
        """Boxes of the tail's first period; they hold in every later period too.

        Angle and rate may be scaled down from period to period, so that bounds which do not shrink
        (of s and y, once s is given up) must not enter them.
        """
        if self.tail is None:
            return ()
        fixed = {**self.tail.limits, **dict.fromkeys(self.tail.given_up, inf)}
        return tuple(chain.from_iterable(step_boxes(self.system, s, fixed) for s in self.tail.steps))


@cache
def _division(degree: int, parts: int) -> Array:
    """(parts, degree + 1, degree + 1): Bernstein coefficients of each of the equal parts."""
    blocks = []
    for i in range(parts):
        a, b = i / parts, (i + 1) / parts
        rows = []
        for k in range(degree + 1):  # blossom at (a^(n-k), b^k)
            weights = np.zeros(degree + 1)
            for p in range(degree - k + 1):
                for q in range(k + 1):
                    weights[p + q] += (
                        comb(degree - k, p) * a**p * (1 - a) ** (degree - k - p)
                        * comb(k, q) * b**q * (1 - b) ** (k - q)
                    )  # fmt: skip
            rows.append(weights)
        blocks.append(rows)
    return np.array(blocks)


def step_boxes(
    system: LawComparison, step: Step, fixed: Mapping[str, float] | None = None, parts: int = PARTS
) -> Iterator[Box]:
    """Boxes of the equal parts of one step; `fixed` overrides upper bounds of components."""
    low, high = {}, {}
    for name, controls in step.controls.items():
        values = _division(len(controls) - 1, parts) @ np.array(controls)
        allowance = ROUNDING * max(abs(c) for c in controls)
        low[name], high[name] = values.min(axis=1) - allowance, values.max(axis=1) + allowance
    for name, value in (fixed or {}).items():
        high[name] = np.full(parts, value)
    fields = system.bounds(low, high)
    shared = _gain_extremes(step.shape, step.part, step.length, parts)
    times = [float(step.start + step.length * Fraction(i, parts)) for i in range(parts + 1)]
    for i in range(parts):
        row = {"filter_low": inf, "filter_high": 0.0}
        row |= {name: float(values[i]) for name, values in fields.items()}
        least, most, slope_low, slope_high = shared[i]
        row |= {"gain_min": least, "gain_max": most, "slope_low": slope_low, "slope_high": slope_high}
        yield Box(times[i], times[i + 1], **row)


@lru_cache(maxsize=65536)
def _gain_extremes(
    shape: poly.Coefficients, part: tuple[int, int], length: Fraction, parts: int
) -> tuple[tuple[float, float, float, float], ...]:
    """Least g >= 0, greatest |g|, least and greatest g' on the equal parts of a step, rounded outwards."""
    j, n = part
    found = []
    for i in range(parts):
        local = poly.compose_affine(shape, Fraction(j * parts + i, n * parts), Fraction(1, n * parts))
        slope = poly.bernstein(poly.scale(poly.derivative(local), parts / length))
        gains = poly.bernstein(local)
        least, most = max(0.0, rounded_down(min(gains))), rounded_up(max(abs(c) for c in gains))
        found.append((least, most, rounded_down(min(slope)), rounded_up(max(slope))))
    return tuple(found)
