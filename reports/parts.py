"""Small builders for the pieces of a record: what a study writes, in one line each.

They only arrange; `Record.create` checks.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any, Literal

Side = Literal["both", "lower", "upper"]
Style = Literal["line", "points", "line+points", "step", "band", "bars"]


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
) -> dict[str, Any]:
    """Build a number known to lie in [low, high]; one value given means low = high = exact.

    `side` "lower" says only that the true value is >= low (a certified lower bound: shown rounded
    down), "upper" only that it is <= high (shown rounded up). None: not available (say why in `note`).
    """
    out: dict[str, Any] = {"name": name, "low": low, "high": low if high is None else high, "unit": unit}
    out |= {"label": label or name.replace("_", " "), "rigorous": rigorous, "side": side}
    return out | ({"note": note} if note else {})


def figure_of(
    name: str, value: float | None, *, digits: int, unit: str = "", label: str = ""
) -> dict[str, Any]:
    """Build an ordinary floating-point figure good to `digits` significant digits."""
    if value is None:
        return quantity(name, None, unit=unit, label=label)
    spread = abs(value) * 0.5 * 10.0 ** (1 - digits)
    return quantity(name, value - spread, value + spread, unit=unit, label=label)


def column(key: str, label: str, unit: str = "") -> dict[str, Any]:
    """Build a table column."""
    return {"key": key, "label": label, "unit": unit}


def table(
    key: str,
    title: str,
    columns: Sequence[Mapping[str, Any]],
    rows: Sequence[Mapping[str, Any]],
    *,
    notes: Sequence[str] = (),
) -> dict[str, Any]:
    """Build a table; a cell is text, None, a quantity, {"verdict": ...} or {"code": ...}."""
    return {"key": key, "title": title, "columns": list(columns), "rows": list(rows), "notes": list(notes)}


def axis(label: str, unit: str = "", *, log: bool = False) -> dict[str, Any]:
    """Build a figure's axis."""
    return {"label": label, "unit": unit, "log": log}


def series(
    label: str, x: str, y: str, *, style: Style = "line", role: str = "", upper: str = ""
) -> dict[str, Any]:
    """Build one series of a figure from array names; a band needs `upper`."""
    out: dict[str, Any] = {"label": label, "x": x, "y": y, "style": style}
    return out | ({"role": role} if role else {}) | ({"upper": upper} if upper else {})


def figure(
    key: str,
    title: str,
    x: Mapping[str, Any],
    y: Mapping[str, Any],
    lines: Sequence[Mapping[str, Any]],
    *,
    alt: str,
    windows: bool = False,
    notes: Sequence[str] = (),
) -> dict[str, Any]:
    """Build a figure; `alt` says in one sentence what it shows."""
    out = {"key": key, "title": title, "x": dict(x), "y": dict(y), "series": list(lines), "alt": alt}
    return out | {"windows": windows, "notes": list(notes)}
