"""Runs on which g is zero: how long they are, and how many windows may be missed before one is too long."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from ...models.schedule import Clock, Schedule, Window

Spans = list[tuple[int, int]]
"""Intervals in ticks, in order of time."""


def longest_zero_run(schedule: Schedule) -> Window | None:
    """Longest interval on which g is zero, or None.

    Of a finite table what follows it is left out; across the end of a period a run goes on.
    """
    clock, supports = _supports(schedule)
    runs = _gaps(schedule, clock, supports)
    longest = max(runs, key=lambda run: run[1] - run[0], default=None)
    return None if longest is None else Window(clock.time(longest[0]), clock.time(longest[1]))


def default_length(schedule: Schedule) -> Fraction:
    """Longest zero run plus longest run of thrust, s: for one window a period, the period."""
    clock, supports = _supports(schedule)
    runs = _gaps(schedule, clock, supports)
    if not runs or not supports:
        return schedule.end
    return clock.time(max(b - a for a, b in runs) + max(b - a for a, b in supports))


def missable_windows(schedule: Schedule, length: Fraction) -> int | None:
    """How many runs of thrust in a row may be missed while every interval of `length` still holds some.

    None if even without a miss some interval holds none. In a finite table at most as many as it has.
    """
    clock, supports = _supports(schedule, length)
    if not supports:
        return None
    on, off = [a for a, _ in supports], [b for _, b in supports]
    end, T, n = clock.ticks(schedule.end), clock.ticks(length), len(supports)

    def longest_gap(missed: int) -> int:
        """Longest run of zeros, in ticks, if any `missed` supports in a row are left out."""
        if schedule.is_periodic:
            cycles, shift = divmod(missed + 1, n)
            following = on[shift:] + [x + end for x in on[:shift]]
            return max(b - a for a, b in zip(off, following, strict=True)) + cycles * end
        return max(b - a for a, b in zip([0, *off], [*on, end][missed:], strict=False))

    most = n * (T // end + 1) if schedule.is_periodic else n
    low, high = -1, most + 1
    while high - low > 1:
        middle = (low + high) // 2
        if longest_gap(middle) < T:
            low = middle
        else:
            high = middle
    return low if low >= 0 else None


def _supports(schedule: Schedule, *instants: Fraction) -> tuple[Clock, Spans]:
    """Maximal intervals of [0, end] that no piece on which g is zero meets."""
    clock = Clock.for_instants(schedule.profile.knots, instants)
    ticks = [clock.ticks(knot) for knot in schedule.profile.knots]
    supports: Spans = []
    for i, shape in enumerate(schedule.profile.shapes):
        if not shape:
            continue
        if supports and supports[-1][1] == ticks[i]:
            supports[-1] = (supports[-1][0], ticks[i + 1])
        else:
            supports.append((ticks[i], ticks[i + 1]))
    return clock, supports


def _gaps(schedule: Schedule, clock: Clock, supports: Spans) -> Spans:
    """Intervals of positive length between the supports; the one across a period's end goes on beyond it."""
    end = clock.ticks(schedule.end)
    if not supports:
        return [(0, end)]
    gaps = [(before[1], after[0]) for before, after in pairwise(supports)]
    if schedule.is_periodic:
        gaps.append((supports[-1][1], supports[0][0] + end))
    else:
        gaps += [(0, supports[0][0]), (supports[-1][1], end)]
    return sorted((a, b) for a, b in gaps if a < b)
