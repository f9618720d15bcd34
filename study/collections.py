"""Small helpers for studies that end in tables and figures."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from ..models.types import Array
from ..reports import parts
from ..reports.content.cells import cell_text
from ..reports.provenance import provenance
from ..reports.record import Record
from ..reports.record.claims import QuantityEntry
from ..reports.record.document import Sections
from ..reports.record.tables import TableEntry
from ..scenario import Scenario


@final
@dataclass
class Arrays:
    """Named arrays of a record while it is put together."""

    held: dict[str, Array] = field(default_factory=dict)

    def put(self, name: str, values: ArrayLike) -> str:
        """Keep an array; returns its name."""
        if name in self.held:
            raise ValueError(f"array {name} is there already")
        self.held[name] = np.asarray(values, dtype=float)
        return name


def printed(table: TableEntry) -> tuple[tuple[str, ...], list[tuple[str, ...]]]:
    """A record's table in plain words: its head, and its rows."""
    keys = [column.key for column in table.columns]
    head = tuple(column.label for column in table.columns)
    return head, [tuple(cell_text(row.get(key)) for key in keys) for row in table.rows]


def newtons(name: str, value: float | None, digits: int = 5) -> QuantityEntry:
    """A torque, N m."""
    return parts.figure_of(name, value, digits=digits, unit="N m")


def certified_below(name: str, value: float) -> QuantityEntry:
    """A certified lower bound on a torque, N m: shown rounded down."""
    return parts.quantity(name, value, unit="N m", rigorous=True, side="lower")


def collection_record(
    scenario: Scenario,
    *,
    title: str,
    command: str,
    sections: Sections,
    arrays: Arrays,
    seeds: dict[str, int] | None = None,
    options: Mapping[str, object] | None = None,
) -> Record:
    """Record of a study made of tables and figures."""
    found = provenance(
        scenario_name=scenario.name,
        scenario_text=scenario.text,
        command=command,
        seeds=seeds or {},
        options=options or {},
    ).but(input_sha256=scenario.sha256)
    return Record.create(title=title, provenance=found, sections=sections, arrays=arrays.held)
