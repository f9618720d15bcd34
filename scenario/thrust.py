"""From measured thrust samples to a schedule (placeholder until measured profiles land)."""

from __future__ import annotations

from ..models.schedule import Schedule
from .document import Document
from .errors import ScenarioError
from .schema import ScheduleTable


def measured_schedule(table: ScheduleTable, document: Document) -> Schedule:
    """Build the schedule of [schedule.thrust]."""
    del table
    raise ScenarioError(document.where("schedule.thrust"), "measured thrust is not supported yet")
