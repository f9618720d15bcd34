"""What was studied: the scenario, the equations, the schedule; and where the record comes from."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from typing import Any

from ..record import Record
from ..record.values import thaw
from .blocks import Axis, Block, Cell, Chapter, Chart, Charts, Facts, Line, Table, Text, Verbatim
from .equations import equation_blocks
from .wording import plural, shared

MAX_WINDOWS = 300
"""Windows shaded in a figure at most; beyond them the shading would be solid."""


def shaded(record: Record) -> tuple[tuple[float, float], ...]:
    """Thruster windows as figures shade them: none if there are more than `MAX_WINDOWS`."""
    windows = record.document["sections"].get("schedule", {}).get("windows", ())
    return tuple((w[0], w[1]) for w in windows) if len(windows) <= MAX_WINDOWS else ()


def problem_chapter(record: Record) -> Chapter | None:
    """Echo the scenario and set the equations."""
    scenario = record.document["sections"].get("scenario")
    blocks: list[Block] = []
    if scenario:
        if scenario.get("description"):
            blocks.append(Text(scenario["description"]))
        blocks.append(Facts(tuple((f["label"], _fact(f)) for f in scenario.get("facts", ()))))
        blocks.extend(Text(note, "note") for note in scenario.get("notes", ()))
    parameters = _parameters(record)
    if parameters:
        blocks.append(parameters)
    if record.document["sections"].get("cases"):
        blocks.extend(equation_blocks(record.document["sections"]["cases"]))
        blocks.extend(Text(note, "note") for note in shared(_notes(record)))
    return Chapter("problem", "The problem", tuple(blocks)) if blocks else None


def _parameters(record: Record) -> Table | None:
    """One row a law, one column a parameter."""
    cases = record.document["sections"].get("cases", ())
    heads = {
        p["name"]: (p["name"], p.get("label") or p["name"], p.get("unit", ""))
        for case in cases
        for p in case.get("parameters", ())
    }
    rows = tuple(
        {"law": case["label"]} | {p["name"]: p for p in case.get("parameters", ())} for case in cases
    )
    columns = (("law", "Law", ""), *heads.values())
    return Table("parameters", "The laws and their parameters", columns, rows) if heads else None


def _notes(record: Record) -> Iterator[tuple[str, str]]:
    for case in record.document["sections"].get("cases", ()):
        yield from ((case["label"], note) for note in case.get("notes", ()))


def _fact(fact: Mapping[str, Any]) -> Cell:
    if "quantity" in fact:
        quantity: Mapping[str, Any] = fact["quantity"]
        return quantity
    if "matrix" in fact:
        return {"matrix": fact["matrix"], "unit": fact.get("unit", "")}
    return str(fact.get("text", ""))


def schedule_chapter(record: Record) -> Chapter | None:
    """The gain through its windows, and the schedule's facts."""
    schedule = record.document["sections"].get("schedule")
    if not schedule:
        return None
    names, windows = schedule["arrays"], schedule["windows"]
    t = record.array(names["time"])
    chart = Chart(
        "schedule",
        "Thruster gain g(t)",
        Axis("time", "s"),
        Axis("g"),
        (Line("g", t, record.array(names["gain"])),),
        f"The gain over time: {plural(len(windows), 'window')}, zero between them.",
        shaded(record),
    )
    extends = {"periodic": "The table repeats for ever.", "finite": "The table ends; g is zero after it."}
    rows = [
        (f"{claim['title']}: {q.get('label') or q['name']}", q)
        for claim in schedule.get("claims", ())
        for q in claim["quantities"]
    ]
    blocks: list[Block] = [Charts((chart,))]
    if rows:
        blocks.append(Facts(tuple(rows)))
    if schedule.get("extends"):
        blocks.append(Text(extends[schedule["extends"]], "note"))
    if len(windows) > MAX_WINDOWS:
        blocks.append(Text(f"The {len(windows)} windows are too many to shade in the figures.", "note"))
    blocks.extend(Text(note, "note") for note in schedule.get("notes", ()))
    return Chapter("schedule", "Schedule", tuple(blocks))


def provenance_chapter(record: Record) -> Chapter:
    """Versions, seeds, options, effort and the scenario's text: what is needed to do it again."""
    origin = record.document["provenance"]
    rows: list[tuple[str, Cell]] = [
        ("Command", {"code": origin.get("command") or "-"}),
        ("Record", {"code": record.sha256}),
        ("Input", {"code": origin["input_sha256"]}),
        ("Date", origin["date"] or "not given"),
        ("Package", f"intermit {origin['package_version'] or '(run from its source)'}"),
        ("Versions", ", ".join(f"{k} {v}" for k, v in sorted(origin["versions"].items()))),
        ("Seeds", ", ".join(f"{k} {v}" for k, v in sorted(origin["seeds"].items())) or "none"),
    ]
    rows += [(f"Option {k}", _option(v)) for k, v in sorted(origin["options"].items())]
    rows += [(f"Effort: {e['label']}", str(e["count"])) for e in origin.get("effort", ())]
    for case in record.document["sections"].get("cases", ()):
        for run in case.get("runs", ()):
            rows += [
                (f"Effort: {case['label']}, {e['label']}", str(e["count"])) for e in run.get("effort", ())
            ]
    blocks: list[Block] = [Facts(tuple(rows))]
    if origin["scenario_text"]:
        blocks.append(Verbatim(f"Scenario file: {origin['scenario_name']}", origin["scenario_text"]))
    return Chapter("provenance", "Where this comes from", tuple(blocks))


def _option(value: Any) -> Cell:
    return {
        "code": value
        if isinstance(value, str)
        else json.dumps(thaw(value), sort_keys=True, ensure_ascii=False)
    }
