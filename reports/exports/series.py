"""One CSV and one .mat variable for each group of arrays that share a time axis."""

from __future__ import annotations

import io
from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

import numpy as np

from ..content.wording import short, slug
from ..record import Array, Record
from ..record.base import Part, unit_of
from .matfile import mat_bytes

STATE_UNITS = {"R": "s", "k": "1/s"}
"""Units of controller states that have one; the others are the law's own."""


@final
@dataclass(frozen=True)
class Series:
    """Columns over one time axis: `columns` are (name, unit, values)."""

    name: str
    title: str
    columns: tuple[tuple[str, str, Array], ...]


def export_files(record: Record) -> dict[str, bytes]:
    """Write "series/<name>.csv" for each group and "series.mat" with all of them."""
    groups = tuple(series_of(record))
    files = {f"series/{s.name}.csv": csv_bytes(s) for s in groups}
    if groups:
        held = {s.name.replace("-", "_"): {n: v for n, _, v in s.columns} for s in groups}
        files["series.mat"] = mat_bytes(held)
    return files


def series_of(record: Record) -> Iterator[Series]:
    """Every group of arrays beside a time, in the record's order."""
    sections = record.sections
    if sections.schedule is not None:
        yield _series(record, "schedule", "schedule", sections.schedule.arrays)
    for i, case in enumerate(sections.cases):
        for j, run in enumerate(case.runs):
            name = f"run-{i + 1}-{j + 1}-{slug(case.label, 0).removesuffix('-0')}"
            yield _series(record, name, f"{case.label}, {run.label}", run.arrays)
        for j, certificate in enumerate(case.certificates):
            if certificate.arrays is not None:
                name = f"certificate-{i + 1}-{j + 1}"
                yield _series(record, name, f"{case.label}, {certificate.label}", certificate.arrays)
    for i, entry in enumerate(sections.optimum):
        if entry.arrays is not None:
            yield _series(record, f"optimum-{i + 1}-{entry.norm}", entry.label, entry.arrays)


def _series(record: Record, name: str, title: str, arrays: Part) -> Series:
    held = arrays.array_names()
    roles = ["time", *(role for role in held if role != "time")]
    columns: list[tuple[str, str, Array]] = []
    taken: set[str] = set()
    for role in roles:
        values = record.array(held[role])
        field, _, state = role.partition(".")
        unit = STATE_UNITS.get(state, "") if state else unit_of(type(arrays), field)
        table = values.reshape(len(values), -1)
        for k in range(table.shape[1]):
            column = _identifier(state or field) + (f"_{k}" if table.shape[1] > 1 else "")
            while column in taken:
                column += "_"
            taken.add(column)
            columns.append((column, unit, table[:, k]))
    return Series(name, title, tuple(columns))


def _identifier(text: str) -> str:
    """Make a name every program takes: letters, digits, underscores, a letter first, 40 characters."""
    safe = "".join(c if c.isascii() and c.isalnum() else "_" for c in text)[:40]
    return safe if safe[:1].isalpha() else f"x{safe}"


def csv_bytes(series: Series) -> bytes:
    """Write a comment with the title, a head with units, then decimals that read back exactly."""
    title = short(series.title, 200).encode("ascii", "replace").decode()
    head = ",".join(f"{name} [{unit}]" if unit else name for name, unit, _ in series.columns)
    out = io.StringIO()
    out.write(f"# {title}\n{head}\n")
    rows = zip(*(np.asarray(values).tolist() for _, _, values in series.columns), strict=True)
    for row in rows:
        out.write(",".join(map(repr, row)) + "\n")
    return out.getvalue().encode("ascii")
