"""Small builders for the pieces of a record that studies write most: numbers, tables and figures."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from .record.claims import QuantityEntry, Side
from .record.tables import (
    AxisEntry,
    CellEntry,
    ColumnEntry,
    FigureEntry,
    Role,
    SeriesEntry,
    Style,
    TableEntry,
)


def quantity(
    name: str,
    low: float | None,
    high: float | None = None,
    *,
    unit: str = "",
    label: str = "",
    rigorous: bool = False,
    side: Side = "both",
    note: str = "",
) -> QuantityEntry:
    """Build a number known to lie in [low, high]; one value given means low = high = exact.

    `side` "lower" says only that the true value is >= low (a certified lower bound: shown rounded
    down), "upper" only that it is <= high (shown rounded up). None: not available (say why in `note`).
    """
    return QuantityEntry(
        name=name,
        low=low,
        high=low if high is None else high,
        unit=unit,
        label=label or name.replace("_", " "),
        rigorous=rigorous,
        side=side,
        note=note or None,
    )


def figure_of(
    name: str, value: float | None, *, digits: int, unit: str = "", label: str = ""
) -> QuantityEntry:
    """Build an ordinary floating-point figure good to `digits` significant digits."""
    if value is None:
        return quantity(name, None, unit=unit, label=label)
    spread = abs(value) * 0.5 * 10.0 ** (1 - digits)
    return quantity(name, value - spread, value + spread, unit=unit, label=label)


def column(key: str, label: str, unit: str = "") -> ColumnEntry:
    """Build a table column."""
    return ColumnEntry(key=key, label=label, unit=unit)


def table(
    key: str,
    title: str,
    columns: Sequence[ColumnEntry],
    rows: Sequence[Mapping[str, CellEntry]],
    *,
    notes: Sequence[str] = (),
) -> TableEntry:
    """Build a table; its rows map a column's key to text, None, a quantity, a verdict or a code."""
    cells = tuple(dict(row) for row in rows)
    return TableEntry(key=key, title=title, columns=tuple(columns), rows=cells, notes=tuple(notes))


def axis(label: str, unit: str = "", *, log: bool = False) -> AxisEntry:
    """Build a figure's axis."""
    return AxisEntry(label=label, unit=unit, log=log)


def series(
    label: str, x: str, y: str, *, style: Style = "line", role: Role | None = None, upper: str | None = None
) -> SeriesEntry:
    """Build one series of a figure from array names; a band needs `upper`."""
    return SeriesEntry(label=label, x=x, y=y, style=style, role=role, upper=upper)


def figure(
    key: str,
    title: str,
    x: AxisEntry,
    y: AxisEntry,
    lines: Sequence[SeriesEntry],
    *,
    alt: str,
    windows: bool = False,
    notes: Sequence[str] = (),
) -> FigureEntry:
    """Build a figure; `alt` says in one sentence what it shows."""
    return FigureEntry(
        key=key, title=title, x=x, y=y, series=tuple(lines), alt=alt, windows=windows, notes=tuple(notes)
    )
