"""States of every run on a common grid of times, read off each step's interpolant."""

from __future__ import annotations

from typing import final

import numpy as np

from ..types import Array
from .step import Observer, Step


@final
class GridObserver(Observer):
    """Fills states (N, T, n) at given times (T,), ascending, s; NaN where a run has stopped."""

    def __init__(self, times: Array, count: int, size: int) -> None:
        self.times = times
        self.states = np.empty((count, times.size, size))
        self._next = np.zeros(count, dtype=np.intp)

    def see(self, step: Step) -> None:
        """Fill the times within the step."""
        first = self._next[step.runs]
        last = np.searchsorted(self.times, step.end, side="right")
        most = int((last - first).max())
        if most <= 0:
            return
        index = first[:, None] + np.arange(most)
        inside = index < last[:, None]
        x = (self.times[np.minimum(index, self.times.size - 1)] - step.start[:, None]) / step.length[:, None]
        values = step.at(x)
        self.states[np.repeat(step.runs, last - first), index[inside]] = values[inside]
        self._next[step.runs] = last

    def place(self, first: int, used: int, begin: int, end: int, values: Array) -> None:
        """States (end - begin, n, used) of the runs from `first` on, at the times begin, ..., end - 1."""
        self.states[first : first + used, begin:end] = values.transpose(2, 0, 1)
        self._next[first : first + used] = end

    def close(self) -> None:
        """Mark the times that stopped runs have not reached."""
        for run in np.flatnonzero(self._next < self.times.size):
            self.states[run, self._next[run] :] = np.nan
