"""Printing what a study put into tables: any section of a record that is made of them."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

from ..reports.content.cells import cell_text
from .claim_tables import plain_table

if TYPE_CHECKING:
    from rich.console import Console

    from ..reports.record import Record

SECTIONS = ("comparison", "tuning", "front", "schedule_study", "paper_claims", "audit")


def print_collections(console: Console, record: Record) -> None:
    """Print the tables and notes of every such section."""
    for name in SECTIONS:
        if name not in record.document["sections"]:
            continue
        section = record.document["sections"][name]
        console.print(section.get("title", name), style="bold")
        if section.get("summary"):
            console.print(section["summary"])
        for table in section.get("tables", ()):
            console.print()
            console.print(_table(table))
        console.print()
        for text in section.get("notes", ()):
            console.print(f"- {text}")


def _table(table: Mapping[str, Any]) -> Any:
    columns = table["columns"]
    drawn = plain_table(*(column["label"] for column in columns))
    drawn.title, drawn.title_justify, drawn.title_style = table["title"], "left", "italic"
    for row in table["rows"]:
        drawn.add_row(*(cell_text(row.get(column["key"])) for column in columns))
    return drawn
