"""From [schedule.thrust] to a schedule: samples read, normalised, interpolated."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise
from pathlib import Path

from ..models.schedule import Schedule
from ..models.schedule.measured import measured_schedule, normalised
from .csv_tables import Column, read_rows
from .document import Document
from .errors import ScenarioError
from .instants import READ_AS_UTC, FileClock, number_text
from .schema import ScheduleTable, ThrustTable
from .units import THRUST, TIME

SAMPLE_COLUMNS = (
    (
        Column(("time", "t", "timestamp"), TIME, dated=True),
        Column(("thrust", "force", "f", "torque", "value"), THRUST),
    ),
)
"""What a CSV of measured thrust holds."""


def build(
    table: ScheduleTable, thrust: ThrustTable, document: Document, clock: FileClock
) -> tuple[Schedule, Fraction, tuple[str, ...]]:
    """Build the schedule of measured thrust; the instant from which its time counts, s; and warnings.

    Raises
    ------
    ScenarioError
        Naming the key or the line of the CSV file.
    """
    key = document.where("schedule.thrust.csv")
    path = document.origin("schedule").parent / thrust.csv
    table_read = read_rows(path, key, SAMPLE_COLUMNS, clock)
    rows = table_read.rows
    begins = min(rows[0].first, clock.start) if clock.start_is_given else clock.start
    if rows[0].first < begins:
        at = f"{key}: {path.name} line {rows[0].line}"
        raise ScenarioError(
            at, f"time {float(rows[0].first):g} s: times start at 0 s (or at initial.time, if it is given)"
        )
    for before, row in pairwise(rows):
        if row.first <= before.first:
            raise ScenarioError(
                f"{key}: {path.name} line {row.line}",
                f"time {number_text(row.first)} s does not come after {number_text(before.first)} s "
                "in the row above it",
            )
    if table.period is not None and rows[-1].first > begins + table.period:
        raise ScenarioError(
            f"{key}: {path.name} line {rows[-1].line}",
            f"time {number_text(rows[-1].first)} s comes after the period ends "
            f"({number_text(begins + table.period)} s)",
        )
    try:
        samples = normalised(
            [row.first - begins for row in rows],
            [row.second for row in rows],
            zero_below=thrust.zero_below,
            full_thrust=thrust.full_thrust,
        )
        schedule = measured_schedule(
            samples,
            period=table.period,
            thruster_rise=table.thruster_rise,
            thruster_fall=table.thruster_fall,
        )
    except ScenarioError:
        raise
    except ValueError as error:
        raise ScenarioError(f"{key}: {path.name}", str(error)) from None
    return schedule, begins, (f"{key}: {path.name}: {READ_AS_UTC}",) if table_read.unzoned else ()


def described(thrust: ThrustTable) -> str:
    """Return the record, its normalisation and its threshold in words."""
    full = "the largest sample" if thrust.full_thrust is None else f"{float(thrust.full_thrust):g}"
    below = f"{float(thrust.zero_below):g}"
    return f"thrust samples {Path(thrust.csv).name}: g = thrust / {full}, 0 where that is below {below}"
