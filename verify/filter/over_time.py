"""Certified bounds over time: what holds throughout each cell of a time grid, rounded outward.

A transient's boxes hold where they stand. A tail's boxes hold again in its n-th later period with
s <= theta^n s_box and |Omega|_J <= theta^n y_box, theta the ratio per period of the slowest of its
decaying components, and with the bounds of R and kappa as they are.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.types import Array
from ..exact.ball import ball, float_above, sqrt_below
from ..exact.rounding import rounded_up
from .boxes import OUTWARD, BoxColumns, greatest_bv
from .certify import FilterLowerBound
from .flowpipe import Flowpipe
from .torque_bound import torque_bounds

CELLS = 800
"""Cells of the grid from 0 to the horizon."""
TIME_ROUNDING = 1e-15
"""Relative allowance for the rounding of a box's edge, a period's start and their sum (3 x 1.2e-16)."""


@final
@dataclass(frozen=True)
class BoundsOverTime:
    """Bounds that hold at every t of a cell, for every start of the initial set.

    Cell i reaches from `time[i]` to `time[i + 1]`, the last one to the horizon; both ends belong to it.

    Attributes
    ----------
    time : (n,) starts of the cells, s
    filter_floor : (n,) lower bound of R, s; inf for a law without filter
    angle_bound : (n,) upper bound of the error angle 2 acos(b0), rad
    rate_bound : (n,) upper bound of |Omega|_J = sqrt(Omega' J Omega), kg^1/2 m rad/s
    speed_bound : (n,) upper bound of |w|, rad/s
    torque_bound : (n,) upper bound of |g u|, Euclidean, N m; like that of |w| infinite where none is known
    """

    time: Array
    filter_floor: Array
    angle_bound: Array
    rate_bound: Array
    speed_bound: Array
    torque_bound: Array


def bounds_over_time(floor: FilterLowerBound, horizon: Fraction, cells: int = CELLS) -> BoundsOverTime | None:
    """Put a certified floor's bounds on a grid from 0 to `horizon`, s; None if they end before it."""
    if floor.horizon is not None and floor.horizon < horizon:
        return None
    edges = np.linspace(0.0, float(horizon), cells + 1)
    edges[-1] = rounded_up(horizon)
    least = np.full(cells, np.inf)
    gaps, rates, speeds, torques = np.zeros((4, cells))
    covered = np.zeros(cells, dtype=bool)
    root = sqrt_below(floor.bounds.least)
    for flowpipe in floor.flowpipes:
        for boxes in _unrolled(flowpipe, floor.schedule.period, horizon, cells):
            box, cell = _cells(edges, boxes)
            speed = _speeds(boxes, root)
            applied, _ = torque_bounds(floor.system, floor.bounds, boxes)
            covered[cell] = True
            np.minimum.at(least, cell, boxes.low_filter[box])
            for held, values in ((gaps, boxes.S), (rates, boxes.y), (speeds, speed), (torques, applied)):
                np.maximum.at(held, cell, values[box])
    if not np.all(covered):
        return None
    angles = np.array([angle_above(gap) for gap in gaps.tolist()])
    return BoundsOverTime(edges[:-1], least, angles, rates, speeds, torques)


def _speeds(boxes: BoxColumns, root: float) -> Array:
    """Bound of |w| <= |Omega| + 2 g^2 kappa |bv| on each box, rad/s; `root` is at most sqrt(Jmin)."""
    with np.errstate(over="ignore", invalid="ignore"):  # a gain beyond numbers: infinite, or 0 where g is
        push = np.where(boxes.g > 0, 2 * boxes.g**2 * boxes.high * greatest_bv(boxes.S), 0.0)
        speeds: Array = (boxes.y / root + np.where(np.isnan(push), np.inf, push)) * OUTWARD
    return speeds


def angle_above(gap: float) -> float:
    """Bound of the error angle 2 acos(b0) = 4 asin(sqrt((1 - b0)/2)), rad, for 1 - b0 <= gap."""
    half = ball(min(gap, 2.0)) / 2
    return float_above(2 * ball(1).atan() * 4 if gap >= 2 else 4 * half.sqrt().asin())


def _unrolled(
    flowpipe: Flowpipe, period: Fraction | None, horizon: Fraction, cells: int
) -> Iterator[BoxColumns]:
    """Boxes of the transient, then those of the tail in later periods up to the horizon, scaled down."""
    if flowpipe.boxes:
        yield BoxColumns.of(flowpipe.boxes)
    if flowpipe.tail is None or period is None:
        return
    first, ratio = BoxColumns.of(flowpipe.tail_boxes), max(flowpipe.tail.ratios.values(), default=0.0)
    for n in _periods(flowpipe.tail.start, period, horizon, cells):
        yield first.later(float(n * period), float_above(ball(ratio) ** n))


def _periods(start: Fraction, period: Fraction, horizon: Fraction, cells: int) -> Iterable[int]:
    """Periods of a tail whose boxes decide a cell: of many in one cell only the first two, as none grows."""
    last = (horizon - start) // period
    if last <= 4 * cells:
        return range(last + 1)
    firsts = {(horizon * i / cells - start) // period for i in range(cells)}
    near = {n + k for n in {*firsts, 0} for k in (-1, 0, 1, 2)}  # one more each side: edges are rounded
    return sorted(n for n in near if 0 <= n <= last)


def _cells(edges: Array, boxes: BoxColumns) -> tuple[np.ndarray, np.ndarray]:
    """Pairs (box, cell) that have an instant in common, as two arrays of indices."""
    count = len(edges) - 1
    first = np.searchsorted(edges, boxes.start * (1 - TIME_ROUNDING), side="left") - 1
    last = np.searchsorted(edges, boxes.stop * (1 + TIME_ROUNDING), side="right")
    first, last = np.clip(first, 0, count), np.clip(last, 0, count)
    lengths = np.maximum(last - first, 0)
    box = np.repeat(np.arange(len(first)), lengths)
    offset = np.arange(len(box)) - np.repeat(np.cumsum(lengths) - lengths, lengths)
    return box, first[box] + offset
