"""Blocks as plain data for the PDF's template: every text made drawable, every long name marked."""

from __future__ import annotations

from collections.abc import Mapping
from functools import singledispatch
from typing import Any

from ..content.blocks import (
    Block,
    Cards,
    Cell,
    Charts,
    ClaimDetails,
    Equations,
    Facts,
    MatrixCell,
    Replay,
    Table,
    Text,
    Verbatim,
    Verdicts,
)
from ..content.escape import directed, printable
from ..content.figures import LEGEND_LONGEST
from ..content.names import LONGEST, FullNames
from ..content.studies import values_text
from ..content.verdicts import claim_numbers, refutation
from ..content.wording import json_text, shares, short
from ..numbers import number, unit_text, write
from ..record.claims import ClaimEntry, QuantityEntry
from ..record.tables import CodeCell, VerdictCell

BREAK_EVERY = 16
"""Characters of an unbroken word after which a line may break."""


def words(text: str) -> str:
    """Text as the PDF sets it: drawable, in its own direction, breakable inside long words."""
    return directed("".join(_breakable(w) for w in _split(printable(text))))


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


def cell(value: Cell, column_unit: str = "") -> dict[str, object]:
    """One cell: its text and how it is set."""
    if value is None:
        return {"text": "–"}
    if isinstance(value, str):
        return {"text": words(value)}
    if isinstance(value, VerdictCell):
        return {"verdict": value.verdict, "text": ""}
    if isinstance(value, CodeCell):
        return {"code": words(value.code)}
    if isinstance(value, MatrixCell):
        return {
            "matrix": [[number(x, 12) for x in row] for row in value.matrix],
            "text": words(unit_text(value.unit)),
        }
    written = write(value, unit=not column_unit or column_unit != value.unit)
    digits, unit = written.digits_and_unit
    return {
        "text": words(" ".join(part.replace(" ", "\u00a0") for part in (digits, unit) if part)),
        "rigorous": written.rigorous and not written.missing,
    }


@singledispatch
def spoken(block: Block, names: FullNames) -> dict[str, object] | None:
    """Turn a block into data for the template; the replay has no place on paper."""
    del names
    raise TypeError(f"no rule to print a {type(block).__name__}")


@spoken.register
def _(block: Replay, names: FullNames) -> None:
    del block, names


@spoken.register
def _(block: Text, names: FullNames) -> dict[str, object]:
    return {"kind": "text", "text": words(names.within(block.text)), "style": block.kind}


@spoken.register
def _(block: Cards, names: FullNames) -> dict[str, object]:
    labels = {q.name: words(names.brief(q.words)) for c in block.cards for q in c.numbers}
    rows = []
    for card in block.cards:
        held = {q.name: cell(q) for q in card.numbers}
        counts = ", ".join(f"{n} {v}" for v, n in card.verdicts)
        cells = [held.get(n, {"text": "–"}) for n in labels]
        rows.append({"label": words(names.brief(card.label)), "counts": counts, "cells": cells})
    return {"kind": "cards", "names": list(labels.values()), "rows": rows}


@spoken.register
def _(block: Verdicts, names: FullNames) -> dict[str, object]:
    groups = [
        {"label": words(names.brief(g.label)), "claims": [_claim(c, names) for _, c in held]}
        for g in block.groups
        if (held := g.entries(counted=block.counted))
    ]
    return {"summary": words(block.summary), "kind": "verdicts", "groups": groups}


def _claim(claim: ClaimEntry, names: FullNames) -> dict[str, object]:
    def brief(text: str) -> str:
        return words(names.brief(text))

    why = claim.reason if claim.verdict == "UNDECIDED" else ""
    if claim.witness is not None:
        why = f"refuted: {refutation(claim)}"
    return {
        "title": brief(claim.title),
        "statement": brief(claim.statement),
        "verdict": claim.verdict,
        "margins": [[brief(q.words), cell(q)] for q in claim_numbers(claim)],
        "evidence": [[e.kind, brief(e.summary)] for e in claim.evidence],
        "why": brief(why),
        "recheck": brief(claim.recheck or ""),
        "source": brief(claim.source),
    }


