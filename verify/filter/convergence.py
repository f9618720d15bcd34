"""Convergence of attitude and rate, for every start in an initial set and any lambda > 0.

Both laws contract |Omega|_J by exp(-m/2), m = integral of g^2 kappa (1 + b0), and the attitude
follows in cascade. Certified flowpipes with a repeating tail carry this out: over every period
after the tail's start s = sqrt(1 - b0) and |Omega|_J shrink by a proved ratio. For the
persistence filter the closed form of the same argument is

    sqrt(1 - b0(t)) <= sqrt(R(0)/R_min) exp(-lambda t/2) (s0 + c t y0),   c = 1/sqrt(8 Jmin).
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import ceil, inf, log, nextafter
from typing import final

import numpy as np

from ...models.schedule import Schedule
from ..exact.ball import sqrt_below
from .boxes import OUTWARD, Box, greatest_bv
from .certify import FilterLowerBound
from .flowpipe import Flowpipe
from .over_time import angle_above


@final
@dataclass(frozen=True)
class Reach:
    """Bounds of |bv| and |w| on one box, and its place in time.

    `scale` is the ratio per period by which both shrink if the box belongs to a tail, else None.
    """

    start: float
    stop: float
    attitude: float
    rate: float
    scale: float | None


@final
@dataclass(frozen=True)
class Convergence:
    """What a certified floor says of convergence.

    Attributes
    ----------
    converges : every trajectory's attitude error and rate go to zero
    ratio : ratio by which s and |Omega|_J shrink over each period of the slowest tail
    envelope_start : time from which that holds, s
    settling : proved time after which |bv| and |w| stay within the tolerances, s, or None
    largest_angle : bound of 2 acos(b0), rad
    largest_rate : bound of |w|, rad/s
    """

    converges: bool
    ratio: float
    envelope_start: Fraction
    settling: float | None
    largest_angle: float
    largest_rate: float


def analyse_convergence(floor: FilterLowerBound, *, attitude: float, rate: float) -> Convergence:
    """Draw the consequences of a floor for attitude and rate.

    Parameters
    ----------
    floor : FilterLowerBound
        A certified floor with its flowpipes.
    attitude, rate : float
        Tolerances on |bv| and on |w|, rad/s.
    """
    reaches = [list(_reaches(floor, w)) for w in floor.flowpipes]
    gaps = max(b.cosine_gap for w in floor.flowpipes for b in (*w.boxes, *w.tail_boxes))
    tails = [w.tail for w in floor.flowpipes]
    complete = [t for t in tails if t is not None]
    converges = len(complete) == len(tails)
    times = [_settled(r, floor.schedule, floor.horizon, attitude, rate) for r in reaches]
    return Convergence(
        converges=converges,
        ratio=max((max(t.ratios.values(), default=0.0) for t in complete), default=1.0),
        envelope_start=max((t.start for t in complete), default=Fraction(0)),
        settling=None if any(t is None for t in times) else max(t for t in times if t is not None),
        largest_angle=angle_above(gaps),
        largest_rate=max(r.rate for row in reaches for r in row),
    )


def settling(flowpipe: Flowpipe, floor: FilterLowerBound, *, attitude: float, rate: float) -> float:
    """Time after which one bin of a floor for all time is within the tolerances, s; inf where unknown."""
    found = _settled(list(_reaches(floor, flowpipe)), floor.schedule, None, attitude, rate)
    return inf if found is None or flowpipe.tail is None else found


def _reaches(floor: FilterLowerBound, flowpipe: Flowpipe) -> Iterator[Reach]:
    root = sqrt_below(floor.bounds.least)
    scale = max(flowpipe.tail.ratios.values(), default=0.0) if flowpipe.tail is not None else None
    for box in flowpipe.boxes:
        yield _reach(box, root, None)
    for box in flowpipe.tail_boxes:
        yield _reach(box, root, scale)


def _reach(box: Box, root: float, scale: float | None) -> Reach:
    # sqrt(2 S) >= |bv| shrinks in proportion to s; sqrt(S (2 - S)) is sharper for a single box
    if scale is None:
        n = float(greatest_bv(np.array(box.cosine_gap)))
    else:
        n = float(np.sqrt(2 * box.cosine_gap)) * OUTWARD
    rate = (box.weighted_rate / root + 2 * box.gain_max**2 * box.gain_high * n) * OUTWARD
    return Reach(box.start, box.stop, n, rate, scale)


def _settled(
    reaches: list[Reach], schedule: Schedule, horizon: Fraction | None, attitude: float, rate: float
) -> float | None:
    """Time after which every box is within the tolerances; None if the covered time ends outside."""
    period = float(schedule.period) if schedule.period is not None else inf
    last = 0.0
    for reach in reaches:
        excess = max(reach.attitude / attitude, reach.rate / rate) * OUTWARD
        if excess <= 1:
            continue
        if reach.scale is None:
            last = max(last, reach.stop)
        elif reach.scale > 0:
            periods = ceil(log(excess) / -log(reach.scale) * OUTWARD + 1e-9)
            last = max(last, reach.stop + (periods - 1) * period)
        else:
            last = max(last, reach.stop)
    if horizon is not None and last >= float(horizon) * (1 - 1e-12):
        return None
    return nextafter(last * OUTWARD, inf)
