"""Numbers on a logarithmic axis that spans few decades: 1, 2 and 5 of each, in plain figures."""

from __future__ import annotations

import numpy as np

from .blocks import Chart

MAX_DECADES = 3.0
"""Span of the values up to which every decade is divided."""


def log_ticks(chart: Chart) -> tuple[float, ...]:
    """Tick values of a logarithmic y axis; none where the decades alone say enough."""
    held = [a[a > 0] for line in chart.lines for a in (line.y, line.upper) if a is not None]
    values = [a[np.isfinite(a)] for a in held]
    if not any(a.size for a in values):
        return ()
    low = min(float(a.min()) for a in values if a.size)
    high = max(float(a.max()) for a in values if a.size)
    if np.log10(high / low) > MAX_DECADES:
        return ()
    first, last = int(np.floor(np.log10(low))), int(np.ceil(np.log10(high)))
    every = [digit * 10.0**power for power in range(first, last + 1) for digit in (1, 2, 5)]
    return tuple(float(f"{t:.1g}") for t in every if low / 1.5 <= t <= 1.5 * high)
