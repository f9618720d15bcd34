"""From the [schedule] table to an exact `Schedule`."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ..models.apart import apart
from ..models.schedule import Hermite, Ramps, Schedule, Shape, Window, build_schedule, starting_at
from . import thrust
from .csv_tables import Column, read_rows
from .document import Document
from .errors import ScenarioError
from .instants import READ_AS_UTC, FileClock, number_text
from .schema import ScheduleTable
from .units import TIME

MAX_COUNT = 200_000
"""Windows that `count` may ask for."""
_OPENS = Column(
    ("on", "start", "begin", "begins", "open", "opens", "opening", "from", "tstart"), TIME, dated=True
)
_CLOSES = Column(
    ("off", "stop", "end", "ends", "finish", "close", "closes", "closing", "to", "tstop", "tend"),
    TIME,
    dated=True,
)
_LASTS = Column(("duration", "length", "width", "on_time"), TIME)
_ON_TIMES = Column(("on_time",), TIME, dated=True, doubtful=True)
_OFF_TIMES = Column(("off_time",), TIME, dated=True, doubtful=True)
WINDOW_COLUMNS = ((_OPENS, _CLOSES), (_OPENS, _LASTS), (_ON_TIMES, _OFF_TIMES))
"""What a CSV of windows may hold: when each opens, and when it closes or how long it lasts."""
Locate = Callable[[int], str]
"""From the position of a window (from 0) to the words by which messages name it."""


@final
@dataclass(frozen=True)
class ScheduleChoice:
    """The schedule of a scenario and what was asked for.

    Attributes
    ----------
    shape : "hermite", "hermite-as-printed", "ramps" or "measured"
        "hermite-as-printed" lets g act until `thruster_fall` after `off` (erratum E9).
    source : str
        Where the windows come from, in words.
    warnings : tuple of str
        What was mended in it, in words.
    """

    schedule: Schedule
    shape: str
    source: str
    warnings: tuple[str, ...] = ()

    @property
    def overruns_as_printed(self) -> bool:
        """Whether g is meant to overrun `off` as the paper prints it."""
        return self.shape == "hermite-as-printed"


def build(table: ScheduleTable, document: Document, clock: FileClock) -> ScheduleChoice:
    """Build the schedule of a scenario, in time counted from the start of the run.

    Raises
    ------
    ScenarioError
        Naming the key, window or CSV line.
    """
    forms = {
        "windows": table.windows is not None,
        "csv": table.csv is not None,
        "on_time": table.on_time is not None,
        "thrust": table.thrust is not None,
    }
    given = [name for name, present in forms.items() if present]
    if len(given) != 1:
        found = " and ".join(given) if given else "none of them"
        raise ScenarioError(
            document.where("schedule"),
            f"expected exactly one of windows, csv, on_time (with period), thrust; received {found}",
        )
    _refuse_stray_keys(table, given[0], document)
    if table.thrust is not None:
        schedule, first, warnings = thrust.build(table, table.thrust, document, clock)
        source = thrust.described(table.thrust)
        schedule, left_out = _from_start(schedule, first, document, clock)
        return ScheduleChoice(schedule, "measured", source, (*warnings, *left_out))
    windows, locate, source, warnings = _windows(table, document, clock)
    period = table.period if table.count is None else None
    windows, mended = _without_noise(windows, locate)
    _check_order(windows, period, locate, clock)
    name = table.shape or "hermite"
    first = min(windows[0].on, clock.start) if clock.start_is_given else clock.start
    try:
        schedule = build_schedule(
            [Window(w.on - first, w.off - first) for w in windows],
            _shape(name, table, document),
            period=period,
            thruster_rise=table.thruster_rise,
            thruster_fall=table.thruster_fall,
        )
    except ScenarioError:
        raise
    except ValueError as error:
        raise ScenarioError(document.where("schedule"), str(error)) from None
    schedule, left_out = _from_start(schedule, first, document, clock)
    return ScheduleChoice(schedule, name, source, (*warnings, *mended, *left_out))


def _from_start(
    schedule: Schedule, first: Fraction, document: Document, clock: FileClock
) -> tuple[Schedule, tuple[str, ...]]:
    """Count the time of a schedule that counts from `first`, s on the file's clock, from the run's start."""
    where = document.where("initial.time")
    if clock.start > first:
        try:
            later = starting_at(schedule, clock.start - first)
        except ValueError:
            at = number_text(clock.start)
            inside = schedule.period is not None or clock.start - first < schedule.end
            why = "a window is open (or g acts) then" if inside else "every window has closed by then"
            raise ScenarioError(
                where, f"the run cannot start at {at} s: {why}; give a start between two windows"
            ) from None
        gone = len(schedule.windows) - len(later.windows)
        words = (
            (f"{where}: {gone} window{'s' if gone > 1 else ''} before the start left out",) if gone else ()
        )
        return later, words
    lead, span = schedule.windows[0].on, schedule.windows[-1].off - schedule.windows[0].on
    if schedule.idle_lead:
        opens = number_text(clock.start + lead)
        return schedule, (
            f"{where}: the first window opens {float(lead):.6g} s after the run starts "
            f"({number_text(clock.start)} s), longer than all windows take ({float(span):.6g} s): "
            f"give initial.time = {opens} to start with it",
        )
    return schedule, ()


def _refuse_stray_keys(table: ScheduleTable, form: str, document: Document) -> None:
    stray = {
        "on": table.on is not None and form != "on_time",
        "count": table.count is not None and form != "on_time",
        "shape": table.shape is not None and form == "thrust",
        "ramp_up": table.ramp_up is not None and table.shape != "ramps",
        "ramp_down": table.ramp_down is not None and table.shape != "ramps",
    }
    for key, present in stray.items():
        if present:
            owner = "shape = 'ramps'" if key.startswith("ramp") else "on_time and period"
            reason = "thrust samples have their own shape" if key == "shape" else f"belongs to {owner}"
            raise ScenarioError(document.where(f"schedule.{key}"), f"{reason}: remove it")


def _windows(
    table: ScheduleTable, document: Document, clock: FileClock
) -> tuple[list[Window], Locate, str, tuple[str, ...]]:
    """Windows on the file's clock, how messages name each, the source in words, and warnings."""
    if table.windows is not None:
        key = document.where("schedule.windows")
        if not table.windows:
            raise ScenarioError(key, "is empty: give at least one [on, off] pair")
        windows = [Window(on, off) for on, off in table.windows]
        return windows, lambda i: f"{key}[{i + 1}]", f"table of {len(windows)} windows", ()
    if table.csv is not None:
        key = document.where("schedule.csv")
        path = document.origin("schedule").parent / table.csv
        table_read = read_rows(path, key, WINDOW_COLUMNS, clock)
        rows, by_length = table_read.rows, table_read.form == 1
        lines = [row.line for row in rows]
        windows = [Window(row.first, row.second + (row.first if by_length else 0)) for row in rows]
        told = (READ_AS_UTC,) if table_read.unzoned else ()
        if table_read.doubtful:
            told = (
                *told,
                "its times on and off are read as instants (as durations they would not be in order)",
            )
        source = f"{path.name}, {len(rows)} windows"
        return (
            windows,
            lambda i: f"{key}: {path.name} line {lines[i]}",
            source,
            tuple(f"{key}: {path.name}: {words}" for words in told),
        )
    key = document.where("schedule.on_time")
    if table.period is None:
        raise ScenarioError(document.where("schedule.period"), "required with on_time, but missing")
    on, on_time, period = table.on or Fraction(0), table.on_time or Fraction(0), table.period
    count = table.count or 1
    if table.count is not None and count > MAX_COUNT:
        raise ScenarioError(
            document.where("schedule.count"), f"must be at most {MAX_COUNT}, received {count}"
        )
    if (on if on < period and not clock.start_is_given else 0) + on_time > period:
        end, most = apart(on + on_time, period)
        raise ScenarioError(
            key, f"{'on + on_time' if on else 'on_time'} = {end} s goes beyond the period of {most} s"
        )
    windows = [Window(k * period + on, k * period + on + on_time) for k in range(count)]
    many = "endless" if table.count is None else f"{count} windows"
    return windows, lambda _: key, f"period {float(period):g} s, on {float(on_time):g} s, {many}", ()


