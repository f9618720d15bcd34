"""Figures of merit of a run, each refined on the dense output, not read off a grid."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from ..norms import EUCLIDEAN, MEASURED, Norm
from ..types import Array
from .trajectory import Trajectory

ScalarOfTime = Callable[[Array], Array]


@final
@dataclass(frozen=True)
class Extremum:
    """A value and the time at which it occurs, s."""

    value: float
    time: float


@final
@dataclass(frozen=True)
class TorqueMetrics:
    """Torque figures over [start, until].

    Attributes
    ----------
    peak : largest applied torque by the norm it is measured in, in the norm's unit
    peak_commanded : the same of u while g > 0
    impulse : integral of the Euclidean norm of the applied torque, N m s
    until : end of the interval, s
    """

    peak: Mapping[Norm, Extremum]
    peak_commanded: Mapping[Norm, Extremum]
    impulse: float
    until: float


@final
@dataclass(frozen=True)
class Invariants:
    """Conserved quantities, as largest deviations.

    Attributes
    ----------
    quaternion_norm : max | |beta| - 1 |
    free_momentum : max relative change of |J w| within any torque-free phase
    """

    quaternion_norm: float
    free_momentum: float


def maximum(trajectory: Trajectory, of: ScalarOfTime, until: float | None = None) -> Extremum:
    """Largest value of a scalar function of time over the run.

    Every local maximum of a grid on the integrator's own steps that comes within 2 % of the
    largest is refined on the dense output, so that two near-equal peaks are told apart.
    """
    from scipy.optimize import minimize_scalar

    grid = _grid(trajectory, until)
    values = of(grid)
    best = int(np.argmax(values))
    found = Extremum(float(values[best]), float(grid[best]))
    for i in _near_peaks(values, best):
        bounds = (grid[max(i - 1, 0)], grid[min(i + 1, grid.size - 1)])
        refined = minimize_scalar(
            lambda t: -float(of(np.array([t]))[0]), bounds=bounds, method="bounded", options={"xatol": 1e-10}
        )
        if -refined.fun > found.value:
            found = Extremum(float(-refined.fun), float(refined.x))
    return found


def _near_peaks(values: Array, best: int) -> NDArray[np.intp]:
    """Grid maxima close to the largest, at most eight."""
    padded = np.concatenate([[-np.inf], values, [-np.inf]])
    is_peak = (values >= padded[:-2]) & (values >= padded[2:])
    close = values >= values[best] - 0.02 * abs(values[best])
    peaks = np.flatnonzero(is_peak & close)
    return peaks[np.argsort(-values[peaks], kind="stable")[:8]]


def minimum(trajectory: Trajectory, of: ScalarOfTime, until: float | None = None) -> Extremum:
    """Least value of a scalar function of time over the run."""
    peak = maximum(trajectory, lambda t: -of(t), until)
    return Extremum(-peak.value, peak.time)


def peak_torque(trajectory: Trajectory, norm: Norm, until: float | None = None) -> Extremum:
    """Largest applied torque over [start, until] in a norm, in the norm's unit."""
    return maximum(trajectory, lambda t: norm.peak(trajectory.signals(t).applied_torque.T), until)


def peak_commanded_torque(trajectory: Trajectory, norm: Norm, until: float | None = None) -> Extremum:
    """Largest commanded torque while g > 0 over [start, until] in a norm, in the norm's unit."""

    def size(t: Array) -> Array:
        signals = trajectory.signals(t)
        return norm.peak(np.where(signals.gain > 0, signals.commanded_torque, 0.0).T)

    return maximum(trajectory, size, until)


def torque_metrics(
    trajectory: Trajectory, until: float | None = None, norms: Sequence[Norm] = MEASURED
) -> TorqueMetrics:
    """Peaks in each norm, and impulse, of the torque over [start, until]."""
    return TorqueMetrics(
        peak={norm: peak_torque(trajectory, norm, until) for norm in norms},
        peak_commanded={norm: peak_commanded_torque(trajectory, norm, until) for norm in norms},
        impulse=_impulse(trajectory, until),
        until=trajectory.end if until is None else until,
    )


def _impulse(trajectory: Trajectory, until: float | None) -> float:
    """Gauss-Legendre quadrature of |g u| on each integrator step."""
    stop = trajectory.end if until is None else until
    nodes, weights = np.polynomial.legendre.leggauss(8)
    total = 0.0
    for segment in trajectory.segments:
        edges = np.minimum(segment.times, stop)
        half = np.diff(edges) / 2
        if segment.phase.is_torque_free or not half.any():
            continue
        times = (edges[:-1] + half)[:, None] + half[:, None] * nodes
        size = EUCLIDEAN.peak(trajectory.signals(times.ravel()).applied_torque.T)
        total += float(np.sum(size.reshape(times.shape) * weights * half[:, None]))
    return total


def settling_time(trajectory: Trajectory, *, attitude: float, rate: float) -> float | None:
    """Last time outside |bv| <= attitude or |w| <= rate (rad/s), s; None if the run ends outside.

    Both signs of the quaternion count as the target attitude.
    """
    from scipy.optimize import brentq

    def excess(t: Array) -> Array:
        x = trajectory.state(t)
        angle, speed = np.linalg.norm(x[1:4], axis=0), np.linalg.norm(x[4:7], axis=0)
        return np.asarray(np.maximum(angle / attitude, speed / rate) - 1)

    grid = trajectory.grid()
    outside = np.flatnonzero(excess(grid) > 0)
    if outside.size == 0:
        return trajectory.start
    last = int(outside[-1])
    if last == grid.size - 1:
        return None
    return float(brentq(lambda t: float(excess(np.array([t]))[0]), grid[last], grid[last + 1], xtol=1e-12))


def filter_minimum(trajectory: Trajectory) -> Extremum:
    """Least filter state R along the run, s: true of this run only."""
    return minimum(trajectory, lambda t: trajectory.controller_state("R", t))


def invariants(trajectory: Trajectory) -> Invariants:
    """Drift of the conserved quantities: how well the run was integrated."""
    norm, momentum = 0.0, 0.0
    for segment in trajectory.segments:
        norm = max(norm, float(np.abs(np.linalg.norm(segment.states[:4], axis=0) - 1).max()))
        if segment.phase.is_torque_free:
            H = np.linalg.norm(trajectory.body.inertia @ segment.states[4:7], axis=0)
            if H[0] > 0:
                momentum = max(momentum, float(np.abs(H - H[0]).max() / H[0]))
    return Invariants(norm, momentum)


def _grid(trajectory: Trajectory, until: float | None) -> Array:
    grid = trajectory.grid()
    if until is None:
        return grid
    return np.append(grid[grid < until], until)
