"""When a run's histories are written: every output step, or finely where torque acts and few in coasts."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil

import numpy as np

from ..models.types import Array
from ..scenario import Scenario
from ..scenario.scenario import MAX_OUTPUTS

DEFAULT_STEP = Fraction(1, 100)
"""Step, s, where the scenario gives none."""
MOST = 10**6
"""Instants outside long coasts, at most, where the scenario gives no step."""
LONG_COAST = Fraction(1000)
"""A stretch without torque is long above this, s."""
COAST_STEPS = 1000
"""Steps of a long coast, where the scenario gives none."""


def output_times(scenario: Scenario, origin: Fraction = Fraction(0), *, absolute: bool = False) -> Array:
    """Times of the histories from `origin` to the horizon, which is always the last, s.

    Counted from `origin`, or from the start of the run if `absolute`; each is rounded once.
    """
    shift = origin if absolute else Fraction(0)
    end, step = scenario.horizon - origin, scenario.simulation.output_step
    if step is not None:
        step *= max(1, ceil(end / step / MAX_OUTPUTS))
        return np.array([*_ticks(Fraction(0), end, step, shift), float(end + shift)])
    coasts = list(_long_coasts(scenario, origin))
    rest = end - sum((stop - start for start, stop in coasts), Fraction(0))
    step = _coarser(DEFAULT_STEP, rest)
    times: list[float] = []
    at = Fraction(0)
    for start, stop in [*coasts, (end, end)]:
        times += _ticks(at, start, step, shift)
        if stop > start:
            times += _ticks(start, stop, (stop - start) / COAST_STEPS, shift)
        at = stop
    return np.array([*times, float(end + shift)])


def _long_coasts(scenario: Scenario, origin: Fraction) -> Iterator[tuple[Fraction, Fraction]]:
    """Long stretches without torque, counted from `origin`."""
    at = origin
    for window in scenario.schedule.support_between(origin, scenario.horizon):
        if window.on - at > LONG_COAST:
            yield at - origin, window.on - origin
        at = max(at, window.off)
    if scenario.horizon - at > LONG_COAST:
        yield at - origin, scenario.horizon - origin


def _coarser(step: Fraction, length: Fraction) -> Fraction:
    """The step, or 2, 5, 10, ... times it, with which a length has no more than `MOST` instants."""
    factor = 1
    while length / (step * factor) > MOST:
        leading = int(str(factor)[0])
        factor = factor // leading * {1: 2, 2: 5, 5: 10}[leading]
    return step * factor


def _ticks(start: Fraction, stop: Fraction, step: Fraction, shift: Fraction) -> list[float]:
    """Start + shift, start + shift + step, ... below stop + shift: whole numbers over one denominator."""
    first = start + shift
    denominator = first.denominator * step.denominator
    p, q = first.numerator * step.denominator, step.numerator * first.denominator
    return [(p + i * q) / denominator for i in range(ceil((stop - start) / step))]
