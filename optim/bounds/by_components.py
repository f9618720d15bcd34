"""Bound for the largest component: the momentum's components are bounded one by one as well."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ...verify.exact.rounding import rounded_down
from .argument import ComponentsArgument, NamedBound
from .potential.path import PathOptions
from .prepare import Measured
from .proof import path_of
from .sets.gauge import GaugeSet
from .windows.components import ComponentBounds, Widths, component_bounds, peak_from_components
from .windows.drift import box_for
from .windows.split import Split, Splits


def by_components(measured: Measured, options: PathOptions, known: Fraction) -> NamedBound | None:
    """Bound from components, at a trial peak a little above the bound known; None if it promises no more."""
    problem, windows, momenta = measured.prepared.problem, measured.prepared.windows, measured.momenta
    assert isinstance(momenta, GaugeSet)
    if windows.total == 0 or known <= 0:
        return None
    splits, trial = Splits(problem, momenta, windows), float(known) * options.trial
    split = splits.at_rest(windows.instant(windows.total / 2))
    bounds = component_bounds(momenta, split.sides, trial)
    if not problem.starts_at_rest:
        moving = splits.promising(bounds, options.share, float(known))
        if moving is None:
            return None
        split, bounds = moving, component_bounds(momenta, moving.sides, trial)
    beta = box_for(split.sides.components(bounds.rates, trial), options.share)
    if problem.starts_at_rest and all(b >= r for b, r in zip(beta, bounds.widths, strict=True)):
        return None
    path = path_of(problem, split.coast.attitude, momenta.with_box(beta), options)
    peak, bounds = _largest_peak(momenta, split, beta, rounded_down(path.travel - split.slack), bounds)
    name = "components" if problem.starts_at_rest else "components after a coast"
    argument = ComponentsArgument(measured, path, beta, bounds, split.coast, splits.end)
    return NamedBound(name, Fraction(peak), argument)


def _largest_peak(
    momenta: GaugeSet, split: Split, beta: Widths, travel: float, bounds: ComponentBounds
) -> tuple[float, ComponentBounds]:
    """Largest peak found for a travel: any trial at or above it is valid, the nearest is the sharpest."""
    best, box = (0.0, bounds), np.array([float(b) for b in beta])
    for _ in range(6):
        peak = peak_from_components(split.sides, bounds, beta, travel)
        if peak > best[0]:
            best = peak, bounds
        allowed = split.sides.allowed(bounds.trial, bounds.rates, box)
        near = bounds.trial * travel / allowed if allowed else 0.0  # were all in proportion
        if near <= 0 or best[0] < bounds.trial < best[0] * 1.002:
            break
        bounds = component_bounds(momenta, split.sides, near * 1.001)
    return best
