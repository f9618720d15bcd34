"""From the [linear] table to a linear plant through the scenario's windows."""

from __future__ import annotations

from ..models.linear import LinearPlant
from ..models.schedule import Schedule
from .document import Document
from .errors import ScenarioError
from .schema import LinearTable

MAX_STATES = 12
"""States a linear plant may have: its proof takes time like their cube."""


def build(table: LinearTable | None, schedule: Schedule, document: Document) -> LinearPlant | None:
    """Build the plant, exact; None without a table.

    Raises
    ------
    ScenarioError
        If the matrices do not fit each other, or are too large.
    """
    if table is None:
        return None
    if len(table.A) > MAX_STATES:
        raise ScenarioError(
            document.where("linear.A"), f"expected at most {MAX_STATES} rows, received {len(table.A)}"
        )
    try:
        return LinearPlant.from_rows(table.A, table.B, table.K, schedule)
    except ValueError as error:
        raise ScenarioError(document.where("linear"), str(error)) from None
