"""The file's clock: instants as seconds, or as ISO 8601 times counted from `schedule.epoch`.

ISO times are read by Python's `datetime`, fractions of a second exactly. Differences are in civil
seconds of UTC: 86400 a day, so that a leap second between two times is not counted.
"""

from __future__ import annotations

import re
from collections.abc import Callable
from dataclasses import dataclass, replace
from datetime import UTC, date, datetime, timedelta
from fractions import Fraction
from typing import Any, final

from .document import Document
from .errors import ScenarioError, quote
from .exact import exact

_ISO = re.compile(
    r"(?P<day>\d{4}-\d{2}-\d{2}|\d{4}-\d{3})[T ](?P<clock>\d{2}:\d{2}(?::\d{2})?)"
    r"(?:[.,](?P<part>\d{1,30}))?\s*(?P<zone>Z|UTC|[+-]\d{2}(?::?\d{2})?)?",
    re.ASCII | re.IGNORECASE,
)
_LOOKS_LIKE_A_DATE = re.compile(r"\d{4}-\d{2}|\d{4}-\d{3}T|\d{2}:\d{2}")
_YEAR_0 = datetime(1970, 1, 1)
EXAMPLE = "2026-03-30T21:59:34Z"


@final
@dataclass(frozen=True)
class Moment:
    """An ISO 8601 time.

    Attributes
    ----------
    seconds : civil seconds of UTC since 1970-01-01T00:00:00Z, exact
    zoned : whether it named its zone; without one it is read as UTC
    """

    seconds: Fraction
    zoned: bool

    def __str__(self) -> str:
        return utc_text(self.seconds)


def moment(value: object) -> Moment | None:
    """Read an ISO 8601 date and time (a text, or TOML's own); None for anything that is no date at all.

    Raises
    ------
    ValueError
        For a date that does not exist or lacks its time of day, and for a leap second.
    """
    text = value.isoformat() if isinstance(value, (datetime, date)) else value
    if not isinstance(text, str) or not _LOOKS_LIKE_A_DATE.match(text.strip()):
        return None
    found = _ISO.fullmatch(text.strip())
    if found is None:
        raise ValueError(f"expected a date with its time of day, as {EXAMPLE}, received {quote(text)}")
    if found["clock"].endswith(":60"):
        raise ValueError(f"leap seconds are not counted, received {quote(text)}: write the second after it")
    try:
        day = _day(found["day"])
        at = datetime.fromisoformat(f"{day.isoformat()}T{found['clock']}")
        shift = _zone(found["zone"] or "Z")
    except ValueError as error:
        raise ValueError(f"{quote(text)} is no time: {error}") from None
    part = found["part"] or "0"
    whole = (at - _YEAR_0) // timedelta(seconds=1)
    return Moment(whole - shift + Fraction(int(part), 10 ** len(part)), found["zone"] is not None)


def _day(text: str) -> date:
    if len(text) == len("2026-089"):
        year, number = int(text[:4]), int(text[5:])
        day = date(year, 1, 1) + timedelta(days=number - 1)
        if number < 1 or day.year != year:
            raise ValueError(f"{year} has no day {number}")
        return day
    return date.fromisoformat(text)


def _zone(text: str) -> int:
    """Seconds by which a zone is ahead of UTC."""
    if text.upper() in ("Z", "UTC"):
        return 0
    hours, minutes = int(text[1:3]), int(text[3:].lstrip(":") or 0)
    if hours > 14 or minutes > 59:
        raise ValueError(f"there is no zone {text}")
    return (hours * 3600 + minutes * 60) * (-1 if text[0] == "-" else 1)


def utc_text(seconds: Fraction) -> str:
    """Return an instant in UTC, to the nanosecond where it has a fraction."""
    whole = seconds.numerator // seconds.denominator
    try:
        at = datetime.fromtimestamp(0, UTC) + timedelta(seconds=whole)
    except OverflowError:
        return f"{float(seconds):.10g} s after 1970-01-01T00:00:00Z"
    part = f"{float(seconds - whole):.9f}"[1:].rstrip("0").rstrip(".") if seconds != whole else ""
    return f"{at:%Y-%m-%dT%H:%M:%S}{part}Z"


