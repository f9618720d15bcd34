"""Charts drawn by matplotlib as vector SVG and PDF, the same bytes every time."""

from __future__ import annotations

import io
import re
import tempfile
from collections.abc import Iterator, Mapping, Sequence
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..numbers import unit_text
from ..whole_files import write_whole
from .blocks import Axis, Chart, Line
from .escape import east_asian_font, font_names, printable
from .ticks import log_ticks
from .wording import short

LEGEND_LONGEST = 42
"""Characters of a name a legend or an axis has room for."""
COLOURS = ("#0072B2", "#D55E00", "#009E73", "#AA3377")
SHADE = "#DCE9E4"
DASHES: tuple[Any, ...] = ("-", ":", "-.", (0, (8, 2)))
SIZE = (3.4, 2.35)
"""Inches: one column of a two-column paper."""
LEFT, CHARACTER = 0.155, 0.02
"""Left edge of the axes and what one more character of a tick label needs, in figure widths."""
STYLE = {
    "font.size": 7.5,
    "axes.linewidth": 0.6,
    "axes.unicode_minus": True,
    "lines.linewidth": 1.0,
    "lines.markersize": 2.5,
    "legend.frameon": False,
    "legend.fontsize": 6.5,
    "grid.linewidth": 0.4,
    "grid.color": "#D5D9DD",
    "svg.fonttype": "path",
    "svg.hashsalt": "intermit",
    "pdf.fonttype": 42,
    "path.simplify": True,
}


@contextmanager
def style() -> Iterator[None]:
    """Use our own settings, whatever the user's matplotlibrc says, and give them back after."""
    import matplotlib

    with matplotlib.rc_context():
        matplotlib.rcdefaults()
        settings: Any = matplotlib.rcParams
        settings.update(STYLE | {"font.family": _families()})
        yield


def _families() -> list[str]:
    from matplotlib import font_manager

    further = east_asian_font()
    if further and str(further) not in {f.fname for f in font_manager.fontManager.ttflist}:
        font_manager.fontManager.addfont(str(further))
    return list(font_names())


def drawings(charts: Sequence[Chart]) -> dict[str, bytes]:
    """Draw each chart as "<key>.svg"; text becomes outlines, so no font is needed to show it."""
    from matplotlib.backends.backend_svg import FigureCanvasSVG

    out: dict[str, bytes] = {}
    with style():
        for chart in charts:
            buffer = io.BytesIO()
            canvas: Any = FigureCanvasSVG(_figure(chart))
            canvas.print_svg(buffer, metadata={"Date": None, "Creator": None})
            out[f"{chart.key}.svg"] = buffer.getvalue()
    return out


def pdf_figures(svgs: Mapping[str, bytes]) -> dict[str, bytes]:
    """Turn each "<key>.svg" into "<key>.pdf" of the same size (PDF 1.4, which every LaTeX takes)."""
    import typst

    page = "#set page(width: auto, height: auto, margin: 0pt, fill: none)\n"
    options: Any = {"pdf_standards": "1.4", "pdf_tags": False, "ignore_system_fonts": True}
    out: dict[str, bytes] = {}
    with tempfile.TemporaryDirectory() as folder:
        source = Path(folder) / "figure.typ"
        write_whole(source, page + '#image("drawing.svg")')
        for name, svg in svgs.items():
            write_whole(Path(folder) / "drawing.svg", svg)
            out[name.removesuffix(".svg") + ".pdf"] = typst.compile(
                source, root=folder, format="pdf", timestamp=0, **options
            )
    return out


