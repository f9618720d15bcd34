"""A record with its words replaced by hostile ones."""

from __future__ import annotations

from itertools import cycle
from typing import Any

from intermit.reports import Record
from synthetic_record import thaw

SPOKEN = (
    {
        "label",
        "title",
        "statement",
        "summary",
        "reason",
        "next_step",
        "source",
        "description",
        "note",
        "notes",
        "text",
    }
    | {
        "unit",
        "recheck",
        "coverage",
        "bound_name",
        "profile",
        "terminal",
        "alt",
        "code",
        "command",
        "author",
        "date",
    }
    | {"scenario_name", "scenario_text", "key", "sentence", "law", "equations", "details", "options"}
)


NAMED_FREELY = frozenset({"values", "details", "options", "seeds", "versions"})


def respoken(record: Record, *texts: str) -> Record:
    """The same record with every free text and free name replaced by `texts`, in turn."""
    turn = cycle(texts)

    def walk(value: Any, key: str) -> Any:
        if isinstance(value, dict):
            if key == "arrays":
                return value
            if key in NAMED_FREELY:
                return dict.fromkeys([next(turn)], walk(next(iter(value.values()), ""), key)) if value else {}
            return {k: walk(v, k) for k, v in value.items()}
        if isinstance(value, list):
            return [walk(v, key) for v in value]
        return next(turn) if isinstance(value, str) and key in SPOKEN else value

    document = thaw(record.document)
    sections = walk(document["sections"], "")
    for k in ("comparison", "audit"):  # a column's key ties it to its cells
        for t in sections[k]["tables"]:
            originals = [c["key"] for c in document["sections"][k]["tables"][0]["columns"]]
            for c, original in zip(t["columns"], originals, strict=True):
                c["key"] = original
    for entry in sections["cases"]:
        entry["equations"] = [{"title": next(turn), "typst": next(turn), "latex": next(turn)}]
    return Record.create(
        title=next(turn),
        provenance=walk(document["provenance"], ""),
        sections=sections,
        arrays=record.arrays,
        outcome={"exit_code": 1, "sentence": next(turn)},
    )
