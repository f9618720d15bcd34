"""From [schedule.thrust] to a schedule: samples read, normalised, interpolated."""

from __future__ import annotations

from itertools import pairwise
from pathlib import Path

from ..models.schedule import Schedule
from ..models.schedule.measured import measured_schedule, normalised
from .csv_tables import Column, read_rows
from .document import Document
from .errors import ScenarioError
from .schema import ScheduleTable, ThrustTable
from .units import THRUST, TIME

SAMPLE_COLUMNS = (
    (Column(("time", "t", "timestamp"), TIME), Column(("thrust", "force", "f", "torque", "value"), THRUST)),
)
"""What a CSV of measured thrust holds."""


def build(table: ScheduleTable, thrust: ThrustTable, document: Document) -> Schedule:
    """Build the schedule of measured thrust.

    Raises
    ------
    ScenarioError
        Naming the key or the line of the CSV file.
    """
    key = document.where("schedule.thrust.csv")
    path = document.origin("schedule").parent / thrust.csv
    rows = read_rows(path, key, SAMPLE_COLUMNS).rows
    if rows[0].first < 0:
        at = f"{key}: {path.name} line {rows[0].line}"
        raise ScenarioError(at, f"time {float(rows[0].first):g} s: times start at 0 s")
    for before, row in pairwise(rows):
        if row.first <= before.first:
            raise ScenarioError(
                f"{key}: {path.name} line {row.line}",
                f"time {float(row.first):g} s does not come after {float(before.first):g} s "
                "in the row above it",
            )
    if table.period is not None and rows[-1].first > table.period:
        raise ScenarioError(
            f"{key}: {path.name} line {rows[-1].line}",
            f"time {float(rows[-1].first):g} s comes after the period ends ({float(table.period):g} s)",
        )
    try:
        samples = normalised(
            [row.first for row in rows],
            [row.second for row in rows],
            zero_below=thrust.zero_below,
            full_thrust=thrust.full_thrust,
        )
        return measured_schedule(
            samples,
            period=table.period,
            thruster_rise=table.thruster_rise,
            thruster_fall=table.thruster_fall,
        )
    except ScenarioError:
        raise
    except ValueError as error:
        raise ScenarioError(f"{key}: {path.name}", str(error)) from None


def described(thrust: ThrustTable) -> str:
    """Return the record, its normalisation and its threshold in words."""
    full = "the largest sample" if thrust.full_thrust is None else f"{float(thrust.full_thrust):g}"
    below = f"{float(thrust.zero_below):g}"
    return f"thrust samples {Path(thrust.csv).name}: g = thrust / {full}, 0 where that is below {below}"
