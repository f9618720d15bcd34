"""One record out of several about the same scenario: what a check, an optimum and a comparison found."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from .record import Array, Record, RecordError
from .record.values import thaw


def join(
    records: Sequence[Record], *, title: str, command: str = "", date: str = "", author: str = ""
) -> Record:
    """Join records of the same input.

    Sections that are lists are put one after the other; `scenario` and `schedule` come from the first
    record that has them; seeds, options and versions are gathered; the outcome is the first record's.

    Raises
    ------
    RecordError
        If the inputs differ, two records fill the same section in different ways, or give one array
        name to different arrays.
    """
    first = records[0].document
    hashes = {r.document["provenance"]["input_sha256"] for r in records}
    if len(hashes) > 1:
        raise RecordError("records of different inputs cannot be joined")
    sections: dict[str, Any] = {}
    arrays: dict[str, Array] = {}
    for record in records:
        _add_sections(sections, thaw(record.document["sections"]))
        for name, value in record.arrays.items():
            if name in arrays and not np.array_equal(arrays[name], value):
                raise RecordError(f"two records call different arrays {name!r}")
            arrays[name] = value
    origin = _origin([thaw(r.document["provenance"]) for r in records])
    origin |= {
        key: value for key, value in (("command", command), ("date", date), ("author", author)) if value
    }
    outcome = thaw(first["outcome"]) if "outcome" in first else None
    return Record.create(title=title, provenance=origin, sections=sections, arrays=arrays, outcome=outcome)


def _add_sections(sections: dict[str, Any], more: Mapping[str, Any]) -> None:
    for key, value in more.items():
        if isinstance(value, list):
            sections[key] = [*sections.get(key, []), *value]
        elif key not in sections:
            sections[key] = value
        elif key not in {"scenario", "schedule"} and sections[key] != value:
            raise RecordError(f"two records fill the section {key!r}")


def _origin(origins: Sequence[dict[str, Any]]) -> dict[str, Any]:
    joined = dict(origins[0])
    for key in ("versions", "seeds", "options"):
        joined[key] = {k: v for origin in reversed(origins) for k, v in origin[key].items()}
    joined["effort"] = [e for origin in origins for e in origin.get("effort", [])]
    return joined