@spoken.register
def _(block: ClaimDetails, names: FullNames) -> dict[str, object]:
    groups = [
        {"label": words(names.brief(g.label)), "claims": [_details(c, names) for c in g.claims]}
        for g in block.groups
    ]
    return {"kind": "details", "groups": groups}


def _details(claim: ClaimEntry, names: FullNames) -> dict[str, object]:
    rows: list[tuple[str, dict[str, object]]] = [("Key", {"code": words(claim.key)})]
    rows += [(_label(q, names), cell(q)) for q in claim.quantities]
    rows += [("Margin: " + _label(q, names), cell(q)) for q in claim.margins]
    for e in claim.evidence:
        source = f" ({e.source})" if e.source else ""
        rows.append((f"Evidence: {e.kind}", {"text": words(e.summary + source)}))
        rows += [
            ("  " + words(names.brief(k)), {"code": words(json_text(v))})
            for k, v in sorted(e.details.items())
        ]
    if claim.witness is not None:
        witness = claim.witness
        rows.append(("Witness", {"text": words(witness.description)}))
        rows += [
            ("  " + words(names.brief(k)), {"code": words(values_text(v))})
            for k, v in sorted(witness.values.items())
        ]
        rows.append(("  " + _label(witness.violation, names, "violation"), cell(witness.violation)))
    said = (("Why", claim.reason), ("Next step", claim.next_step), ("Source", claim.source))
    rows += [
        (label, {"text": words(text)}) for label, text in (*said, ("Check again", claim.recheck)) if text
    ]
    return {
        "title": words(names.brief(claim.title)),
        "verdict": claim.verdict,
        "statement": words(names.within(claim.statement)),
        "rows": rows,
    }


def _label(quantity: QuantityEntry, names: FullNames, otherwise: str = "") -> str:
    return words(names.brief(quantity.label or otherwise or quantity.name))


@spoken.register
def _(block: Facts, names: FullNames) -> dict[str, object]:
    rows = [[words(names.brief(label)), cell(v)] for label, v in block.rows]
    return {"kind": "facts", "title": words(names.brief(block.title)), "rows": rows}


@spoken.register
def _(block: Table, names: FullNames) -> dict[str, object]:
    heads = [
        words(names.brief(label)) + (f" ({words(names.brief(unit_text(unit), 40))})" if unit else "")
        for _, label, unit in block.columns
    ]
    rows = [[_table_cell(row.get(key), unit, names) for key, _, unit in block.columns] for row in block.rows]
    title, notes = words(names.brief(block.title)), [words(n) for n in block.notes]
    lengths = [
        [2 + max(map(len, (*head.split(), ""))), *(_length(row[i]) for row in rows)]
        for i, head in enumerate(heads)
    ]
    widths = [round(s, 4) for s in shares(lengths)]
    return {"kind": "table", "title": title, "heads": heads, "rows": rows, "notes": notes, "widths": widths}


def _length(shown: Mapping[str, Any]) -> int:
    """Characters a cell would like to have side by side."""
    code = shown.get("code", "")
    badge = f"{shown['verdict']}.........." if "verdict" in shown else ""
    return len(badge) + len(shown.get("text", "")) + len(code) * 5 // 4


def _table_cell(value: Cell, unit: str, names: FullNames) -> dict[str, object]:
    """Set a cell of a narrow column: a long text is marked."""
    if isinstance(value, str):
        return {"text": words(names.brief(value))}
    if isinstance(value, CodeCell):
        return {"code": words(names.brief(value.code))}
    return cell(value, unit)


@spoken.register
def _(block: Equations, names: FullNames) -> dict[str, object]:
    del names
    held = [{"title": e.title, "typst": e.typst, "alt": e.latex} for e in block.equations]
    return {"kind": "equations", "equations": held}


@spoken.register
def _(block: Verbatim, names: FullNames) -> dict[str, object]:
    return {"kind": "verbatim", "title": words(names.brief(block.title)), "text": words(block.text)}


@spoken.register
def _(block: Charts, names: FullNames) -> dict[str, object]:
    charts = [
        {
            "file": f"{c.key}.svg",
            "title": words(names.brief(c.title)),
            "alt": words(short(c.alt, LONGEST)),
            "cut": [words(n) for n in names.of_chart(c, LEGEND_LONGEST)],
        }
        for c in block.charts
    ]
    return {"kind": "charts", "charts": charts}
