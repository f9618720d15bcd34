"""Sections that are already tables and figures: samples, comparison, front, studies, audit."""

from __future__ import annotations

from collections.abc import Mapping
from itertools import cycle
from typing import Any

import numpy as np

from ..record import Record
from .blocks import Axis, Block, Cell, Chapter, Chart, Charts, Facts, Line, Table, Text
from .problem import shaded
from .wording import slug

_ROLE_COLOUR = {"bound": 2, "optimum": 3}


def chart_from(record: Record, figure: Mapping[str, Any], key: str) -> Chart:
    """Read a record's own figure."""
    taken = {_ROLE_COLOUR[s["role"]] for s in figure["series"] if s.get("role", "") in _ROLE_COLOUR}
    lines, free = [], cycle([c for c in range(8) if c % 4 not in taken])
    for s in figure["series"]:
        role = s.get("role", "")
        colour = _ROLE_COLOUR[role] if role in _ROLE_COLOUR else next(free)
        upper = record.array(s["upper"]) if "upper" in s else None
        x, y = record.array(s["x"]), record.array(s["y"])
        lines.append(Line(s["label"], x, y, s.get("style", "line"), colour, role == "reference", upper))
    axes = [
        Axis(figure[k]["label"], figure[k].get("unit", ""), bool(figure[k].get("log"))) for k in ("x", "y")
    ]
    windows = shaded(record) if figure.get("windows") else ()
    return Chart(
        key,
        figure["title"],
        axes[0],
        axes[1],
        tuple(lines),
        figure["alt"],
        windows,
        notes=tuple(figure.get("notes", ())),
    )


def table_from(table: Mapping[str, Any], key: str) -> Table:
    """Read a record's own table."""
    columns = tuple((c["key"], c["label"], c.get("unit", "")) for c in table["columns"])
    return Table(key, table["title"], columns, tuple(table["rows"]), tuple(table.get("notes", ())))


def collection_chapter(record: Record, section: str, title: str) -> Chapter | None:
    """Tables, figures and notes of one collection."""
    held = record.document["sections"].get(section)
    if not held:
        return None
    blocks: list[Block] = [Text(held["summary"])] if held.get("summary") else []
    prefix = section.replace("_", "-")
    blocks += [table_from(t, f"{prefix}-{slug(t['key'], i)}") for i, t in enumerate(held.get("tables", ()))]
    charts = [
        chart_from(record, f, f"{prefix}-{slug(f['key'], i)}") for i, f in enumerate(held.get("figures", ()))
    ]
    if charts:
        blocks.append(Charts(tuple(charts)))
    blocks += [Text(note, "note") for c in charts for note in c.notes]
    blocks += [Text(note, "note") for note in held.get("notes", ())]
    return Chapter(prefix, held.get("title") or title, tuple(blocks))


def samples_chapter(record: Record) -> Chapter | None:
    """Sampled margins: evidence, never a proof, and said so."""
    entries = record.document["sections"].get("samples", ())
    if not entries:
        return None
    blocks: list[Block] = [Text("Samples support a claim; they never prove it.", "note")]
    for i, entry in enumerate(entries):
        rows: list[tuple[str, Cell]] = [("Samples", f"{entry['count']:,}")]
        rows += [
            (words, str(entry[k]))
            for k, words in (("coverage", "Drawn from"), ("seed", "Seed"), ("statement", "Found"))
            if k in entry
        ]
        rows += [(q.get("label") or q["name"], q) for q in entry.get("margins", ())]
        if "worst" in entry:
            worst = entry["worst"]
            rows.append((f"Worst: {worst['description']}", worst["violation"]))
            rows += [(f"Worst state, {k}", values_text(v)) for k, v in worst["values"].items()]
        blocks.append(Facts(tuple(rows), entry["label"]))
        charts = _sample_charts(record, entry, i)
        if charts:
            blocks.append(Charts(tuple(charts)))
    return Chapter("samples", "Sampled margins", tuple(blocks))


def _sample_charts(record: Record, entry: Mapping[str, Any], index: int) -> list[Chart]:
    charts = []
    if "histogram" in entry:
        h = entry["histogram"]
        line = Line("samples", record.array(h["edges"]), record.array(h["counts"]), style="bars")
        x = Axis(h.get("label", "margin"), h.get("unit", ""))
        alt = f"Histogram of {entry['count']} sampled margins."
        charts.append(
            Chart(
                f"samples-histogram-{index + 1}",
                f"{entry['label']}: how the margins spread",
                x,
                Axis("samples"),
                (line,),
                alt,
            )
        )
    return charts


def values_text(value: Any) -> str:
    """Write a witness's value: numbers in full precision, so that it can be typed in again."""
    if isinstance(value, (list, tuple, np.ndarray)):
        return "(" + ", ".join(values_text(v) for v in value) + ")"
    if isinstance(value, float):
        return repr(value)
    return str(value)
