"""The chapters as one PDF, set by Typst from data: text stays literal, only our equations are evaluated."""

from __future__ import annotations

import json
import tempfile
from collections.abc import Mapping
from datetime import UTC, datetime
from functools import singledispatch
from importlib.resources import files
from pathlib import Path
from typing import Any

from ..content.blocks import (
    Block,
    Cards,
    Cell,
    Chapter,
    Charts,
    ClaimDetails,
    Equations,
    Facts,
    Replay,
    Table,
    Text,
    Verbatim,
    Verdicts,
)
from ..content.printable import font_folder, printable
from ..content.studies import values_text
from ..content.verdicts import answer
from ..content.wording import short
from ..numbers import number, unit_text, write
from ..record import Record
from ..values import thaw

BREAK_EVERY = 24
"""Characters of an unbroken word after which a line may break."""


def pdf_document(
    record: Record,
    chapters: tuple[Chapter, ...],
    drawings: Mapping[str, bytes],
    *,
    sentence: str = "",
    title: str = "",
) -> bytes:
    """Typeset the chapters; `drawings` holds "<chart key>.svg"."""
    import typst

    origin = record.document["provenance"]
    data = {
        "title": words(title or record.document["title"]),
        "running": brief(title or record.document["title"], 90),
        "answer": words(sentence or answer(record)),
        "scenario": words(origin["scenario_name"]),
        "author": words(origin.get("author", "")),
        "date": words(origin["date"] or "undated"),
        "digest": record.sha256,
        "version": origin["package_version"],
        "status": {0: "PROVED", 1: "REFUTED", 3: "UNDECIDED"}.get(_code(record), ""),
        "chapters": [{"title": c.title, "blocks": [b for b in map(spoken, c.blocks) if b]} for c in chapters],
    }
    with tempfile.TemporaryDirectory() as folder:
        root = Path(folder)
        (root / "data.json").write_text(json.dumps(data, ensure_ascii=False), encoding="utf-8")
        source = files("intermit.reports").joinpath("templates/report.typ").read_text(encoding="utf-8")
        (root / "report.typ").write_text(source, encoding="utf-8")
        for name, drawing in drawings.items():
            if name.endswith(".svg"):
                (root / name).write_bytes(drawing)
        document: bytes = typst.compile(
            root / "report.typ",
            root=root,
            format="pdf",
            ignore_system_fonts=True,
            font_paths=[font_folder()],
            timestamp=_instant(origin["date"]),
        )
    return document


def _code(record: Record) -> int:
    return int(record.document.get("outcome", {}).get("exit_code", -1))


def _instant(date: str) -> int:
    """Seconds since 1970 of the record's date, 0 if it has none: the PDF's own date, never the clock's."""
    try:
        return int(datetime.fromisoformat(date).replace(tzinfo=UTC).timestamp()) if date else 0
    except (ValueError, OverflowError):
        return 0


def words(text: str) -> str:
    """Text as the PDF sets it: drawable, and breakable inside long words."""
    return "".join(_breakable(w) for w in _split(printable(text)))


def brief(text: str, most: int = 300) -> str:
    """Shorten text for narrow columns and captions; the claims in full have all of it."""
    return words(short(text, most))


def _split(text: str) -> list[str]:
    parts, current = [], ""
    for c in text:
        if c.isspace():
            parts += [current, c]
            current = ""
        else:
            current += c
    return [*parts, current]


def _breakable(word: str) -> str:
    if len(word) <= BREAK_EVERY:
        return word
    return "\u200b".join(word[i : i + BREAK_EVERY] for i in range(0, len(word), BREAK_EVERY))


def cell(value: Cell, column_unit: str = "") -> dict[str, Any]:
    """One cell: its text and how it is set."""
    if value is None:
        return {"text": "–"}
    if isinstance(value, str):
        return {"text": words(value)}
    if "verdict" in value:
        return {"verdict": value["verdict"], "text": words(value.get("text", ""))}
    if "code" in value:
        return {"code": words(value["code"])}
    if "matrix" in value:
        return {
            "matrix": [[number(x, 12) for x in row] for row in value["matrix"]],
            "text": words(unit_text(value["unit"])),
        }
    written = write(value, unit=not column_unit or column_unit != value.get("unit"))
    return {
        "text": words(written.text.replace(" ", "\u00a0")),
        "rigorous": written.rigorous and not written.missing,
    }


@singledispatch
def spoken(block: Block) -> dict[str, Any] | None:
    """Turn a block into data for the template; the replay has no place on paper."""
    raise TypeError(f"no rule to print a {type(block).__name__}")


@spoken.register
def _(block: Replay) -> None:
    del block


@spoken.register
def _(block: Text) -> dict[str, Any]:
    return {"kind": "text", "text": words(block.text), "style": block.kind}


