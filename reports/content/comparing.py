"""Two records side by side: a design against its revision. Nothing is subtracted: both numbers stand."""

from __future__ import annotations

import difflib
from collections.abc import Iterator, Mapping

from ..numbers import write
from ..record import Record
from ..record.base import unit_of
from ..record.claims import ClaimEntry, QuantityEntry
from ..record.runs import RunArrays, RunRole
from ..record.tables import VerdictCell
from .blocks import Axis, Block, Cell, Chapter, Chart, Charts, Facts, Line, Table, Text, Verbatim
from .problem import shaded
from .runs import TIME, Run, runs_of
from .verdicts import answer, groups
from .wording import plural

SIDES = ("A", "B")
ROLES: tuple[tuple[RunRole, str, str, tuple[str, ...]], ...] = (
    ("torque", "Applied torque g u", "g u", ("x", "y", "z")),
    ("quaternion", "Attitude", "β", ("β₀", "β₁", "β₂", "β₃")),
    ("rate", "Rate", "ω", ("ω₁", "ω₂", "ω₃")),
)

Key = tuple[str, str]


def comparison_sentence(a: Record, b: Record) -> str:
    """How many verdicts differ."""
    left, right = _claims(a), _claims(b)
    both = [key for key in left if key in right]
    changed = sum(left[key].verdict != right[key].verdict for key in both)
    alone = len(left) + len(right) - 2 * len(both)
    only = f"; {plural(alone, 'claim')} in one record only" if alone else ""
    return f"{plural(len(both), 'claim')} in both: {changed} with another verdict{only}."


def comparison_chapters(a: Record, b: Record) -> tuple[Chapter, ...]:
    """Verdicts, numbers, histories, and what was changed in the scenario."""
    found = [_verdicts(a, b), _numbers(a, b), _histories(a, b), _input(a, b)]
    return tuple(c for c in found if c is not None)


def _claims(record: Record) -> dict[Key, ClaimEntry]:
    found: dict[Key, ClaimEntry] = {}
    for group in groups(record):
        for claim in group.claims:
            found.setdefault((group.label, claim.key), claim)
    return found


def _ordered(left: Mapping[Key, object], right: Mapping[Key, object]) -> list[Key]:
    return [*left, *(key for key in right if key not in left)]


def _verdicts(a: Record, b: Record) -> Chapter:
    left, right = _claims(a), _claims(b)
    rows = []
    for key in _ordered(left, right):
        sides = (left.get(key), right.get(key))
        verdicts = [s.verdict if s else None for s in sides]
        row: dict[str, Cell] = {"of": key[0], "claim": next(s.title for s in sides if s)}
        for name, side in zip(SIDES, sides, strict=True):
            row[name] = VerdictCell(verdict=side.verdict) if side else None
            row[f"m{name}"] = _margins(side)
        row["change"] = "changed" if verdicts[0] != verdicts[1] else "same"
        rows.append(row)
    rows.sort(key=lambda row: row["change"] == "same")
    heads = {"of": "Of", "claim": "Claim", "A": "A", "B": "B", "change": "Verdict"}
    heads |= {"mA": "Margin in A", "mB": "Margin in B"}
    columns = tuple((key, label, "") for key, label in heads.items())
    blocks: list[Block] = [
        Facts((("A", _name(a)), ("B", _name(b)), ("Outcome of A", answer(a)), ("Outcome of B", answer(b)))),
        Table("verdicts", "Claims side by side, changed ones first", columns, tuple(rows)),
    ]
    return Chapter("verdicts", "Verdicts", tuple(blocks))


def _name(record: Record) -> str:
    origin = record.provenance
    date = f", {origin.date}" if origin.date else ""
    return f"{record.title} ({origin.scenario_name}{date}), record {record.sha256[:12]}"


def _margins(claim: ClaimEntry | None) -> str | None:
    if claim is None or not claim.margins:
        return None
    return "; ".join(f"{q.words} {write(q).text}" for q in claim.margins)


def _metrics(record: Record) -> dict[Key, QuantityEntry]:
    found: dict[Key, QuantityEntry] = {}
    for run in runs_of(record):
        for q in run.data.metrics:
            found.setdefault((run.label, q.name), q)
    for entry in record.sections.optimum:
        for key, figure in (("value", entry.value), ("bound", entry.bound), ("gap", entry.gap)):
            if figure is not None:
                found.setdefault((entry.label, figure.label or key), figure)
    return found


