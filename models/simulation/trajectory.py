"""What a run leaves behind: dense states, torques and signals at any time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cached_property
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..closed_loop import ClosedLoop, body_values
from ..rigid_body import RigidBody
from ..schedule import Schedule
from ..types import Array
from .phases import Phase


@final
@dataclass(frozen=True, eq=False)
class Segment:
    """The part of a run in one phase.

    Attributes
    ----------
    times : (m,), s: the integrator's own steps
    states : (n, m)
    dense : t -> state, (n, len(t)), of the integrator's order
    """

    phase: Phase
    times: Array
    states: Array
    dense: Callable[[Array], Array]

    @property
    def end_state(self) -> Array:
        """State at the end of the phase, (n,)."""
        return np.asarray(self.states[:, -1])


@final
@dataclass(frozen=True, eq=False)
class Signals:
    """Signals of a run at times t, (3, m) or (m,) each.

    Attributes
    ----------
    gain, gain_rate : g and g' (1/s)
    commanded_torque : u, N m (before g and before saturation)
    applied_torque : g u after saturation, N m
    augmented_rate : Omega, rad/s
    """

    gain: Array
    gain_rate: Array
    commanded_torque: Array
    applied_torque: Array
    augmented_rate: Array


@final
@dataclass(frozen=True, eq=False)
class Trajectory:
    """A simulated run.

    Attributes
    ----------
    segments : one per phase, in order of time
    evaluations : number of right-hand sides, the run's effort
    """

    loop: ClosedLoop
    body: RigidBody
    schedule: Schedule
    segments: tuple[Segment, ...]
    evaluations: int

    @property
    def start(self) -> float:
        """Start of the run, s."""
        return float(self.segments[0].phase.start)

    @property
    def end(self) -> float:
        """End of the run, s."""
        return float(self.segments[-1].phase.end)

    @property
    def is_saturated_model(self) -> bool:
        """Whether the torque was limited: then no claim of the package covers the run."""
        return self.loop.saturation is not None

    @cached_property
    def _starts(self) -> Array:
        return np.array([float(s.phase.start) for s in self.segments])

    def _segment_index(self, t: Array) -> NDArray[np.intp]:
        return np.clip(np.searchsorted(self._starts, t, side="right") - 1, 0, len(self.segments) - 1)

    def state(self, t: ArrayLike) -> Array:
        """State (n,) or (n, m) at times t, s, within the run.

        Raises
        ------
        ValueError
            If a time lies outside the run.
        """
        times = np.atleast_1d(np.asarray(t, dtype=float))
        slack = 1e-9 * max(1.0, self.end)
        if times.size and (times.min() < self.start - slack or times.max() > self.end + slack):
            raise ValueError(f"times must lie in [{self.start}, {self.end}] s")
        index = self._segment_index(times)
        values = np.empty((self.loop.state.shape[0], times.size))
        for i in np.unique(index):
            chosen = index == i
            values[:, chosen] = self.segments[i].dense(times[chosen])
        return values[:, 0] if np.ndim(t) == 0 else values

    def controller_state(self, name: str, t: ArrayLike) -> Array:
        """One controller state by name at times t."""
        return np.asarray(self.state(t)[self.loop.state_names.index(name)])

    def time_signals(self, t: ArrayLike) -> Array:
        """g, g', then each signal and its rate at times t, (2 + 2 s, m)."""
        times = np.atleast_1d(np.asarray(t, dtype=float))
        index = self._segment_index(times)
        values = np.zeros((self.loop.time.shape[0], times.size))
        for i in np.unique(index):
            chosen, phase = index == i, self.segments[i].phase
            tau = times[chosen] - float(phase.origin)
            for row, exact in enumerate(phase.coefficients):
                coefficients = np.array([float(c) for c in exact] or [0.0])
                values[2 * row, chosen] = np.polynomial.polynomial.polyval(tau, coefficients)
                slope = np.polynomial.polynomial.polyder(coefficients)
                values[2 * row + 1, chosen] = np.polynomial.polynomial.polyval(tau, slope)
        return values

    @cached_property
    def _signal_function(self) -> Any:
        loop = self.loop
        return loop.function("signals", loop.control.torque, loop.applied_torque, loop.augmented_rate)

    def signals(self, t: ArrayLike) -> Signals:
        """Torques and signals at times t, (m,)."""
        times = np.atleast_1d(np.asarray(t, dtype=float))
        known = self.time_signals(times)
        parameters = np.tile(self.loop.parameter_values()[:, None], times.size)
        body = np.tile(body_values(self.body)[:, None], times.size)
        u, tau, Omega = self._signal_function(np.atleast_2d(self.state(times)), known, parameters, body)
        return Signals(known[0], known[1], np.asarray(u), np.asarray(tau), np.asarray(Omega))

    def grid(self, points_per_step: int = 8) -> Array:
        """Times that follow the integrator's own steps, each split into `points_per_step`, (m,)."""
        parts = []
        for segment in self.segments:
            fractions = np.arange(points_per_step) / points_per_step
            steps = np.diff(segment.times)
            parts.append((segment.times[:-1, None] + steps[:, None] * fractions).ravel())
        return np.append(np.concatenate(parts), self.end)
