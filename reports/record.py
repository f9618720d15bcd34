"""The record: everything found in one study, from which every page is made.

A record is two files side by side, `results.json` (a document described by
`schema/record.schema.json`) and `results.npz` (the arrays it names). The same study gives the
same bytes: keys are sorted, floats are written shortest, nothing is timed and no clock is read.
"""

from __future__ import annotations

import hashlib
import io
import json
import zipfile
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..errors import InputError
from .structure import faults
from .values import freeze, plain, thaw
from .whole_files import write_whole

FORMAT = "intermit-record"
VERSION = 1
DOCUMENT_NAME = "results.json"
ARRAYS_NAME = "results.npz"

Array = NDArray[np.float64]


class RecordError(InputError):
    """The record does not have the form its schema demands, or its files do not belong together."""


@final
@dataclass(frozen=True)
class Record:
    """One study's findings, immutable.

    Attributes
    ----------
    document : Mapping
        The JSON document, read-only: mappings, tuples, text, numbers. `format`, `version`, `title`,
        `provenance`, `sections` and `arrays` (shape and sha256 by name).
    arrays : Mapping of str to ndarray
        Read-only float64 arrays by name, in SI units.
    """

    document: Mapping[str, Any]
    arrays: Mapping[str, Array]

    @classmethod
    def create(
        cls,
        *,
        title: str,
        provenance: Mapping[str, Any],
        sections: Mapping[str, Any],
        arrays: Mapping[str, ArrayLike] | None = None,
        outcome: Mapping[str, Any] | None = None,
    ) -> Record:
        """Normalise, check and freeze a study's findings.

        Raises
        ------
        RecordError
            If the document departs from the schema, names an array that is not given, or an array
            is not named anywhere.
        """
        held = {str(name): _frozen_array(name, value) for name, value in (arrays or {}).items()}
        document: dict[str, Any] = {
            "format": FORMAT,
            "version": VERSION,
            "title": title,
            "provenance": dict(provenance),
            "sections": dict(sections),
            "arrays": {name: _describe(value) for name, value in held.items()},
        }
        if outcome is not None:
            document["outcome"] = dict(outcome)
        document = plain(document)
        _check(document, held)
        return cls(freeze(document), freeze(held))

    @property
    def sections(self) -> Mapping[str, Any]:
        """The sections that were filled in."""
        sections: Mapping[str, Any] = self.document["sections"]
        return sections

    def array(self, name: str) -> Array:
        """One array by the name the document uses."""
        return self.arrays[name]

    def to_json(self) -> str:
        """Write the document as text: sorted keys, shortest floats, a newline at the end."""
        return (
            json.dumps(thaw(self.document), sort_keys=True, indent=1, ensure_ascii=False, allow_nan=False)
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
    arrays = _read_arrays(source.with_suffix(".npz"), bool(document.get("arrays")))
    _check(document, arrays)
    return Record(freeze(document), freeze(arrays))


def array_names(document: Mapping[str, Any]) -> Iterator[tuple[str, str]]:
    """Every (path, array name) the document's sections refer to."""
    yield from _names(document["sections"], "sections")


_SERIES_KEYS = {"x", "y", "upper"}


def _names(value: Any, where: str) -> Iterator[tuple[str, str]]:
    if isinstance(value, Mapping):
        for key, item in value.items():
            here = f"{where}.{key}"
            if key == "arrays" or (key == "histogram" and isinstance(item, Mapping)):
                yield from _strings(item, here)
            elif key == "series":
                for i, one in enumerate(item):
                    yield from ((f"{here}[{i}].{k}", one[k]) for k in sorted(_SERIES_KEYS & set(one)))
            else:
                yield from _names(item, here)
    elif isinstance(value, (list, tuple)):
        for i, item in enumerate(value):
            yield from _names(item, f"{where}[{i}]")


def _strings(value: Any, where: str) -> Iterator[tuple[str, str]]:
    for key, item in value.items():
        if key in {"label", "unit"}:
            continue
        if isinstance(item, str):
            yield f"{where}.{key}", item
        elif isinstance(item, Mapping):
            yield from _strings(item, f"{where}.{key}")


def _check(document: dict[str, Any], arrays: Mapping[str, Array]) -> None:
    problems = list(faults(document))
    if problems:
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        raise RecordError(problems[0] + more)
    index = document["arrays"]
    if set(index) != set(arrays):
        odd = sorted(set(index) ^ set(arrays))
        raise RecordError(
            f"the document and the array file do not belong together: {odd[0]!r} is in one only"
        )
    for name, value in arrays.items():
        if index[name] != _describe(value):
            raise RecordError(f"array {name!r} is not the one the document was written with")
    used = set()
    for where, name in array_names(document):
        if name not in arrays:
            raise RecordError(f"{where}: no array is called {name!r}")
        used.add(name)
    if unused := sorted(set(arrays) - used):
        raise RecordError(f"array {unused[0]!r} is not named by any section")
    _check_lengths(document["sections"], arrays, "sections")


def _check_lengths(value: Any, arrays: Mapping[str, Array], where: str) -> None:
    """Every array beside a `time` has as many rows; x and y of a series are equally long."""
    if isinstance(value, dict):
        roles = value.get("arrays")
        if isinstance(roles, dict) and "time" in roles:
            rows = len(arrays[roles["time"]])
            for here, name in _strings({k: v for k, v in roles.items() if k != "knots"}, f"{where}.arrays"):
                if len(arrays[name]) != rows:
                    raise RecordError(f"{here}: {len(arrays[name])} rows beside {rows} times")
        if {"x", "y", "label"} <= set(value) and isinstance(value["x"], str):
            lengths = {len(arrays[value[k]]) for k in _SERIES_KEYS & set(value)}
            if len(lengths) > 1 and value.get("style") not in {"bars", "step"}:
                raise RecordError(f"{where}: x and y have different lengths")
        for key, item in value.items():
            _check_lengths(item, arrays, f"{where}.{key}")
    elif isinstance(value, list):
        for i, item in enumerate(value):
            _check_lengths(item, arrays, f"{where}[{i}]")


def _frozen_array(name: str, value: ArrayLike) -> Array:
    array = np.array(value, dtype="<f8", order="C", copy=True)
    if array.ndim == 0 or not np.all(np.isfinite(array) | np.isposinf(array)):
        raise RecordError(f"array {name!r}: expected at least one dimension and no NaN or -inf")
    array.setflags(write=False)
    return array


def _describe(value: Array) -> dict[str, Any]:
    return {"shape": list(value.shape), "sha256": hashlib.sha256(value.tobytes()).hexdigest()}


def arrays_bytes(arrays: Mapping[str, Array]) -> bytes:
    """Pack the .npz file: sorted names, fixed dates, so that the same arrays give the same bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for name in sorted(arrays):
            entry = io.BytesIO()
            np.lib.format.write_array(entry, np.asarray(arrays[name]), version=(1, 0), allow_pickle=False)
            info = zipfile.ZipInfo(f"{name}.npy")
            info.external_attr = 0o644 << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, entry.getvalue())
    return buffer.getvalue()


def _read_arrays(path: Path, wanted: bool) -> dict[str, Array]:
    if not wanted and not path.exists():
        return {}
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            return {name: _frozen_array(name, stored[name]) for name in stored.files}
    except OSError as error:
        raise RecordError(f"{path}: the record's arrays cannot be read; keep both files together") from error
    except (ValueError, KeyError, zipfile.BadZipFile) as error:
        raise RecordError(f"{path}: not the arrays of a record ({error})") from error


def _refuse_constant(name: str) -> float:
    raise ValueError(f"{name} is not JSON")
