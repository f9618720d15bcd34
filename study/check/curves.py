"""Certified bounds over time, on a grid, for figures and the record."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from ...models.types import Array
from ...verify.filter.certify import FilterLowerBound
from ...verify.filter.flowpipe import Box, Flowpipe

CELLS = 800
"""Cells of the grid from 0 to the horizon."""
OUTWARD = 1 + 1e-12


@final
@dataclass(frozen=True)
class CertifiedCurves:
    """Bounds that hold throughout each cell of a time grid; the value at a cell's start stands for it.

    Attributes
    ----------
    time : (n,) starts of the cells, s
    filter_floor : (n,) lower bound of R, s
    angle_bound : (n,) upper bound of the error angle 2 acos b0, rad
    rate_bound : (n,) upper bound of |Omega|_J, sqrt(kg m^2) rad/s
    """

    time: Array
    filter_floor: Array
    angle_bound: Array
    rate_bound: Array

    def arrays(self, key: str) -> dict[str, Array]:
        """The arrays under names of the record."""
        return {f"{key}.{name}": value for name, value in vars(self).items()}

    def roles(self, key: str) -> dict[str, Any]:
        """Which array is which."""
        return {name: f"{key}.{name}" for name in vars(self)}


def certified_curves(floor: FilterLowerBound, horizon: float) -> CertifiedCurves | None:
    """Put a certified floor's bounds on a grid; None if the certificate ends before the horizon."""
    if floor.horizon is not None and float(floor.horizon) < horizon:
        return None
    edges = np.linspace(0.0, horizon, CELLS + 1)
    floors, gaps, rates = np.full(CELLS, np.inf), np.zeros(CELLS), np.zeros(CELLS)
    period = float(floor.schedule.period) if floor.schedule.period is not None else 0.0
    for flowpipe in floor.flowpipes:
        for box, shift in _boxes(flowpipe, period, horizon):
            first = int(np.searchsorted(edges, box.start + shift, side="right")) - 1
            last = int(np.searchsorted(edges, box.stop + shift, side="left"))
            cells = slice(max(first, 0), min(last, CELLS))
            floors[cells] = np.minimum(floors[cells], box.filter_low)
            gaps[cells] = np.maximum(gaps[cells], box.cosine_gap)
            rates[cells] = np.maximum(rates[cells], box.weighted_rate)
    if not np.all(np.isfinite(floors)):
        return None
    angle = 2 * np.arccos(np.clip(1 - gaps * OUTWARD, -1, 1)) * OUTWARD
    return CertifiedCurves(edges[:-1], floors, np.minimum(angle, 2 * np.pi), rates)


def _boxes(flowpipe: Flowpipe, period: float, horizon: float) -> list[tuple[Box, float]]:
    """Boxes of the transient, and those of the tail in every later period up to the horizon."""
    found = [(box, 0.0) for box in flowpipe.boxes]
    if flowpipe.tail is not None and period > 0:
        cycles = int(max(horizon - float(flowpipe.tail.start), 0.0) / period) + 1
        found += [(box, n * period) for n in range(cycles) for box in flowpipe.tail_boxes]
    return found
