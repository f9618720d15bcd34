"""Charts as plotly.js figures, written as plain mappings; arrays travel as base64 float32."""

from __future__ import annotations

import base64
from typing import Any

import numpy as np

from ..content.blocks import Array, Axis, Chart, Line
from ..content.ticks import log_ticks
from ..content.wording import short, visible
from ..numbers import unit_text

DASHES = ("solid", "dot", "dashdot", "longdash")
COLOURS = 4
"""Colours that pass contrast on both grounds; beyond them the dash changes."""


def escape(text: str, most: int = 60) -> str:
    """Text plotly.js shows as it is: it reads a little HTML and its entities."""
    return short(visible(text), most).replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def packed(values: Array) -> str:
    """Little-endian float32 as base64; values beyond its range become the largest it has."""
    limit = float(np.finfo(np.float32).max)
    return base64.b64encode(np.clip(values, -limit, limit).astype("<f4").tobytes()).decode("ascii")


def figure(chart: Chart) -> dict[str, object]:
    """One chart: traces, axes and windows; colours are indices the page resolves for its theme."""
    arrays: dict[int, str] = {}
    data: list[str] = []

    def place(values: Array) -> str:
        if id(values) not in arrays:
            arrays[id(values)] = str(len(data))
            data.append(packed(values))
        return arrays[id(values)]

    traces = [t for line in chart.lines for t in _traces(line, place)]
    y = _axis(chart.y)
    if chart.y.log and (ticks := log_ticks(chart)):
        y |= {"tickvals": list(ticks), "ticktext": [f"{t:g}" for t in ticks]}
    if chart.reach is not None and not chart.y.log:
        y["range"] = list(chart.reach)
    layout = {"xaxis": _axis(chart.x), "yaxis": y}
    return {
        "key": chart.key,
        "traces": traces,
        "layout": layout,
        "windows": [list(w) for w in chart.windows],
        "data": data,
        "timed": chart.x.label == "time",
    }


def _axis(axis: Axis) -> dict[str, object]:
    title = escape(axis.label) + (f" ({escape(unit_text(axis.unit))})" if axis.unit else "")
    return {"title": {"text": title}, "type": "log" if axis.log else "linear", "hoverformat": ".6~g"}


def _traces(line: Line, place: Any) -> list[dict[str, object]]:
    base = {"name": escape(line.label), "x": place(line.x), "colour": line.colour % COLOURS}
    dash = "dash" if line.dashed else DASHES[(line.colour // COLOURS) % len(DASHES)]
    if line.style == "bars":
        return [base | {"kind": "bars", "y": place(line.y)}]
    if line.style == "band" and line.upper is not None:
        lower = base | {"kind": "edge", "y": place(line.y), "dash": "solid"}
        return [lower, base | {"kind": "band", "y": place(line.upper), "dash": "solid"}]
    kind = {"points": "markers", "line+points": "lines+markers"}.get(line.style, "lines")
    shape = {"shape": "hv"} if line.style == "step" else {}
    return [base | {"kind": kind, "y": place(line.y), "dash": dash} | shape]
