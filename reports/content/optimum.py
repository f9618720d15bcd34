"""How good could any controller be: optimum, certified bound, and the histories that reach it."""

from __future__ import annotations

from ..numbers import number, unit_text
from ..record import Record
from ..record.base import unit_of
from ..record.optimum import OptimumArrays, OptimumEntry, OptimumRole
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
    entries = record.sections.optimum
    if not entries:
        return None
    rows = tuple(_row(e) for e in entries)
    notes = tuple(f"{e.label}: {', '.join(_terms(e))}." for e in entries if _terms(e))
    blocks: list[Block] = [Table("optimum", "Certified lower bound and optimum", COLUMNS, rows, notes)]
    for i, entry in enumerate(entries):
        blocks.extend(_one(record, i, entry))
    return Chapter("optimum", "The best any controller could do", tuple(blocks))


def _row(entry: OptimumEntry) -> dict[str, Cell]:
    local = entry.local_optima
    words = f"{len(local.values)} found from {plural(local.starts, 'start')}" if local else None
    row: dict[str, Cell] = {"norm": entry.label, "value": entry.value, "local": words}
    return row | {"tf": entry.final_time, "bound": entry.bound, "gap": entry.gap, "name": entry.bound_name}


def _terms(entry: OptimumEntry) -> list[str]:
    thrust = PROFILES.get(entry.profile, entry.profile)
    return [words for words in (thrust, entry.terminal) if words]


def _one(record: Record, index: int, entry: OptimumEntry) -> list[Block]:
    charts = _charts(record, index, entry)
    blocks: list[Block] = [Charts(tuple(charts))] if charts else []
    rows: list[dict[str, Cell]] = [{"what": q.words, "value": q} for q in entry.residuals]
    rows += [{"what": f"Other bound: {q.words}", "value": q} for q in entry.other_bounds or ()]
    times = entry.switch_times
    if times:
        rows.append(
            {"what": "Switch times", "value": ", ".join(number(t, COARSE_DIGITS) for t in times) + " s"}
        )
    local = entry.local_optima
    if local is not None:
        unit = f" {unit_text(local.unit)}" if local.unit else ""
        values = ", ".join(number(v, COARSE_DIGITS) for v in local.values)
        rows.append({"what": "Local optima, before the mesh is refined", "value": values + unit})
        if local.spread is not None:
            rows.append({"what": "Their spread", "value": local.spread})
    rows += [{"what": f"Effort: {e.label}", "value": str(e.count)} for e in entry.effort]
    if rows:
        columns = (("what", "Checked after the solve", ""), ("value", "Value", ""))
        blocks.append(Table(f"optimum-{index + 1}", f"{entry.label}: checks", columns, tuple(rows)))
    return blocks + [Text(note, "note") for note in entry.notes]


def _charts(record: Record, index: int, entry: OptimumEntry) -> list[Chart]:
    if entry.arrays is None:
        return []
    windows = shaded(record)
    t = record.array(entry.arrays.time)
    charts = []
    kinds: tuple[tuple[OptimumRole, str, tuple[str, ...]], ...] = (
        ("torque", "Torque", ("x", "y", "z")),
        ("rate", "Rate", ("ω₁", "ω₂", "ω₃")),
        ("switching", "Switching function", ("x", "y", "z")),
        ("momentum", "Angular momentum", ("x", "y", "z")),
    )
    for role, words, suffixes in kinds:
        name = entry.arrays.name_of(role)
        if name is None:
            continue
        values = record.array(name).reshape(len(t), -1)
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
        title = f"{words} of the optimum: {entry.label}"
        charts.append(
            Chart(
                f"optimum-{role}-{index + 1}",
                title,
                Axis("time", "s"),
                Axis(words.lower(), unit_of(OptimumArrays, role)),
                lines,
                f"{title}, over time.",
                windows,
            )
        )
    return charts
