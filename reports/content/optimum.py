"""How good could any controller be: optimum, certified bound, and the histories that reach it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from ..numbers import number, unit_text
from ..record import Record
from .blocks import Axis, Block, Cell, Chapter, Chart, Charts, Line, Table, Text
from .problem import shaded
from .wording import plural

COLUMNS = (
    ("norm", "Problem", ""),
    ("tf", "Final time", "s"),
    ("bound", "Certified lower bound", ""),
    ("value", "Optimum found", ""),
    ("gap", "Gap", "%"),
    ("name", "Bound by", ""),
    ("local", "Local optima", ""),
)

PROFILES = {"window": "full thrust inside each window", "gain": "thrust up to p g(t)"}
"""What the record calls the thrust available, in words."""
COARSE_DIGITS = 4
"""Digits of what is found on one mesh and not converged: switch times, the other local optima."""


def optimum_chapter(record: Record) -> Chapter | None:
    """The table bound <= optimum, then torque, rate and switching function of each optimum."""
    entries = record.document["sections"].get("optimum", ())
    if not entries:
        return None
    rows = tuple(_row(e) for e in entries)
    notes = tuple(f"{e['label']}: {', '.join(_terms(e))}." for e in entries if _terms(e))
    blocks: list[Block] = [Table("optimum", "Certified lower bound and optimum", COLUMNS, rows, notes)]
    for i, entry in enumerate(entries):
        blocks.extend(_one(record, i, entry))
    return Chapter("optimum", "The best any controller could do", tuple(blocks))


def _row(entry: Mapping[str, Any]) -> dict[str, Cell]:
    local = entry.get("local_optima")
    words = f"{len(local['values'])} found from {plural(local['starts'], 'start')}" if local else None
    row: dict[str, Cell] = {"norm": entry["label"], "value": entry["value"], "local": words}
    row |= {"tf": entry.get("final_time"), "bound": entry.get("bound"), "gap": entry.get("gap")}
    return row | {"name": entry.get("bound_name")}


def _terms(entry: Mapping[str, Any]) -> list[str]:
    thrust = PROFILES.get(entry.get("profile", ""), entry.get("profile", ""))
    return [words for words in (thrust, entry.get("terminal", "")) if words]


def _one(record: Record, index: int, entry: Mapping[str, Any]) -> list[Block]:
    charts = _charts(record, index, entry)
    blocks: list[Block] = [Charts(tuple(charts))] if charts else []
    rows: list[dict[str, Cell]] = [
        {"what": q.get("label") or q["name"], "value": q} for q in entry.get("residuals", ())
    ]
    rows += [
        {"what": f"Other bound: {q.get('label') or q['name']}", "value": q}
        for q in entry.get("other_bounds", ())
    ]
    times = entry.get("switch_times", ())
    if times:
        rows.append(
            {"what": "Switch times", "value": ", ".join(number(t, COARSE_DIGITS) for t in times) + " s"}
        )
    local = entry.get("local_optima")
    if local:
        unit = f" {unit_text(local['unit'])}" if local.get("unit") else ""
        values = ", ".join(number(v, COARSE_DIGITS) for v in local["values"])
        rows.append({"what": "Local optima, before the mesh is refined", "value": values + unit})
        if "spread" in local:
            rows.append({"what": "Their spread", "value": local["spread"]})
    rows += [{"what": f"Effort: {e['label']}", "value": str(e["count"])} for e in entry.get("effort", ())]
    if rows:
        columns = (("what", "Checked after the solve", ""), ("value", "Value", ""))
        blocks.append(Table(f"optimum-{index + 1}", f"{entry['label']}: checks", columns, tuple(rows)))
    return blocks + [Text(note, "note") for note in entry.get("notes", ())]


def _charts(record: Record, index: int, entry: Mapping[str, Any]) -> list[Chart]:
    names, windows = entry.get("arrays", {}), shaded(record)
    if "time" not in names:
        return []
    t = record.array(names["time"])
    charts = []
    kinds = (
        ("torque", "Torque", "N m", ("x", "y", "z")),
        ("rate", "Rate", "rad/s", ("ω₁", "ω₂", "ω₃")),
        ("switching", "Switching function", "", ("x", "y", "z")),
        ("momentum", "Angular momentum", "N m s", ("x", "y", "z")),
    )
    for role, words, unit, suffixes in kinds:
        if role not in names:
            continue
        values = record.array(names[role]).reshape(len(t), -1)
        single = values.shape[1] == 1
        lines = tuple(
            Line(
                words if single else (suffixes[j] if j < len(suffixes) else str(j + 1)),
                t,
                values[:, j],
                colour=j,
            )
            for j in range(values.shape[1])
        )
        title = f"{words} of the optimum: {entry['label']}"
        charts.append(
            Chart(
                f"optimum-{role}-{index + 1}",
                title,
                Axis("time", "s"),
                Axis(words.lower(), unit),
                lines,
                f"{title}, over time.",
                windows,
            )
        )
    return charts
