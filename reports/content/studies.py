"""Sections that are already tables and figures: samples, comparison, front, studies, audit."""

from __future__ import annotations

from itertools import cycle
from typing import Any

import numpy as np

from ..record import Record
from ..record.runs import SamplesEntry
from ..record.tables import CollectionEntry, FigureEntry, TableEntry
from .blocks import Axis, Block, Cell, Chapter, Chart, Charts, Facts, Line, Table, Text
from .problem import shaded
from .wording import slug

_ROLE_COLOUR = {"bound": 2, "optimum": 3}


def chart_from(record: Record, figure: FigureEntry, key: str) -> Chart:
    """Read a record's own figure."""
    taken = {_ROLE_COLOUR[s.role] for s in figure.series if s.role is not None and s.role in _ROLE_COLOUR}
    lines, free = [], cycle([c for c in range(8) if c % 4 not in taken])
    for s in figure.series:
        colour = _ROLE_COLOUR[s.role] if s.role is not None and s.role in _ROLE_COLOUR else next(free)
        upper = record.array(s.upper) if s.upper is not None else None
        x, y = record.array(s.x), record.array(s.y)
        lines.append(Line(s.label, x, y, s.style, colour, s.role == "reference", upper))
    x_axis, y_axis = (Axis(axis.label, axis.unit, axis.log) for axis in (figure.x, figure.y))
    windows = shaded(record) if figure.windows else ()
    return Chart(key, figure.title, x_axis, y_axis, tuple(lines), figure.alt, windows, notes=figure.notes)


def table_from(table: TableEntry, key: str) -> Table:
    """Read a record's own table."""
    columns = tuple((c.key, c.label, c.unit) for c in table.columns)
    return Table(key, table.title, columns, table.rows, table.notes)


def collection_chapter(record: Record, prefix: str, title: str, held: CollectionEntry) -> Chapter:
    """Tables, figures and notes of one collection; `prefix` begins the names of its files."""
    blocks: list[Block] = [Text(held.summary)] if held.summary else []
    blocks += [table_from(t, f"{prefix}-{slug(t.key, i)}") for i, t in enumerate(held.tables)]
    charts = [chart_from(record, f, f"{prefix}-{slug(f.key, i)}") for i, f in enumerate(held.figures)]
    if charts:
        blocks.append(Charts(tuple(charts)))
    blocks += [Text(note, "note") for c in charts for note in c.notes]
    blocks += [Text(note, "note") for note in held.notes]
    return Chapter(prefix, held.title or title, tuple(blocks))


def samples_chapter(record: Record) -> Chapter | None:
    """Sampled margins: evidence, never a proof, and said so."""
    entries = record.sections.samples
    if not entries:
        return None
    blocks: list[Block] = [Text("Samples support a claim; they never prove it.", "note")]
    for i, entry in enumerate(entries):
        rows: list[tuple[str, Cell]] = [("Samples", f"{entry.count:,}")]
        said = (("Drawn from", entry.coverage), ("Seed", entry.seed), ("Found", entry.statement))
        rows += [(words, str(value)) for words, value in said if value is not None]
        rows += [(q.words, q) for q in entry.margins]
        if entry.worst is not None:
            rows.append((f"Worst: {entry.worst.description}", entry.worst.violation))
            values = sorted(entry.worst.values.items())
            rows += [(f"Worst state, {k}", values_text(v)) for k, v in values]
        blocks.append(Facts(tuple(rows), entry.label))
        charts = _sample_charts(record, entry, i)
        if charts:
            blocks.append(Charts(tuple(charts)))
    return Chapter("samples", "Sampled margins", tuple(blocks))


def _sample_charts(record: Record, entry: SamplesEntry, index: int) -> list[Chart]:
    if entry.histogram is None:
        return []
    h = entry.histogram
    line = Line("samples", record.array(h.edges), record.array(h.counts), style="bars")
    title, alt = f"{entry.label}: how the margins spread", f"Histogram of {entry.count} sampled margins."
    key = f"samples-histogram-{index + 1}"
    return [Chart(key, title, Axis(h.label, h.unit), Axis("samples"), (line,), alt)]


def values_text(value: Any) -> str:
    """Write a witness's value: numbers in full precision, so that it can be typed in again."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return "(" + ", ".join(values_text(v) for v in value) + ")"
    if isinstance(value, float):
        return repr(value)
    return str(value)
