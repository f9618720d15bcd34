"""Variants of a schedule, exact: windows missed, edges shifted, gaps longer, periods written out."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Collection
from dataclasses import replace
from fractions import Fraction

from .piecewise import Piece, PiecewisePolynomial
from .polynomial import ZERO, Coefficients
from .profiles import contiguous
from .schedule import Schedule, Window


def unrolled(schedule: Schedule, cycles: int) -> Schedule:
    """Return the same periodic g, its period taken `cycles` times as long.

    Raises
    ------
    ValueError
        If the schedule is finite or `cycles` is not positive.
    """
    if schedule.period is None:
        raise ValueError("a finite table has no period to repeat")
    if cycles < 1:
        raise ValueError(f"expected at least one period, received {cycles}")
    shifts = [k * schedule.period for k in range(cycles)]
    knots = [Fraction(0)] + [knot + shift for shift in shifts for knot in schedule.profile.knots[1:]]
    return replace(
        schedule,
        windows=tuple(Window(w.on + s, w.off + s) for s in shifts for w in schedule.windows),
        profile=PiecewisePolynomial(tuple(knots), schedule.profile.shapes * cycles),
        period=schedule.period * cycles,
    )


def starting_at(schedule: Schedule, instant: Fraction) -> Schedule:
    """Return the schedule with its time counted from an instant at which g is zero; what was before is gone.

    A periodic schedule is turned: its windows are those that open from the instant on, within one period.

    Raises
    ------
    ValueError
        If the instant is negative or g acts there, or nothing is left.
    """
    if instant < 0:
        raise ValueError(f"a schedule starts at 0 s or later, received {float(instant):g} s")
    end, knots, shapes = schedule.end, schedule.profile.knots, schedule.profile.shapes
    place = instant if schedule.period is None else instant % end
    index = bisect_right(knots, place) - 1
    if place < end and place != knots[index] and shapes[index]:
        raise ValueError(f"g acts at {float(instant):g} s: a run cannot start there")
    for window in schedule.windows:
        if window.on < place < window.off:
            raise ValueError(f"the window [{float(window.on):g}, {float(window.off):g}] s is open there")
    windows = [Window(w.on - place, w.off - place) for w in schedule.windows if w.on >= place]
    later = [
        Piece(max(p.start, place) - place, p.end - place, p.shape)
        for p in schedule.profile.pieces
        if p.end > place
    ]
    if schedule.period is not None:
        turn = end - place
        later = [p for p in later if p.shape]
        later += [
            Piece(p.start + turn, p.end + turn, p.shape)
            for p in schedule.profile.pieces
            if p.shape and p.start < place
        ]
        windows += [Window(w.on + turn, w.off + turn) for w in schedule.windows if w.on < place]
    if not windows:
        raise ValueError(f"every window has closed before {float(instant):g} s")
    return replace(schedule, windows=tuple(windows), profile=contiguous(later, schedule.period))


def without_windows(schedule: Schedule, missed: Collection[int]) -> Schedule:
    """Return the schedule with some windows (counted from 0) never fired: neither listed nor acting.

    In a periodic schedule they are missed in every period; `unrolled` first makes it a rarer event.

    Raises
    ------
    ValueError
        If a number names no window, or none would be left.
    """
    count = len(schedule.windows)
    for number in missed:
        if not 0 <= number < count:
            raise ValueError(f"there is no window {number}: the schedule has {count}, counted from 0")
    if len(set(missed)) == count:
        raise ValueError("no window would be left")
    gone = set(missed)
    ons = [w.on for w in schedule.windows]
    shapes: list[Coefficients] = []
    for knot, shape in zip(schedule.profile.knots, schedule.profile.shapes, strict=False):
        owner = max(bisect_right(ons, knot) - 1, 0)
        shapes.append(ZERO if owner in gone else shape)
    return replace(
        schedule,
        windows=tuple(w for i, w in enumerate(schedule.windows) if i not in gone),
        profile=PiecewisePolynomial(schedule.profile.knots, tuple(shapes)),
    )


def missing_in_a_row(schedule: Schedule, count: int, *, cycles: int) -> Schedule:
    """Return the schedule with the first `count` windows out of every `cycles` periods missed."""
    return without_windows(unrolled(schedule, cycles), range(count))


def shifted_edges(
    schedule: Schedule, *, open_later: Fraction = Fraction(0), close_earlier: Fraction = Fraction(0)
) -> Schedule:
    """Return the schedule with every window's edges moved and g squeezed into it.

    g keeps its shape: within each window time is mapped linearly onto what is left of it.
    Negative values open earlier or close later.

    Raises
    ------
    ValueError
        If a window would vanish, or the moved windows or g would overlap.
    """
    windows: list[Window] = []
    pieces: list[Piece] = []
    ons = [w.on for w in schedule.windows]
    acting = [p for p in schedule.profile.pieces if p.shape]
    owners = [max(bisect_right(ons, p.start) - 1, 0) for p in acting]
    for window in schedule.windows:
        moved = Window(window.on + open_later, window.off - close_earlier)
        if moved.off <= moved.on:
            raise ValueError(f"the window at {float(window.on):g} s would vanish")
        if moved.on < 0:
            raise ValueError(f"the window at {float(window.on):g} s would open before 0 s")
        windows.append(moved)
    for piece, owner in zip(acting, owners, strict=True):
        old, new = schedule.windows[owner], windows[owner]
        ratio = new.length / old.length
        start, end = (new.on + (t - old.on) * ratio for t in (piece.start, piece.end))
        pieces.append(Piece(start, end, piece.shape))
    return replace(schedule, windows=tuple(windows), profile=contiguous(pieces, schedule.period))


def longer_gap(schedule: Schedule, at: Fraction, extra: Fraction) -> Schedule:
    """Return the schedule with `extra` s of g = 0 put in at an instant at which g is zero already.

    What comes later comes later by `extra`; a period grows by it.

    Parameters
    ----------
    schedule : Schedule
        What is changed; it stays as it is.
    at : Fraction
        A knot in [0, end] from which g is zero (or, at `end`, zero again at the next period's start).
    extra : Fraction
        Length put in, s, >= 0.

    Raises
    ------
    ValueError
        If extra < 0 or g acts at that instant.
    """
    profile = schedule.profile
    if extra < 0:
        raise ValueError(f"a gap can only grow, received {float(extra):g} s")
    if at not in profile.knots:
        raise ValueError(f"a gap grows at a knot of g, received {float(at):g} s")
    index = profile.knots.index(at)
    if index < len(profile.shapes) and profile.shapes[index]:
        raise ValueError(f"g acts from {float(at):g} s on: there is no gap to make longer")
    knots = tuple(k + extra if k > at else k for k in profile.knots)
    shapes = profile.shapes
    if index == len(shapes) and extra:
        knots, shapes = (*knots, at + extra), (*shapes, ZERO)
    return replace(
        schedule,
        windows=tuple(Window(w.on + extra, w.off + extra) if w.on >= at else w for w in schedule.windows),
        profile=PiecewisePolynomial(knots, shapes),
        period=None if schedule.period is None else schedule.period + extra,
    )
