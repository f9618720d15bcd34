"""One CSV and one .mat variable for each group of arrays that share a time axis."""

from __future__ import annotations

import io
from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Any, final

import numpy as np

from ..content.wording import short, slug
from ..record import Array, Record
from .matfile import mat_bytes

UNITS = {
    "time": "s",
    "rate": "rad/s",
    "error_rate": "rad/s",
    "command": "N m",
    "torque": "N m",
    "momentum": "N m s",
    "R": "s",
    "k": "1/s",
    "filter_floor": "s",
    "angle_bound": "rad",
    "rate_bound": "kg^1/2 m rad/s",
    "speed_bound": "rad/s",
    "storage": "kg m^2/s",
    "storage_rate": "kg m^2/s^2",
    "storage_bound": "kg m^2/s",
    "storage_rate_bound": "kg m^2/s^2",
    "torque_bound": "N m",
    "gain_rate": "1/s",
}
"""Units of the roles that have one; the others are dimensionless or the law's own."""


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
    sections = record.document["sections"]
    if "schedule" in sections:
        yield _series(record, "schedule", "schedule", sections["schedule"]["arrays"])
    for i, case in enumerate(sections.get("cases", ())):
        for j, run in enumerate(case.get("runs", ())):
            name = f"run-{i + 1}-{j + 1}-{slug(case['label'], 0).removesuffix('-0')}"
            yield _series(record, name, f"{case['label']}, {run['label']}", run["arrays"])
        for j, certificate in enumerate(case.get("certificates", ())):
            if "arrays" in certificate:
                name = f"certificate-{i + 1}-{j + 1}"
                yield _series(record, name, f"{case['label']}, {certificate['label']}", certificate["arrays"])
    for i, entry in enumerate(sections.get("optimum", ())):
        if "arrays" in entry:
            yield _series(record, f"optimum-{i + 1}-{entry['norm']}", entry["label"], entry["arrays"])


def _series(record: Record, name: str, title: str, roles: Mapping[str, Any]) -> Series:
    flat = {"time": roles["time"]}
    for role, value in roles.items():
        if isinstance(value, str):
            if role not in {"time", "knots"}:
                flat[role] = value
        else:
            flat |= dict(value)
    columns: list[tuple[str, str, Array]] = []
    taken: set[str] = set()
    for role, array_name in flat.items():
        values = record.array(array_name)
        table = values.reshape(len(values), -1)
        for k in range(table.shape[1]):
            column = _identifier(role) + (f"_{k}" if table.shape[1] > 1 else "")
            while column in taken:
                column += "_"
            taken.add(column)
            columns.append((column, UNITS.get(role, ""), table[:, k]))
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
