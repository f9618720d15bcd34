"""The record: everything found in one study, from which every page is made.

A record is two files side by side, `results.json` (a `Document`, whose classes are its schema) and
`results.npz` (the arrays it names). The same study gives the
same bytes: keys are sorted, floats are written shortest, nothing is timed and no clock is read.
"""

from __future__ import annotations

import hashlib
import json
from collections.abc import Mapping
from dataclasses import dataclass
from functools import cached_property
from pathlib import Path
from typing import Any, final

from numpy.typing import ArrayLike

from ..whole_files import write_whole
from .arrays import Array, RecordError, arrays_bytes, described, frozen_array, read_arrays
from .base import parts_of
from .document import FORMAT, VERSION, Document, Outcome, Provenance, Sections, read_document
from .tables import SeriesEntry
from .values import freeze, plain

DOCUMENT_NAME = "results.json"
ARRAYS_NAME = "results.npz"


@final
@dataclass(frozen=True)
class Record:
    """One study's findings, immutable.

    Attributes
    ----------
    content : Document
        Title, provenance, sections, outcome, and shape and sha256 of each array by name.
    arrays : Mapping of str to ndarray
        Read-only float64 arrays by name, in SI units.
    """

    content: Document
    arrays: Mapping[str, Array]

    @classmethod
    def create(
        cls,
        *,
        title: str,
        provenance: Provenance | Mapping[str, Any],
        sections: Sections | Mapping[str, Any],
        arrays: Mapping[str, ArrayLike] | None = None,
        outcome: Outcome | Mapping[str, Any] | None = None,
    ) -> Record:
        """Normalise, check and freeze a study's findings.

        Raises
        ------
        RecordError
            If the document departs from its form, names an array that is not given, or an array
            is not named anywhere.
        """
        held = {str(name): frozen_array(name, value) for name, value in (arrays or {}).items()}
        document: dict[str, Any] = {
            "format": FORMAT,
            "version": VERSION,
            "title": title,
            "provenance": provenance,
            "sections": sections,
            "arrays": {name: described(value) for name, value in held.items()},
        }
        if outcome is not None:
            document["outcome"] = outcome
        return cls(_checked(plain(document), held), freeze(held))

    @property
    def title(self) -> str:
        """What the study is called."""
        return self.content.title

    @property
    def provenance(self) -> Provenance:
        """Where the record comes from."""
        return self.content.provenance

    @property
    def sections(self) -> Sections:
        """What was found, section by section."""
        return self.content.sections

    @property
    def outcome(self) -> Outcome | None:
        """What the study came to; None for a part of a study."""
        return self.content.outcome

    @cached_property
    def document(self) -> Mapping[str, Any]:
        """The document as JSON values, read-only: mappings, tuples, text, numbers."""
        view: Mapping[str, Any] = freeze(plain(self.content))
        return view

    def array(self, name: str) -> Array:
        """One array by the name the document uses."""
        return self.arrays[name]

    def to_json(self) -> str:
        """Write the document as text: sorted keys, shortest floats, a newline at the end."""
        return (
            json.dumps(plain(self.content), sort_keys=True, indent=1, ensure_ascii=False, allow_nan=False)
            + "\n"
        )

    @property
    def sha256(self) -> str:
        """Hash of the document, which holds the hashes of the arrays: names the whole record."""
        return hashlib.sha256(self.to_json().encode()).hexdigest()


def write_record(record: Record, folder: str | Path) -> Path:
    """Write `results.json` and `results.npz` into an existing folder; returns the path of the first."""
    target = Path(folder) / DOCUMENT_NAME
    write_record_to(record, target)
    return target


def write_record_to(record: Record, path: str | Path) -> None:
    """Write the document to `path` and its arrays beside it, with the suffix .npz."""
    write_whole(Path(path).with_suffix(".npz"), arrays_bytes(record.arrays))
    write_whole(Path(path), record.to_json().encode())


def read_record(path: str | Path) -> Record:
    """Read a record from its `results.json` (or the folder that holds it) and check it.

    Raises
    ------
    RecordError
        If a file is missing, is not a record, is of another version, or the arrays are not the ones
        the document was written with.
    """
    source = Path(path)
    source = source / DOCUMENT_NAME if source.is_dir() else source
    try:
        document = json.loads(source.read_text(encoding="utf-8"), parse_constant=_refuse_constant)
    except OSError as error:
        raise RecordError(f"{source}: cannot be read ({error.strerror})") from error
    except (ValueError, RecursionError) as error:
        raise RecordError(f"{source}: not a record ({error})") from error
    if not isinstance(document, dict) or document.get("format") != FORMAT:
        raise RecordError(f"{source}: not a record of this package (its format is not {FORMAT!r})")
    if document.get("version") != VERSION:
        raise RecordError(
            f"{source}: record version {document.get('version')!r}, this package reads version {VERSION}; "
            "run the study again"
        )
    arrays = read_arrays(source.with_suffix(".npz"), bool(document.get("arrays")))
    try:
        return Record(_checked(document, arrays), freeze(arrays))
    except RecordError as error:
        made = document.get("provenance")
        by = made.get("package_version") if isinstance(made, dict) else None
        raise RecordError(
            f"{source}: {error}; the record was written by intermit {by or 'of an unknown version'} "
            f"(format version {VERSION}): write it again with this version"
        ) from None


def _checked(document: Mapping[str, Any], arrays: Mapping[str, Array]) -> Document:
    """Read a document and hold it against its arrays."""
    try:
        content = read_document(document)
    except ValueError as error:
        raise RecordError(str(error)) from None
    if set(content.arrays) != set(arrays):
        odd = sorted(set(content.arrays) ^ set(arrays))
        raise RecordError(
            f"the document and the array file do not belong together: {odd[0]!r} is in one only"
        )
    for name, value in arrays.items():
        if content.arrays[name] != described(value):
            raise RecordError(f"array {name!r} is not the one the document was written with")
    used: set[str] = set()
    for where, part in parts_of(content.sections, "record.sections"):
        names = part.array_names()
        for role, name in names.items():
            if name not in arrays:
                raise RecordError(f"{where}.{role}: no array is called {name!r}")
        used |= set(names.values())
        _check_lengths(part, {role: len(arrays[name]) for role, name in names.items()}, where)
    if unused := sorted(set(arrays) - used):
        raise RecordError(f"array {unused[0]!r} is not named by any section")
    return content


def _check_lengths(part: object, lengths: Mapping[str, int], where: str) -> None:
    """Every array beside a `time` has as many rows; x and y of a series are equally long."""
    rows = lengths.get("time")
    if rows is not None:
        for role, length in lengths.items():
            if length != rows:
                raise RecordError(f"{where}.{role}: {length} rows beside {rows} times")
    if isinstance(part, SeriesEntry) and part.style not in {"bars", "step"} and len({*lengths.values()}) > 1:
        raise RecordError(f"{where}: x and y have different lengths")


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is not JSON")