def _numbers(a: Record, b: Record) -> Chapter | None:
    left, right = _metrics(a), _metrics(b)
    rows = tuple(
        {
            "of": key[0],
            "what": (left.get(key) or right[key]).label or key[1],
            "A": left.get(key),
            "B": right.get(key),
        }
        for key in _ordered(left, right)
    )
    columns = (("of", "Of", ""), ("what", "Figure", ""), ("A", "A", ""), ("B", "B", ""))
    return (
        Chapter("numbers", "Numbers", (Table("numbers", "Figures side by side", columns, rows),))
        if rows
        else None
    )


def _pairs(a: Record, b: Record) -> Iterator[tuple[Run, Run]]:
    """Runs of the same name; if no name is in both, the runs in their order."""
    left, right = runs_of(a), runs_of(b)
    by_label = {run.label: run for run in right}
    named = [(run, by_label[run.label]) for run in left if run.label in by_label]
    yield from named or zip(left, right, strict=False)


def _histories(a: Record, b: Record) -> Chapter | None:
    charts: list[Chart] = []
    windows = shaded(a) if shaded(a) == shaded(b) else ()
    for i, (one, two) in enumerate(_pairs(a, b)):
        label = one.label if one.label == two.label else f"{one.label} / {two.label}"
        for role, words, axis, names in ROLES:
            lines = _lines(one, two, role, names)
            if lines:
                alt = f"{words} of {label}: A solid, B dashed."
                charts.append(
                    Chart(
                        f"{role}-{i + 1}",
                        f"{words}: {label}",
                        TIME,
                        Axis(axis, unit_of(RunArrays, role)),
                        lines,
                        alt,
                        windows,
                    )
                )
        charts += _states(one, two, i, label, windows)
    blocks: list[Block] = [Text("A is drawn solid, B dashed.", "note"), Charts(tuple(charts))]
    if not windows and (shaded(a) or shaded(b)):
        blocks.insert(1, Text("The schedules differ, so no windows are shaded.", "note"))
    return Chapter("histories", "Histories", tuple(blocks)) if charts else None


def _lines(one: Run, two: Run, role: RunRole, names: tuple[str, ...]) -> tuple[Line, ...]:
    lines = []
    for side, run in zip(SIDES, (one, two), strict=True):
        values = run.array(role)
        if values is not None:
            lines += [
                Line(f"{side} {name}", run.time, values[:, j], colour=j, dashed=side == "B")
                for j, name in enumerate(names)
            ]
    return tuple(lines)


def _states(
    one: Run, two: Run, index: int, label: str, windows: tuple[tuple[float, float], ...]
) -> Iterator[Chart]:
    held = [run.data.arrays.controller or {} for run in (one, two)]
    for state, unit in (("R", "s"), ("k", "1/s")):
        lines = tuple(
            Line(f"{side} {state}", run.time, run.record.array(names[state]), colour=j, dashed=side == "B")
            for j, (side, run, names) in enumerate(zip(SIDES, (one, two), held, strict=True))
            if state in names
        )
        if lines:
            title = f"{state}: {label}"
            yield Chart(
                f"state-{state.lower()}-{index + 1}", title, TIME, Axis(state, unit), lines, title, windows
            )


def _input(a: Record, b: Record) -> Chapter:
    one, two = (r.provenance for r in (a, b))
    before, after = (o.scenario_text.splitlines() for o in (one, two))
    lines = list(difflib.unified_diff(before, after, "A", "B", lineterm="", n=2))
    blocks: list[Block] = [
        Verbatim("Lines of the scenario that differ", "\n".join(lines))
        if lines
        else Text("The two scenario files are the same.")
    ]
    names = sorted({*one.versions, *two.versions} | {"intermit"})
    versions = [{**o.versions, "intermit": o.package_version} for o in (one, two)]
    rows = tuple({"what": n, "A": versions[0].get(n), "B": versions[1].get(n)} for n in names)
    columns = (("what", "Package", ""), ("A", "A", ""), ("B", "B", ""))
    blocks.append(Table("versions", "Versions", columns, rows))
    return Chapter("input", "What was changed", tuple(blocks))
