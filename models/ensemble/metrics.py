"""Figures of merit of every run, read off the steps' interpolants and refined there."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields
from typing import Any, final

import numpy as np

from ..mission import Tolerance
from ..norms import MEASURED, Norm
from ..simulation.phases import Phase
from ..types import Array
from .observables import FILTER, LENGTH, SETTLING, Name, Observables, extremes
from .runs import Runs
from .step import Basis, Index, Mask, Observer, Step, nested

GOLDEN = (np.sqrt(5.0) - 1) / 2
SCAN = 33
REFINEMENTS = 36
"""Points of a first scan of the bracket, then golden sections: it shrinks below the spacing of times."""


def _nodes() -> tuple[Array, Array]:
    """Fractions of a step that are looked at (ends, twelve Gauss points) and the quadrature weights.

    One more, just after the start, tells a maximum that lies in this step from one in the step before.
    """
    x, weights = np.polynomial.legendre.leggauss(12)
    return np.concatenate([[0.0, 1e-4], (1 + x) / 2, [1.0]]), np.concatenate([[0.0, 0.0], weights / 2, [0.0]])


@final
@dataclass(frozen=True, kw_only=True)
class MetricOptions:
    """What counts as settled, and how torques are measured.

    Attributes
    ----------
    attitude, rate : largest |bv| and largest |w| (rad/s); both signs of the quaternion count
    norms : in which the torque is measured
    """

    attitude: float = 1e-2
    rate: float = 1e-2
    norms: tuple[Norm, ...] = MEASURED

    @classmethod
    def within(cls, tolerance: Tolerance, norms: tuple[Norm, ...] = MEASURED) -> MetricOptions:
        """Settled as a mission says."""
        return cls(attitude=float(tolerance.attitude), rate=float(tolerance.rate), norms=norms)

    def __post_init__(self) -> None:
        if not (self.attitude > 0 and self.rate > 0):
            raise ValueError(f"tolerances must be positive: attitude {self.attitude}, rate {self.rate}")


@final
@dataclass(frozen=True, eq=False)
class EnsembleMetrics:
    """Figures of merit over [start, horizon], (N,) each; NaN for a run that stopped.

    Attributes
    ----------
    peak : largest applied torque g u by norm, in the norm's unit
    peak_commanded : the same of u in phases with g
    impulse : integral of the length of the applied torque, N m s, to about 1e-5 (the length has a corner
        wherever the torque passes close to zero)
    filter_minimum, filter_minimum_time : least R, s, and when, s; NaN for laws without R
    settling_time : last time outside the tolerances, s; NaN for a run that ends outside
    """

    peak: Mapping[Norm, Array]
    peak_commanded: Mapping[Norm, Array]
    impulse: Array
    filter_minimum: Array
    filter_minimum_time: Array
    settling_time: Array


@final
class MetricsObserver(Observer):
    """Keeps, for every run and figure, the step on which it is attained."""

    def __init__(self, runs: Runs, phases: tuple[Phase, ...], options: MetricOptions) -> None:
        self._norms = options.norms
        self._observables = Observables(runs, phases, options.attitude, options.rate, options.norms)
        self._start = float(phases[0].start)
        count, size = runs.count, runs.states.shape[0]
        self._best = {name: _Record(count, size) for name in extremes(options.norms)}
        self._outside = _Record(count, size)
        self._impulse = np.zeros(count)
        self._phase = 0
        self._fractions, self._weights = _nodes()

    def enter(self, phase: int) -> None:
        """Note the number of the phase that begins."""
        self._phase = phase

    def see(self, step: Step) -> None:
        """Update every figure with one accepted step."""
        shape = (step.runs.size, self._fractions.size)
        states = step.at(self._fractions)
        phase = np.full(step.runs.size, self._phase)
        times = step.start[:, None] + step.length[:, None] * self._fractions
        values = self._observables(step.runs, phase, times, states)
        self._impulse[step.runs] += step.length * (values[LENGTH] @ self._weights)
        for name, record in self._best.items():
            node = np.argmax(values[name], axis=1)
            record.keep_larger(step, phase, values[name][np.arange(shape[0]), node], node)
        outside = values[SETTLING] > 0
        last = shape[1] - 1 - np.argmax(outside[:, ::-1], axis=1)
        chosen = np.asarray(outside.any(axis=1))
        self._outside.replace(step, phase, chosen, step.start + step.length, last)

    def metrics(self, completed: Mask, end: float) -> EnsembleMetrics:
        """Refine every figure on the step that holds it."""
        found = {n: self._refined(n, record) for n, record in self._best.items() if n != SETTLING}
        least, when = found[FILTER]

        def told(values: Array) -> Array:
            return np.where(completed, values, np.nan)

        return EnsembleMetrics(
            peak={norm: told(found["peak", norm][0]) for norm in self._norms},
            peak_commanded={norm: told(found["peak_commanded", norm][0]) for norm in self._norms},
            impulse=told(self._impulse),
            filter_minimum=told(np.where(np.isfinite(least), -least, np.nan)),
            filter_minimum_time=told(np.where(np.isfinite(least), when, np.nan)),
            settling_time=told(self._settled(end)),
        )

    def _refined(self, name: Name, record: _Record) -> tuple[Array, Array]:
        """Largest value near the best node, and its time: golden section, all runs at once."""
        runs = np.flatnonzero(record.seen)
        low = self._fractions[np.maximum(record.node - 1, 0)][runs]
        high = self._fractions[np.minimum(record.node + 1, self._fractions.size - 1)][runs]
        low, high = self._closer(name, record, runs, low, high)
        best, at = record.value.copy(), self._fractions[record.node].copy()
        a, b = high - GOLDEN * (high - low), low + GOLDEN * (high - low)
        fa, fb = (self._value(name, record, runs, x) for x in (a, b))
        for _ in range(REFINEMENTS):
            left = fa > fb
            low, high = np.where(left, low, a), np.where(left, b, high)
            new = np.where(left, high - GOLDEN * (high - low), low + GOLDEN * (high - low))
            value = self._value(name, record, runs, new)
            a, b = np.where(left, new, b), np.where(left, a, new)
            fa, fb = np.where(left, value, fb), np.where(left, fa, value)
        peak, where = np.maximum(fa, fb), np.where(fa > fb, a, b)
        better = peak > best[runs]
        best[runs[better]], at[runs[better]] = peak[better], where[better]
        return best, record.start + at * record.length

    def _closer(
        self, name: Name, record: _Record, runs: Index, low: Array, high: Array
    ) -> tuple[Array, Array]:
        """A bracket small enough to hold one maximum only: largest components change hands in the first."""
        x = low[:, None] + (high - low)[:, None] * np.linspace(0, 1, SCAN)
        best = np.argmax(self._values(name, record, runs, x), axis=1)[:, None]
        left, right = (np.clip(best + shift, 0, SCAN - 1) for shift in (-1, 1))
        return np.take_along_axis(x, left, 1)[:, 0], np.take_along_axis(x, right, 1)[:, 0]

    def _settled(self, end: float) -> Array:
        """Last crossing into the tolerances, by bisection between two nodes."""
        record = self._outside
        runs = np.flatnonzero(record.seen)
        low = self._fractions[record.node[runs]]
        high = self._fractions[np.minimum(record.node[runs] + 1, self._fractions.size - 1)]
        for _ in range(50):
            middle = (low + high) / 2
            outside = self._value(SETTLING, record, runs, middle) > 0
            low, high = np.where(outside, middle, low), np.where(outside, high, middle)
        times = np.full(record.seen.size, self._start)
        times[runs] = record.start[runs] + record.length[runs] * high
        at_end = record.seen & (record.node == self._fractions.size - 1)
        return np.where(at_end & (record.value >= end * (1 - 1e-15)), np.nan, times)

    def _value(self, name: Name, record: _Record, runs: Index, x: Array) -> Array:
        return self._values(name, record, runs, x[:, None])[:, 0]

    def _values(self, name: Name, record: _Record, runs: Index, x: Array) -> Array:
        """One observable at fractions x (m, p) of the remembered steps."""
        step = record.step(runs)
        times = step.start[:, None] + step.length[:, None] * x
        return self._observables(runs, record.phase[runs], times, step.at(x))[name]


def joined_metrics(parts: list[EnsembleMetrics]) -> EnsembleMetrics | None:
    """Metrics of several stacks, in order; None if there are none."""
    if not parts:
        return None
    joined: dict[str, Any] = {}
    for name in (f.name for f in fields(EnsembleMetrics)):
        values = [getattr(part, name) for part in parts]
        if name in ("peak", "peak_commanded"):
            joined[name] = {norm: np.concatenate([v[norm] for v in values]) for norm in values[0]}
        else:
            joined[name] = np.concatenate(values)
    return EnsembleMetrics(**joined)


class _Record:
    """One remembered step for each run."""

    def __init__(self, count: int, size: int) -> None:
        self.seen = np.zeros(count, dtype=bool)
        self.value = np.full(count, -np.inf)
        self.node = np.zeros(count, dtype=np.intp)
        self.phase = np.zeros(count, dtype=np.intp)
        self.start, self.length = np.zeros(count), np.zeros(count)
        self.states, self.coefficients = np.zeros((count, size)), np.zeros((count, 0, size))
        self.basis: Basis = nested

    def keep_larger(self, step: Step, phase: Index, value: Array, node: Any) -> None:
        """Remember the step where its value is the largest so far.

        Larger by more than rounding: the end of one step and the start of the next are one state,
        and the maximum may lie just before it.
        """
        best = self.value[step.runs]
        margin = 1e-12 * np.abs(np.where(self.seen[step.runs], best, 0.0))
        self.replace(step, phase, value > best + margin, value, node)

    def replace(self, step: Step, phase: Index, chosen: Mask, value: Array, node: Any) -> None:
        """Remember the step for the chosen of its runs."""
        if not self.coefficients.shape[1]:
            self.coefficients = np.zeros((self.seen.size, *step.coefficients.shape[1:]))
            self.basis = step.basis
        runs = step.runs[chosen]
        self.seen[runs] = True
        self.value[runs], self.node[runs], self.phase[runs] = value[chosen], node[chosen], phase[chosen]
        self.start[runs], self.length[runs] = step.start[chosen], step.length[chosen]
        self.states[runs], self.coefficients[runs] = step.states[chosen], step.coefficients[chosen]

    def step(self, runs: Index) -> Step:
        """The remembered steps of some runs."""
        start, length = self.start[runs], self.length[runs]
        return Step(
            runs, start, start + length, length, self.states[runs], self.coefficients[runs], self.basis
        )
