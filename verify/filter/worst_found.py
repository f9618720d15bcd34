"""The least R found over an initial set by sampling and local search: an upper estimate of the truth.

It proves nothing from below; beside a certified floor it tells how loose that floor can be.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np
from numpy.typing import NDArray

from ...models.closed_loop import close_loop
from ...models.ensemble import MetricOptions, Tolerances, simulate_ensemble
from ...models.laws import Law
from ...models.norms import MEASURED, Norm
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ...models.types import Array
from .sets import InitialSet

SEARCHING = Tolerances(rtol=1e-8, atol=1e-10, phase_evaluations=5000)
"""The least R found is an estimate: eight digits are more than enough; a run too stiff is left out."""
INSIDE = 1 - 1e-9
"""Keeps sampled states inside the set whatever the rounding."""


@final
@dataclass(frozen=True, kw_only=True)
class Search:
    """How hard to look, counted in simulated runs.

    Attributes
    ----------
    samples : first draw over the set, half of it on the boundary
    rounds, local : rounds of local search, and runs a round, around the worst states so far
    seed : of every draw
    """

    samples: int = 96
    rounds: int = 3
    local: int = 32
    seed: int = 1

    def __post_init__(self) -> None:
        if self.samples < 8 or self.rounds < 0 or self.local < 8:
            raise ValueError("a search needs samples >= 8, rounds >= 0 and local >= 8")


@final
@dataclass(frozen=True)
class WorstFound:
    """Least R found and the start that led to it.

    Attributes
    ----------
    value : s
    quaternion, rate : the initial state, (4,) and (3,) rad/s
    instant : when R was least, s
    peak : largest applied torque of any of the runs by norm, in the norm's unit
    runs, horizon : number of runs from starts in the set that got to the horizon, and that, s
    """

    value: float
    quaternion: tuple[float, ...]
    rate: tuple[float, ...]
    instant: float
    peak: Mapping[Norm, float]
    runs: int
    horizon: float


def find_worst(
    law: Law,
    body: RigidBody,
    schedule: Schedule,
    initial: InitialSet,
    *,
    horizon: Fraction,
    max_rate: Fraction | None = None,
    search: Search | None = None,
    norms: Sequence[Norm] = MEASURED,
) -> WorstFound | None:
    """Search an initial set for the start with the least R over [0, horizon].

    None where no start that was tried lies in the set (two bounds on the rate may leave little of it), or
    where no run gets to the horizon.

    Parameters
    ----------
    law : Law
        The law that is simulated.
    body : RigidBody
        The body.
    schedule : Schedule
        Its windows.
    initial : InitialSet
        Set of starts that is searched.
    horizon : Fraction
        End of every run, s.
    max_rate : Fraction, optional
        Further bound on |w(0)| of the set, rad/s, if it has one.
    search : Search, optional
        How hard to search; its defaults without one.
    norms : Sequence[Norm]
        In which the runs' torques are measured.
    """
    options = search or Search()
    rng = np.random.default_rng(options.seed)
    shape = _Shape(law, body, schedule, initial, max_rate, tuple(norms))
    points = shape.draw(rng, options.samples)
    values, times, peaks = shape.run(points, horizon)
    radius = 0.3
    for _ in range(options.rounds):
        best = points[np.argsort(values)[:8]]
        centres = best[rng.integers(len(best), size=options.local)]
        fresh = shape.clip(centres + radius * rng.normal(size=centres.shape) * shape.spread(centres))
        found, when, largest = shape.run(fresh, horizon)
        peaks = np.maximum(peaks, largest)
        points, values = np.vstack([points, fresh]), np.append(values, found)
        times = np.append(times, when)
        radius *= 0.5
    worst = int(np.argmin(values))
    if not np.isfinite(values[worst]):
        return None
    state = shape.states(points[worst : worst + 1])[0]
    return WorstFound(
        float(values[worst]), tuple(state[:4].tolist()), tuple(state[4:].tolist()), float(times[worst]),
        dict(zip(norms, peaks.tolist(), strict=True)), int(np.isfinite(values).sum()), float(horizon),
    )  # fmt: skip


@final
@dataclass(frozen=True)
class _Shape:
    """The set in coordinates (s, y, attitude axis, direction of Omega), (n, 8); directions unnormalised."""

    law: Law
    body: RigidBody
    schedule: Schedule
    initial: InitialSet
    max_rate: Fraction | None
    norms: tuple[Norm, ...] = MEASURED

    def draw(self, rng: np.random.Generator, count: int) -> Array:
        i = self.initial
        size = rng.random((count, 2)) ** 0.5
        size[: count // 2] = 1.0
        low = np.array([i.s_low, i.y_low])
        sizes = low + size * (np.array([i.s_high, i.y_high]) - low)
        axis, omega = rng.normal(size=(count, 3)), rng.normal(size=(count, 3))
        # half of the boundary points turn straight away from the target
        omega[: count // 4] = axis[: count // 4]
        return np.hstack([sizes, axis, omega])

    def spread(self, points: Array) -> Array:
        i = self.initial
        sizes = np.array([i.s_high - i.s_low, i.y_high - i.y_low])
        lengths = np.linalg.norm(points[:, 2:5], axis=1), np.linalg.norm(points[:, 5:], axis=1)
        columns = [np.broadcast_to(sizes, (len(points), 2)), *(np.tile(v[:, None], (1, 3)) for v in lengths)]
        return np.hstack(columns)

    def clip(self, points: Array) -> Array:
        i = self.initial
        points[:, 0] = np.clip(points[:, 0], i.s_low, i.s_high)
        points[:, 1] = np.clip(points[:, 1], i.y_low, i.y_high)
        return points

    def states(self, points: Array) -> Array:
        """Quaternion and rate of each point, (n, 7)."""
        s, y = points[:, 0] * INSIDE, points[:, 1] * INSIDE
        b0 = np.clip(1 - s**2, -1.0, 1.0)
        axis = points[:, 2:5] / np.linalg.norm(points[:, 2:5], axis=1, keepdims=True)
        bv = axis * np.sqrt(1 - b0**2)[:, None]
        direction = points[:, 5:]
        norm = np.sqrt(np.einsum("ni,ij,nj->n", direction, self.body.inertia, direction))
        Omega = direction * (y / norm)[:, None]
        w = Omega - 2 * self._gain_term() * bv
        if self.max_rate is not None:
            size = np.linalg.norm(w, axis=1)
            w *= np.minimum(1.0, float(self.max_rate) * INSIDE / np.maximum(size, 1e-300))[:, None]
        q = np.hstack([b0[:, None], bv])
        return np.hstack([q / np.linalg.norm(q, axis=1, keepdims=True), w])

    def inside(self, states: Array) -> NDArray[np.bool_]:
        """Whether |Omega|_J is within the set: holding |w| to its own bound can push it out."""
        Omega = states[:, 4:] + 2 * self._gain_term() * states[:, 1:4]
        y = np.sqrt(np.einsum("ni,ij,nj->n", Omega, self.body.inertia, Omega))
        return np.asarray((y <= self.initial.y_high) & (y >= self.initial.y_low * INSIDE))

    def _gain_term(self) -> float:
        loop = close_loop(self.law)
        if loop.control.gain is None:
            return 0.0
        gain = loop.function("gain", loop.control.gain)
        state = loop.initial_state(np.array([1.0, 0, 0, 0]), np.zeros(3))
        kappa = float(gain(state, np.zeros(loop.time.shape[0]), loop.parameter_values(), np.ones(12)))
        return float(self.schedule.gain(0.0)) ** 2 * kappa

    def run(self, points: Array, horizon: Fraction) -> tuple[Array, Array, Array]:
        """Least R of each point (inf outside the set) and when; the largest torque in each norm."""
        states = self.states(points)
        result = simulate_ensemble(
            self.law,
            self.body,
            self.schedule,
            states,
            horizon=horizon,
            metrics=MetricOptions(norms=self.norms),
            tolerances=SEARCHING,
        )
        assert result.metrics is not None
        values = result.metrics.filter_minimum
        bad = np.isnan(values) | ~self.inside(states)
        torques = np.vstack([result.metrics.peak[norm] for norm in self.norms])
        peaks = np.max(torques, axis=1, where=~bad & np.isfinite(torques).all(axis=0), initial=0.0)
        return np.where(bad, np.inf, values), result.metrics.filter_minimum_time, peaks
