"""One point budget shared by every series of a page: thin out, never losing a peak."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from itertools import pairwise

import numpy as np
from numpy.typing import NDArray

from .blocks import Array, Chart, Line


def thin(charts: Sequence[Chart], budget: int) -> tuple[Chart, ...]:
    """Charts whose stored values together number at most about `budget`.

    Charts below the common ration keep every point; what they leave goes to the others.
    """
    ration = _ration([_cost(c) for c in charts], budget)
    return tuple(c if _cost(c) <= ration else _thinned(c, ration) for c in charts)


def _cost(chart: Chart) -> int:
    """Count the stored values: one x for the lines that share it, then every y."""
    shared = {id(line.x): len(line.x) for line in chart.lines}
    return sum(shared.values()) + sum(len(line.y) * (1 if line.upper is None else 2) for line in chart.lines)


def _ration(costs: Sequence[int], budget: int) -> int:
    """Find the largest equal ration such that the sum of min(cost, ration) fits the budget."""
    left, ordered = budget, sorted(costs)
    for i, cost in enumerate(ordered):
        share = left // (len(ordered) - i)
        if cost > share:
            return max(share, 64)
        left -= cost
    return max(costs, default=0)


def _thinned(chart: Chart, ration: int) -> Chart:
    by_axis: dict[int, list[Line]] = {}
    for line in chart.lines:
        by_axis.setdefault(id(line.x), []).append(line)
    total, kept = _cost(chart), {}
    for lines in by_axis.values():
        n = len(lines[0].x)
        if any(line.style in {"bars", "step"} or len(line.y) != n for line in lines):
            continue
        points = max(8, int(n * ration / total))
        index = keep([a for line in lines for a in (line.y, line.upper) if a is not None], points)
        x = lines[0].x[index]
        for line in lines:
            upper = None if line.upper is None else line.upper[index]
            kept[id(line)] = replace(line, x=x, y=line.y[index], upper=upper)
    return replace(chart, lines=tuple(kept.get(id(line), line) for line in chart.lines))


def keep(values: Sequence[Array], points: int) -> NDArray[np.intp]:
    """Choose about `points` samples: the ends, and each bucket's least and greatest of every series."""
    n = len(values[0])
    if n <= points:
        return np.arange(n)
    buckets = max(1, points // (2 * len(values)))
    edges = np.linspace(0, n, buckets + 1).astype(int)
    chosen = {0, n - 1}
    for start, stop in pairwise(edges):
        if stop > start:
            for v in values:
                chosen.update((start + int(np.argmin(v[start:stop])), start + int(np.argmax(v[start:stop]))))
    return np.array(sorted(chosen), dtype=np.intp)