@spoken.register
def _(block: Cards) -> dict[str, Any]:
    names = {q["name"]: brief(q.get("label") or q["name"]) for c in block.cards for q in c.numbers}
    rows = []
    for card in block.cards:
        held = {q["name"]: cell(q) for q in card.numbers}
        counts = ", ".join(f"{n} {v}" for v, n in card.verdicts)
        rows.append(
            {
                "label": brief(card.label),
                "counts": counts,
                "cells": [held.get(n, {"text": "–"}) for n in names],
            }
        )
    return {"kind": "cards", "names": list(names.values()), "rows": rows}


@spoken.register
def _(block: Verdicts) -> dict[str, Any]:
    return {
        "summary": words(block.summary),
        "kind": "verdicts",
        "groups": [
            {"label": brief(g.label), "claims": [_claim(c) for _, c in held]}
            for g in block.groups
            if (held := g.entries(counted=block.counted))
        ],
    }


def _claim(claim: Mapping[str, Any]) -> dict[str, Any]:
    why = claim.get("reason", "") if claim["verdict"] == "UNDECIDED" else ""
    if claim.get("witness"):
        why = f"refuted: {claim['witness']['description']}"
    return {
        "title": brief(claim["title"]),
        "statement": brief(claim["statement"]),
        "verdict": claim["verdict"],
        "margins": [[brief(q.get("label") or q["name"]), cell(q)] for q in claim["margins"]],
        "evidence": [[e["kind"], brief(e["summary"])] for e in claim["evidence"]],
        "why": brief(why),
        "recheck": brief(claim.get("recheck", "")),
        "source": brief(claim.get("source", "")),
    }


@spoken.register
def _(block: ClaimDetails) -> dict[str, Any]:
    groups = [{"label": words(g.label), "claims": [_details(c) for c in g.claims]} for g in block.groups]
    return {"kind": "details", "groups": groups}


def _details(claim: Mapping[str, Any]) -> dict[str, Any]:
    rows: list[tuple[str, dict[str, Any]]] = [("Key", {"code": words(claim["key"])})]
    rows += [(words(q.get("label") or q["name"]), cell(q)) for q in claim["quantities"]]
    rows += [("Margin: " + words(q.get("label") or q["name"]), cell(q)) for q in claim["margins"]]
    for e in claim["evidence"]:
        source = f" ({e['source']})" if e.get("source") else ""
        rows.append((f"Evidence: {e['kind']}", {"text": words(e["summary"] + source)}))
        rows += [
            ("  " + words(k), {"code": words(_json(v))}) for k, v in sorted(e.get("details", {}).items())
        ]
    if claim.get("witness"):
        witness = claim["witness"]
        rows.append(("Witness", {"text": words(witness["description"])}))
        rows += [
            ("  " + words(k), {"code": words(values_text(v))}) for k, v in sorted(witness["values"].items())
        ]
        rows.append(
            ("  " + words(witness["violation"].get("label") or "violation"), cell(witness["violation"]))
        )
    named = (("reason", "Why"), ("next_step", "Next step"), ("source", "Source"), ("recheck", "Check again"))
    rows += [(label, {"text": words(claim[key])}) for key, label in named if claim.get(key)]
    return {
        "title": words(claim["title"]),
        "verdict": claim["verdict"],
        "statement": words(claim["statement"]),
        "rows": rows,
    }


def _json(value: Any) -> str:
    return value if isinstance(value, str) else json.dumps(thaw(value), sort_keys=True, ensure_ascii=False)


@spoken.register
def _(block: Facts) -> dict[str, Any]:
    return {
        "kind": "facts",
        "title": words(block.title),
        "rows": [[words(label), cell(v)] for label, v in block.rows],
    }


@spoken.register
def _(block: Table) -> dict[str, Any]:
    heads = [
        brief(label) + (f" ({brief(unit_text(unit), 40)})" if unit else "")
        for _, label, unit in block.columns
    ]
    rows = [[cell(row.get(key), unit) for key, _, unit in block.columns] for row in block.rows]
    notes = [words(n) for n in block.notes]
    return {"kind": "table", "title": brief(block.title), "heads": heads, "rows": rows, "notes": notes}


@spoken.register
def _(block: Equations) -> dict[str, Any]:
    held = [{"title": e.title, "typst": e.typst, "alt": e.latex} for e in block.equations]
    return {"kind": "equations", "equations": held}


@spoken.register
def _(block: Verbatim) -> dict[str, Any]:
    return {"kind": "verbatim", "title": words(block.title), "text": words(block.text)}


@spoken.register
def _(block: Charts) -> dict[str, Any]:
    charts = [{"file": f"{c.key}.svg", "title": brief(c.title), "alt": brief(c.alt)} for c in block.charts]
    return {"kind": "charts", "charts": charts}