def _figure(chart: Chart) -> Any:
    from matplotlib.figure import Figure

    figure = Figure(figsize=SIZE)
    labels = _legend(chart)
    rows = -(-len(labels) // _columns(labels))
    bottom = 0.175 + 0.062 * rows
    axes = figure.add_axes((LEFT, bottom, 0.975 - LEFT, 0.965 - bottom))
    handles = draw_chart(axes, chart)
    _make_room(axes, bottom)
    if labels:
        _add_legend(figure, handles, labels)
    return figure


def draw_chart(axes: Any, chart: Chart) -> list[Any]:
    """Draw a chart's lines, windows and axis names on matplotlib axes; a handle a line, for a legend."""
    axes.grid(visible=True)
    axes.set_axisbelow(True)
    for side in ("top", "right"):
        axes.spines[side].set_visible(False)
    handles = [_draw(axes, line) for line in chart.lines]
    if chart.windows:
        spans = [(on, off - on) for on, off in chart.windows]
        edges = axes.get_xlim()
        axes.broken_barh(
            spans, (0, 1), transform=axes.get_xaxis_transform(), color=SHADE, zorder=0, linewidth=0
        )
        axes.set_xlim(edges)
    _scale(axes, chart)
    _name(axes.set_xlabel, chart.x)
    _name(axes.set_ylabel, chart.y)
    return handles


def _draw(axes: Any, line: Line) -> Any:
    colour = COLOURS[line.colour % len(COLOURS)]
    dash = "--" if line.dashed else DASHES[(line.colour // len(COLOURS)) % len(DASHES)]
    if line.style == "bars":
        return axes.stairs(line.y, line.x, fill=True, color=colour)
    if line.style == "band" and line.upper is not None:
        return axes.fill_between(line.x, line.y, line.upper, color=colour, alpha=0.3, linewidth=0)
    marker = "o" if "points" in line.style else ""
    kind = "none" if line.style == "points" else dash
    drawstyle = "steps-post" if line.style == "step" else "default"
    return axes.plot(line.x, line.y, color=colour, linestyle=kind, marker=marker, drawstyle=drawstyle)[0]


def _scale(axes: Any, chart: Chart) -> None:
    for axis, name in ((chart.x, "x"), (chart.y, "y")):
        if axis.log:
            getattr(axes, f"set_{name}scale")("log")
    ticks = log_ticks(chart) if chart.y.log else ()
    if ticks:
        axes.set_yticks(ticks, [f"{t:g}" for t in ticks])
        axes.minorticks_off()
    if chart.reach is not None and not chart.y.log:
        axes.set_ylim(chart.reach)
    if not chart.x.log and chart.lines:
        axes.margins(x=0.01)


def _make_room(axes: Any, bottom: float) -> None:
    """Move the left edge where the numbers on the y axis are long, so that its name is not cut."""
    texts = axes.yaxis.get_major_formatter().format_ticks(axes.yaxis.get_majorticklocs())
    longest = max((len(re.sub(r"\\\w+|[${}^]", "", t)) for t in texts), default=0)
    left = LEFT + max(0, longest - 4) * CHARACTER
    axes.set_position((left, bottom, 0.975 - left, 0.965 - bottom))


def _name(setter: Any, axis: Axis) -> None:
    unit = f" ({short(printable(unit_text(axis.unit)), 22)})" if axis.unit else ""
    setter(short(printable(axis.label), LEGEND_LONGEST) + unit, parse_math=False)


def _legend(chart: Chart) -> list[str]:
    return (
        [short(printable(line.label), LEGEND_LONGEST) for line in chart.lines] if len(chart.lines) > 1 else []
    )


def _columns(labels: list[str]) -> int:
    longest = max(map(len, labels), default=0)
    return 4 if longest < 9 else 2 if longest < 25 else 1


def _add_legend(figure: Any, handles: list[Any], labels: list[str]) -> None:
    """Set the texts after the fact: matplotlib drops labels with a leading _ and reads $ as maths."""
    columns = _columns(labels)
    names = ["x" * len(label) for label in labels]
    legend = figure.legend(handles, names, loc="lower center", ncols=columns, borderpad=0.1, handlelength=2.2)
    for text, label in zip(legend.get_texts(), labels, strict=True):
        text.set_parse_math(False)
        text.set_text(label)
