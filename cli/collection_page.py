"""Printing what a study put into tables: any section of a record that is made of them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from ..reports.content.cells import cell_text
from ..reports.content.verdicts import collections
from .claim_tables import plain_table

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from ..reports.record import Record
    from ..reports.record.tables import TableEntry


def print_collections(console: Console, record: Record) -> None:
    """Print the tables and notes of every such section."""
    for _, title, section in collections(record.sections):
        console.print(section.title or title, style="bold")
        if section.summary:
            console.print(section.summary)
        for table in section.tables:
            console.print()
            console.print(_table(table))
        console.print()
        for text in section.notes:
            console.print(f"- {text}")


def _table(table: TableEntry) -> Table:
    drawn = plain_table(*(column.label for column in table.columns))
    drawn.title, drawn.title_justify, drawn.title_style = table.title, "left", "italic"
    for row in table.rows:
        drawn.add_row(*(cell_text(row.get(column.key)) for column in table.columns))
    return drawn