NOISE = Fraction(1, 10**9)
"""Gaps and overlaps below this share of the shorter window beside them are taken for rounding."""


def _without_noise(windows: list[Window], locate: Locate) -> tuple[list[Window], tuple[str, ...]]:
    """Let windows touch that are apart, or overlap, by less than any thruster could tell; and say so.

    The edges 0.3 and 0.30000000000000004 are one instant, written by two sums of floats.
    """
    mended, places = windows[:1], []
    for i, window in enumerate(windows[1:], start=1):
        before = mended[-1]
        shorter = min(before.length, window.length)
        if before.off != window.on and abs(window.on - before.off) < NOISE * shorter:
            window = Window(before.off, window.off)
            places.append(i)
        mended.append(window)
    if not places:
        return windows, ()
    many = f" (and {len(places) - 1} more)" if len(places) > 1 else ""
    return mended, (
        f"{locate(places[0])}{many}: opens within rounding of the close of the window before it: "
        "taken as the same instant",
    )


def _check_order(
    windows: Sequence[Window], period: Fraction | None, locate: Locate, clock: FileClock
) -> None:
    """Refuse windows that are empty, disordered or overlapping, naming key or CSV line."""
    for i, window in enumerate(windows):
        if window.on < clock.start and not clock.start_is_given:
            raise ScenarioError(
                locate(i),
                f"opens at {float(window.on):g} s: times start at 0 s (or at initial.time, if it is given)",
            )
        if window.off <= window.on:
            off, on = apart(window.off, window.on)
            order = f"closes ({off} s) before it opens ({on} s)"
            if window.off == window.on:
                order = f"is empty: it opens and closes at {on} s"
            raise ScenarioError(locate(i), order)
        if i and window.on < windows[i - 1].off:
            on, off = apart(window.on, windows[i - 1].off)
            raise ScenarioError(
                locate(i),
                f"opens ({on} s) before the window above it closes ({off} s): windows must be in order and "
                "not overlap",
            )
        begins = min(clock.start, windows[0].on)
        if period is not None and window.off > begins + period:
            late = window.on >= begins + period
            first = ": the first period begins with the run (give initial.time)" if late else ""
            off, end = apart(window.off, begins + period)
            raise ScenarioError(locate(i), f"closes ({off} s) after the period ends ({end} s){first}")


def _shape(name: str, table: ScheduleTable, document: Document) -> Shape:
    if name == "ramps":
        for key, value in (("ramp_up", table.ramp_up), ("ramp_down", table.ramp_down)):
            if value is None:
                raise ScenarioError(
                    document.where(f"schedule.{key}"), "required with shape = 'ramps', but missing"
                )
        return Ramps(table.ramp_up or Fraction(0), table.ramp_down or Fraction(0))
    if name == "hermite-as-printed":
        if table.thruster_fall == 0:
            raise ScenarioError(
                document.where("schedule.thruster_fall"),
                "required with shape = 'hermite-as-printed' (g overruns off by it), but missing",
            )
        return Hermite(table.thruster_fall)
    return Hermite()
