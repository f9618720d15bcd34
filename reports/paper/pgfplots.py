"""Charts as pgfplots: a `.tex` a paper can restyle and a `.dat` with the numbers beside it."""

from __future__ import annotations

import numpy as np

from ..content.blocks import Axis, Chart, Line
from ..content.budget import thin
from ..content.wording import short
from .latex import text, unit

POINTS = 1500
"""Values per figure: TeX reads each one."""
COLOURS = ((0, 114, 178), (213, 94, 0), (0, 158, 115), (170, 51, 119))
DASHES = ("solid", "dotted", "dashdotted", "loosely dashed")


def plots(chart: Chart, folder: str) -> dict[str, str]:
    """Write "<key>.tex" and one "<key>-<n>.dat" per series, which it will look for in `folder`."""
    (thinned,) = thin([chart], POINTS)
    files: dict[str, str] = {}
    body = []
    for i, line in enumerate(thinned.lines):
        name = f"{chart.key}-{i + 1}.dat"
        files[name] = _data(line, log_y=chart.y.log)
        body.append(_plot(line, f"{folder}/{name}"))
    legend = [rf"\addlegendentry{{{text(short(line.label))}}}" for line in thinned.lines]
    lines = [p + "\n" + entry if len(legend) > 1 else p for p, entry in zip(body, legend, strict=True)]
    options = [
        "width=\\linewidth",
        "height=0.66\\linewidth",
        f"xlabel={{{_label(chart.x)}}}",
        f"ylabel={{{_label(chart.y)}}}",
        "xmode=log" if chart.x.log else "xmode=linear",
        "ymode=log" if chart.y.log else "ymode=linear",
        "enlarge x limits=0.01",
        "axis on top=false",
        "legend style={font=\\scriptsize,draw=none,fill=none,at={(0.5,-0.28)},anchor=north}",
        f"legend columns={1 if max((len(s.label) for s in chart.lines), default=0) > 16 else 2}",
        "label style={font=\\small}",
        "tick label style={font=\\scriptsize}",
    ]
    if chart.reach is not None and not chart.y.log:
        options += [f"ymin={chart.reach[0]:.9g}", f"ymax={chart.reach[1]:.9g}"]
    shade = "\n".join(_window(on, off) for on, off in chart.windows)
    head = "% needs pgfplots (compat 1.9 or later)\n\\begin{tikzpicture}\n\\begin{axis}[\n  "
    foot = "\\end{axis}\n\\end{tikzpicture}\n"
    files[f"{chart.key}.tex"] = "\n".join([head + ",\n  ".join(options) + "]", shade, *lines, foot])
    return files


def _label(axis: Axis) -> str:
    return text(short(axis.label)) + (f" (${unit(short(axis.unit, 24))}$)" if axis.unit else "")


def _window(on: float, off: float) -> str:
    low, high = (f"({{axis cs:{x:.9g},0}}|-{{rel axis cs:0,{y}}})" for x, y in ((on, 0), (off, 1)))
    return rf"\fill[black!8] {low} rectangle {high};"


def _plot(line: Line, path: str) -> str:
    red, green, blue = COLOURS[line.colour % len(COLOURS)]
    colour = f"{{rgb,255:red,{red};green,{green};blue,{blue}}}"
    dash = "dashed" if line.dashed else DASHES[(line.colour // len(COLOURS)) % len(DASHES)]
    look = {
        "bars": f"ybar interval,draw=none,fill={colour}",
        "points": f"only marks,mark=*,mark size=0.7pt,color={colour}",
        "line+points": f"mark=*,mark size=1.2pt,{dash},color={colour}",
        "step": f"const plot,no marks,{dash},color={colour}",
        "band": f"no marks,draw=none,fill={colour},fill opacity=0.3",
    }.get(line.style, f"no marks,{dash},color={colour}")
    return rf"\addplot[{look}] table {{{path}}};"


def _data(line: Line, *, log_y: bool) -> str:
    x, y = line.x, line.y
    if line.style == "bars":
        y = np.append(y, y[-1])
    if line.style == "band" and line.upper is not None:
        x, y = np.concatenate([x, x[::-1]]), np.concatenate([y, line.upper[::-1]])
    return "x y\n" + "".join(
        f"{a:.7g} {_value(b, log_y)}\n" for a, b in zip(x.tolist(), y.tolist(), strict=True)
    )


def _value(y: float, log: bool) -> str:
    return "nan" if not np.isfinite(y) or (log and y <= 0) else f"{y:.7g}"
