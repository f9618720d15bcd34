"""Drawing a result: charts in the report's own style on matplotlib axes, imported when first needed."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from importlib import import_module
from typing import TYPE_CHECKING, Any

import numpy as np

from ..models.types import Array
from ..reports.content.blocks import Axis, Chart, Line

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from ..models.schedule import Schedule

TIME = Axis("time", "s")
MAX_SHADED = 400
"""Windows that are shaded; of more nobody could see one."""
INCHES = (6.4, 2.4)
"""Width of a figure and height of each of its axes."""


def needed(module: str, what: str) -> Any:
    """Import a module that only some calls need.

    Raises
    ------
    ImportError
        If it is not installed, with the command that installs it.
    """
    try:
        return import_module(module)
    except ImportError as error:
        package = module.partition(".")[0]
        raise ImportError(f"{what} needs {package}: python -m pip install {package}") from error


def draw(charts: Sequence[Chart]) -> NDArray[np.object_]:
    """Draw charts one under the other in a new figure; its axes, shape (number of charts,)."""
    pyplot = needed("matplotlib.pyplot", "plot()")
    from ..reports.content.figures import draw_chart

    size = (INCHES[0], INCHES[1] * len(charts))
    _, axes = pyplot.subplots(len(charts), squeeze=False, figsize=size, layout="constrained")
    for one, chart in zip(axes[:, 0], charts, strict=True):
        handles = draw_chart(one, chart)
        one.set_title(chart.title, parse_math=False)
        if len(handles) > 1:
            legend = one.legend(handles, [line.label.lstrip("_") for line in chart.lines])
            for text in legend.get_texts():
                text.set_parse_math(False)
    found: NDArray[np.object_] = axes[:, 0]
    return found


def components(t: Array, values: Array, names: Sequence[str] = ("x", "y", "z")) -> tuple[Line, ...]:
    """One line a column of `values` (n, m) over t (n,)."""
    return tuple(Line(name, t, values[:, i], colour=i) for i, name in enumerate(names))


def level(label: str, t: Array, value: float, colour: int) -> Line:
    """A dashed level over the span of t."""
    ends = np.array([t[0], t[-1]])
    return Line(label, ends, np.full(2, value), colour=colour, dashed=True)


def windows_of(schedule: Schedule, horizon: Fraction) -> tuple[tuple[float, float], ...]:
    """Windows up to the horizon, (on, off) in s, as figures shade them; none if there are too many."""
    if schedule.windows_before(horizon) > MAX_SHADED:
        return ()
    pairs = ((float(w.on), float(w.off)) for w in schedule.windows_between(Fraction(0), horizon))
    return tuple((on, min(off, float(horizon))) for on, off in pairs)
