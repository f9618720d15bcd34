"""How a handful of runs crosses a phase under heyoka, and what is kept of the way."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import Any, final

import numpy as np

from ..simulation.phases import Phase
from ..types import Array
from .grid import GridObserver
from .step import Index, Observer, Step, powers

MAX_STEPS = 20_000
"""Steps a phase after which a run counts as escaping."""


@final
class Interval:
    """A phase in the integrators' own time, which starts at the phase's origin."""

    def __init__(self, phase: Phase) -> None:
        self.phase, self.origin = phase, float(phase.origin)
        self.start, self.end = float(phase.start) - self.origin, float(phase.end) - self.origin


class Passage(ABC):
    """Carries lanes across one phase and keeps what is wanted."""

    @abstractmethod
    def carry(self, integrator: Any, first: int, used: int) -> None:
        """Carry the lanes, of which `used` hold the runs from `first` on, to the end of the phase."""

    def finish(self) -> None:  # noqa: B027 - most passages have nothing left to do
        """Hand on what was kept, after the last lanes."""


@final
class EndsOnly(Passage):
    """Keeps nothing."""

    def __init__(self, interval: Interval) -> None:
        self._end = interval.end

    def carry(self, integrator: Any, first: int, used: int) -> None:
        """Carry the lanes."""
        del first, used
        integrator.propagate_until(self._end, max_steps=MAX_STEPS)


@final
class OnGrid(Passage):
    """Keeps states on the wanted times, evaluated by heyoka itself."""

    def __init__(self, interval: Interval, grid: GridObserver, lanes: int) -> None:
        self._grid = grid
        start, end = float(interval.phase.start), float(interval.phase.end)
        self._first = int(np.searchsorted(grid.times, start, side="right"))
        self._last = int(np.searchsorted(grid.times, end, side="right"))
        if self._first == 1 and grid.times[0] == start:
            self._first = 0
        inside = np.minimum(grid.times[self._first : self._last] - interval.origin, interval.end)
        self._leading = int(not inside.size or inside[0] > interval.start)
        points = inside if not self._leading else np.concatenate([[interval.start], inside])
        if points[-1] < interval.end:
            points = np.append(points, interval.end)
        self._points = np.repeat(points[:, None], lanes, axis=1)

    def carry(self, integrator: Any, first: int, used: int) -> None:
        """Carry the lanes."""
        values = integrator.propagate_grid(self._points, max_steps=MAX_STEPS)[1]
        kept = values[self._leading : self._leading + self._last - self._first, :, :used]
        self._grid.place(first, used, self._first, self._last, kept)


@final
class EveryStep(Passage):
    """Keeps every step's Taylor coefficients, for observers that want whole steps."""

    def __init__(self, interval: Interval, observers: tuple[Observer, ...], count: int) -> None:
        self._interval, self._observers, self._count = interval, observers, count
        self._records: list[tuple[int, int, list[Array], list[Array]]] = []

    def carry(self, integrator: Any, first: int, used: int) -> None:
        """Carry the lanes; heyoka's own continuous output would compile a function at every call."""
        coefficients: list[Array] = []
        times: list[Array] = []

        def record(stepped: Any) -> bool:
            coefficients.append(stepped.tc.copy())
            times.append(stepped.time.copy())
            return True

        integrator.propagate_until(self._interval.end, max_steps=MAX_STEPS, callback=record, write_tc=True)
        self._records.append((first, used, coefficients, times))

    def finish(self) -> None:
        """Show the observers the first step of all runs, then the second, and so on."""
        coefficients, times = self._gathered()
        for k in range(len(coefficients)):
            length = times[k + 1] - times[k]
            runs = np.flatnonzero(length > 0)
            step = self._step(runs, times[k, runs], times[k + 1, runs], coefficients[k][runs])
            for observer in self._observers:
                observer.see(step)

    def _gathered(self) -> tuple[Array, Array]:
        """Coefficients (steps, N, terms, n) and times (steps + 1, N) of all runs."""
        most = max(len(times) for _, _, _, times in self._records)
        size, terms = self._records[0][2][0].shape[:2]
        coefficients = np.zeros((most, self._count, terms, size))
        times = np.full((most + 1, self._count), self._interval.end)
        times[0] = self._interval.start
        for first, used, recorded, ends in self._records:
            for k, (tc, at) in enumerate(zip(recorded, ends, strict=True)):
                coefficients[k, first : first + used] = tc.transpose(2, 1, 0)[:used]
                times[k + 1, first : first + used] = at[:used]
        return coefficients, times

    def _step(self, runs: Index, start: Array, end: Array, coefficients: Array) -> Step:
        interval, terms = self._interval, coefficients.shape[1]
        length = end - start
        scaled = coefficients[:, 1:] * (length[:, None] ** np.arange(1, terms))[:, :, None]
        ending = np.where(end == interval.end, float(interval.phase.end), end + interval.origin)
        states = np.ascontiguousarray(coefficients[:, 0])
        return Step(runs, start + interval.origin, ending, length, states, scaled, powers)
