"""What robust flowpipes say of angle and rate: largest values, settling, and the bound they end in."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from math import asin, ceil, inf, log, nextafter, sqrt
from typing import final

from ..filter.boxes import Box
from ..filter.flowpipe import Flowpipe
from .answer import RobustFloor
from .bodies import BodyBin

OUTWARD = 1 + 1e-12
"""Covers fewer than 1000 roundings (1.2e-16 each) of operations on numbers of one sign."""


@final
@dataclass(frozen=True)
class Ultimate:
    """Bounds that hold for good.

    Attributes
    ----------
    start : from this time on, s
    gap : bound of S = 1 - b0
    rate : bound of |w|, rad/s
    """

    start: float
    gap: float
    rate: float

    @property
    def angle(self) -> float:
        """Bound of the error angle 2 acos(b0), rad."""
        return angle_of(self.gap)


@final
@dataclass(frozen=True)
class Consequences:
    """What follows for every body and every start.

    Attributes
    ----------
    ratio : factor by which s and |x|_J shrink over each period, < 1; None where nothing decays
    ratio_from : time from which that holds, s
    ultimate : bounds for good where nothing decays, else None
    settling : time after which |bv| and |w| stay within the tolerances, s, or None
    largest_gap, largest_rate : bounds of S and |w| (rad/s) over the time covered
    """

    ratio: float | None
    ratio_from: Fraction
    ultimate: Ultimate | None
    settling: float | None
    largest_gap: float
    largest_rate: float


@final
@dataclass(frozen=True)
class _Moment:
    """One box: its end, S and |w|; `repeats` where it is of the repeating part.

    `attitude` and `shrinking` bound |bv| and |w|, where it repeats by what shrinks with s and |x|_J.
    """

    stop: float
    gap: float
    rate: float
    attitude: float
    shrinking: float
    repeats: bool


def angle_of(gap: float) -> float:
    """Bound of 2 acos(b0), rad, for 1 - b0 <= gap."""
    return 4 * asin(min(sqrt(gap / 2) * OUTWARD, 1.0)) * OUTWARD


def consequences(floor: RobustFloor) -> Consequences:
    """Draw the consequences of a robust floor."""
    q = floor.question
    moments = [(pipe, list(_moments(part, pipe))) for part, pipe in floor.parts]
    tails = [pipe.tail for _, pipe in floor.parts if pipe.tail is not None]
    decays = floor.repeats and all(tail.ratios for tail in tails)
    attitude, rate = float(q.mission.tolerance.attitude), float(q.mission.tolerance.rate)
    times = [_settled(rows, pipe, attitude, rate, floor) for pipe, rows in moments]
    later = [m for _, rows in moments for m in rows if m.repeats]
    ultimate = None
    if floor.repeats and not decays:
        start = max(float(tail.start) for tail in tails)
        ultimate = Ultimate(start, max(m.gap for m in later), max(m.rate for m in later))
    everything = [m for _, rows in moments for m in rows]
    return Consequences(
        ratio=max(r for tail in tails for r in tail.ratios.values()) if decays else None,
        ratio_from=max((tail.start for tail in tails), default=Fraction(0)),
        ultimate=ultimate,
        settling=None if any(t is None for t in times) else max(t for t in times if t is not None),
        largest_gap=min(max((m.gap for m in everything), default=2.0), 2.0),
        largest_rate=max((m.rate for m in everything), default=inf),
    )


def _moments(part: BodyBin, pipe: Flowpipe) -> Iterator[_Moment]:
    for box in pipe.boxes:
        yield _moment(part, box, repeats=False)
    for box in pipe.tail_boxes:
        yield _moment(part, box, repeats=True)


def _moment(part: BodyBin, box: Box, *, repeats: bool) -> _Moment:
    """|w| <= |x| + |F zeta|, zeta = 2 g^2 kappa bv.

    Where bounds shrink |bv| <= sqrt(2 S) shrinks with s; a bound of S above 2 counts there in full.
    """
    c, gap = part.constants, min(box.cosine_gap, 2.0)
    sharp = (sqrt(gap * (2 - gap)) if gap < 1 else 1.0) * OUTWARD
    wide = sqrt(2 * box.cosine_gap) * OUTWARD if repeats else sharp
    turn = float(1 + c.mismatch) * 2 * box.gain_max**2 * box.gain_high
    drift = box.weighted_rate * float(c.inverse_root)
    rates = [(drift + turn * n) * OUTWARD for n in (sharp, wide)]
    return _Moment(box.stop, gap, rates[0], wide, rates[1], repeats)


def _settled(
    moments: list[_Moment], pipe: Flowpipe, attitude: float, rate: float, floor: RobustFloor
) -> float | None:
    """Time after which every box is within the tolerances; None if the bounds end outside."""
    tail, period, last = pipe.tail, floor.question.mission.schedule.period, 0.0
    for m in moments:
        excess = max(m.attitude / attitude, m.shrinking / rate) * OUTWARD
        if excess <= 1:
            continue
        if not m.repeats:
            last = max(last, m.stop)
            continue
        assert tail is not None
        ratio = max(tail.ratios.values(), default=1.0)
        if ratio >= 1:
            return None
        periods = ceil(log(excess) / -log(ratio) * OUTWARD + 1e-9) if ratio > 0 else 1
        last = max(last, m.stop + (periods - 1) * float(period or 0))
    if floor.horizon is not None and last >= float(floor.horizon) * (1 - 1e-12):
        return None
    return nextafter(last * OUTWARD, inf)
