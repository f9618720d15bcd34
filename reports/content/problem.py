"""What was studied: the scenario, the equations, the schedule; and where the record comes from."""

from __future__ import annotations

from collections.abc import Iterator

from ..record import Record
from ..record.problem import FactEntry
from .blocks import (
    Axis,
    Block,
    Cell,
    Chapter,
    Chart,
    Charts,
    Facts,
    Line,
    MatrixCell,
    Table,
    Text,
    Verbatim,
    code,
    law_row,
)
from .equations import equation_blocks
from .wording import json_text, plural, shared

MAX_WINDOWS = 300
"""Windows shaded in a figure at most; beyond them the shading would be solid."""


def shaded(record: Record) -> tuple[tuple[float, float], ...]:
    """Thruster windows as figures shade them: none if there are more than `MAX_WINDOWS`."""
    schedule = record.sections.schedule
    return schedule.windows if schedule is not None and len(schedule.windows) <= MAX_WINDOWS else ()


def problem_chapter(record: Record) -> Chapter | None:
    """Echo the scenario and set the equations."""
    scenario, cases = record.sections.scenario, record.sections.cases
    blocks: list[Block] = []
    if scenario:
        if scenario.description:
            blocks.append(Text(scenario.description))
        blocks.append(Facts(tuple((f.label, _fact(f)) for f in scenario.facts)))
        blocks.extend(Text(note, "note") for note in scenario.notes)
    parameters = _parameters(record)
    if parameters:
        blocks.append(parameters)
    if cases:
        blocks.extend(equation_blocks(cases))
        blocks.extend(Text(note, "note") for note in shared(_notes(record)))
    return Chapter("problem", "The problem", tuple(blocks)) if blocks else None


def _parameters(record: Record) -> Table | None:
    """One row a law, one column a parameter."""
    cases = record.sections.cases
    heads = {p.name: (p.name, p.words, p.unit) for case in cases for p in case.parameters}
    rows = tuple(law_row(case.label, case.parameters) for case in cases)
    columns = (("law", "Law", ""), *heads.values())
    return Table("parameters", "The laws and their parameters", columns, rows) if heads else None


def _notes(record: Record) -> Iterator[tuple[str, str]]:
    for case in record.sections.cases:
        yield from ((case.label, note) for note in case.notes)


def _fact(fact: FactEntry) -> Cell:
    if fact.quantity is not None:
        return fact.quantity
    if fact.matrix is not None:
        return MatrixCell(fact.matrix, fact.unit or "")
    return fact.text or ""


def schedule_chapter(record: Record) -> Chapter | None:
    """The gain through its windows, and the schedule's facts."""
    schedule = record.sections.schedule
    if schedule is None:
        return None
    windows, t = schedule.windows, record.array(schedule.arrays.time)
    chart = Chart(
        "schedule",
        "Thruster gain g(t)",
        Axis("time", "s"),
        Axis("g"),
        (Line("g", t, record.array(schedule.arrays.gain)),),
        f"The gain over time: {plural(len(windows), 'window')}, zero between them.",
        shaded(record),
    )
    extends = {"periodic": "The table repeats for ever.", "finite": "The table ends; g is zero after it."}
    rows = [(f"{claim.title}: {q.words}", q) for claim in schedule.claims for q in claim.quantities]
    blocks: list[Block] = [Charts((chart,))]
    if rows:
        blocks.append(Facts(tuple(rows)))
    if schedule.extends is not None:
        blocks.append(Text(extends[schedule.extends], "note"))
    if len(windows) > MAX_WINDOWS:
        blocks.append(Text(f"The {len(windows)} windows are too many to shade in the figures.", "note"))
    blocks.extend(Text(note, "note") for note in schedule.notes)
    return Chapter("schedule", "Schedule", tuple(blocks))


def provenance_chapter(record: Record) -> Chapter:
    """Versions, seeds, options, effort and the scenario's text: what is needed to do it again."""
    origin = record.provenance
    rows: list[tuple[str, Cell]] = [
        ("Command", code(origin.command or "-")),
        ("Record", code(record.sha256)),
        ("Input", code(origin.input_sha256)),
        ("Date", origin.date or "not given"),
        ("Package", f"intermit {origin.package_version or '(run from its source)'}"),
        ("Versions", ", ".join(f"{k} {v}" for k, v in sorted(origin.versions.items()))),
        ("Seeds", ", ".join(f"{k} {v}" for k, v in sorted(origin.seeds.items())) or "none"),
    ]
    rows += [(f"Option {k}", code(json_text(v))) for k, v in sorted(origin.options.items())]
    rows += [(f"Effort: {e.label}", str(e.count)) for e in origin.effort]
    for case in record.sections.cases:
        for run in case.runs:
            rows += [(f"Effort: {case.label}, {e.label}", str(e.count)) for e in run.effort]
    blocks: list[Block] = [Facts(tuple(rows))]
    if origin.scenario_text:
        blocks.append(Verbatim(f"Scenario file: {origin.scenario_name}", origin.scenario_text))
    return Chapter("provenance", "Where this comes from", tuple(blocks))