@final
@dataclass(frozen=True)
class FileClock:
    """What the times of a file count from, and when its run starts.

    Attributes
    ----------
    epoch : civil seconds of UTC from 1970 to 0 s of the file; None if the file names no date
    start : start of the run on the file's clock, s
    start_is_given : whether the file says so itself (`initial.time`)
    """

    epoch: Fraction | None = None
    start: Fraction = Fraction(0)
    start_is_given: bool = False

    def seconds(self, at: Moment) -> Fraction:
        """Seconds of an ISO time on the file's clock.

        Raises
        ------
        ValueError
            If the file names no epoch.
        """
        if self.epoch is None:
            raise ValueError(
                f"{at} is a date: give schedule.epoch, the date that counts as 0 s "
                f'(schedule.epoch = "{at}" for this one)'
            )
        return at.seconds - self.epoch

    @property
    def words(self) -> str:
        """What the printed times count from; empty where that is 0 s of a file without dates."""
        if not self.start and self.epoch is None:
            return ""
        at = "" if self.epoch is None else utc_text(self.epoch + self.start)
        if not self.start_is_given:
            return f"Times count from {at} (schedule.epoch), in civil seconds of UTC."
        date = f"{at}, in civil seconds of UTC" if at else ""
        value = f"{number_text(self.start)} s" + (f" ({date})" if date else "")
        return f"Times count from the start of the run, initial.time = {value}."


def number_text(value: Fraction) -> str:
    """Return seconds in full where they are a short decimal, else to 15 digits."""
    return str(value.numerator) if value.denominator == 1 else f"{float(value):.15g}"


def read_clock(document: Document) -> tuple[Document, FileClock, tuple[str, ...]]:
    """Read the file's clock, and return the document with every instant in seconds of it; and warnings.

    Raises
    ------
    ScenarioError
        Naming the key: an epoch that is no date, a date without an epoch, a date that does not exist.
    """
    unzoned: list[str] = []

    def dated(key: str, value: object) -> Moment | None:
        try:
            found = moment(value)
        except ValueError as error:
            raise ScenarioError(document.where(key), str(error)) from None
        if found is not None and not found.zoned:
            unzoned.append(key)
        return found

    schedule, start = _table(document, "schedule"), _table(document, "initial").get("time")
    epoch = None
    if (given := schedule.get("epoch")) is not None:
        epoch = dated("schedule.epoch", given)
        if epoch is None:
            raise ScenarioError(
                document.where("schedule.epoch"),
                f"expected the date that counts as 0 s, as {EXAMPLE}, received {quote(given)}: where times "
                "are large numbers of seconds, give initial.time, when the run starts",
            )
    begins = dated("initial.time", start)
    if epoch is None:
        epoch = begins
    clock = FileClock(None if epoch is None else epoch.seconds, start_is_given=start is not None)

    def seconds(key: str, value: object) -> object:
        at = dated(key, value)
        if at is None:
            return value
        try:
            return clock.seconds(at)
        except ValueError as error:
            raise ScenarioError(document.where(key), str(error)) from None

    tables = _with_seconds(document, seconds)
    if given is not None and epoch is not None:
        tables["schedule"] = {**tables["schedule"], "epoch": str(epoch)}
    if start is not None:
        try:
            clock = replace(clock, start=exact(tables["initial"]["time"]))
        except ValueError as error:
            raise ScenarioError(document.where("initial.time"), str(error)) from None
    warnings = (f"{document.where(unzoned[0])}: {READ_AS_UTC}",) if unzoned else ()
    return replace(document, tables=tables), clock, warnings


READ_AS_UTC = "times without a zone are read as UTC; differences are in civil seconds (no leap seconds)"


def _table(document: Document, name: str) -> dict[str, Any]:
    found = document.tables.get(name)
    return found if isinstance(found, dict) else {}


def _with_seconds(document: Document, seconds: Callable[[str, object], object]) -> dict[str, Any]:
    """Return the tables with the dates of every key that is an instant in seconds."""
    tables = dict(document.tables)
    for name, key in (
        ("schedule", "on"),
        ("initial", "time"),
        ("simulation", "horizon"),
        ("optimum", "final_time"),
    ):
        if key in _table(document, name):
            value = tables[name][key]
            tables[name] = {**tables[name], key: seconds(f"{name}.{key}", value)}
    windows = _table(document, "schedule").get("windows")
    if isinstance(windows, list):
        tables["schedule"] = {
            **tables["schedule"],
            "windows": [
                [seconds(f"schedule.windows[{i}]", edge) for edge in pair] if isinstance(pair, list) else pair
                for i, pair in enumerate(windows, start=1)
            ],
        }
    return tables
