"""One record out of several about the same scenario: what a check, an optimum and a comparison found."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np

from .record import Array, Record, RecordError
from .record.document import Provenance, Sections


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
    if len({r.provenance.input_sha256 for r in records}) > 1:
        raise RecordError("records of different inputs cannot be joined")
    arrays: dict[str, Array] = {}
    for record in records:
        for name, value in record.arrays.items():
            if name in arrays and not np.array_equal(arrays[name], value):
                raise RecordError(f"two records call different arrays {name!r}")
            arrays[name] = value
    given = {"command": command, "date": date, "author": author}
    origin = _origin([r.provenance for r in records]).but(**{k: v for k, v in given.items() if v})
    sections = _sections([r.sections for r in records])
    return Record.create(
        title=title, provenance=origin, sections=sections, arrays=arrays, outcome=records[0].outcome
    )


def _sections(all_sections: Sequence[Sections]) -> Sections:
    found: dict[str, object] = {}
    for sections in all_sections:
        for key, value in sections.given().items():
            held = found.get(key)
            if isinstance(held, tuple):
                found[key] = (*held, *value)
            elif held is None:
                found[key] = value
            elif key not in {"scenario", "schedule"} and held != value:
                raise RecordError(f"two records fill the section {key!r}")
    return Sections.model_validate(found)


def _origin(origins: Sequence[Provenance]) -> Provenance:
    """The first one's, with the versions, seeds, options and effort of all; the first to say one counts."""
    backwards = origins[::-1]
    return origins[0].but(
        versions={k: v for origin in backwards for k, v in origin.versions.items()},
        seeds={k: v for origin in backwards for k, v in origin.seeds.items()},
        options={k: v for origin in backwards for k, v in origin.options.items()},
        effort=tuple(e for origin in origins for e in origin.effort),
    )
