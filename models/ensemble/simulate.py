"""Many runs of a closed loop at once: many initial states, parameter sets and bodies."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ..closed_loop import Saturation
from ..laws import Law
from ..lowering import Backend
from ..rigid_body import RigidBody
from ..schedule import Schedule
from ..simulation.phases import Phase, phases_between
from ..types import Array
from .grid import GridObserver
from .metrics import EnsembleMetrics, MetricOptions, MetricsObserver, joined_metrics
from .runs import Runs, gather_runs
from .stacked import STACK, Ends, integrate_stack
from .step import Observer
from .steps import Tolerances

Integrate = Callable[[Runs, tuple[Phase, ...], Tolerances, tuple[Observer, ...]], Ends]


@final
@dataclass(frozen=True, eq=False)
class EnsembleResult:
    """What N runs leave behind.

    Attributes
    ----------
    times : (T,), s
    states : (N, T, n), at those times; NaN after a run has stopped
    final_states : (N, n), at the horizon, or where the run stopped
    stop_times : (N,), s; NaN for a run that reached the horizon
    evaluations : (N,) right-hand sides of each run, the effort (steps, for the fast backend)
    state_names : names in the order of a state
    metrics : figures of merit of each run, if they were asked for
    """

    times: Array
    states: Array
    final_states: Array
    stop_times: Array
    evaluations: NDArray[np.int64]
    state_names: tuple[str, ...]
    metrics: EnsembleMetrics | None = None

    @property
    def completed(self) -> NDArray[np.bool_]:
        """Which runs reached the horizon, (N,)."""
        return np.isnan(self.stop_times)

    def state(self, name: str) -> Array:
        """One state by name at all times, (N, T)."""
        return np.asarray(self.states[:, :, self.state_names.index(name)])


def simulate_ensemble(
    laws: Law | Sequence[Law],
    bodies: RigidBody | Sequence[RigidBody],
    schedule: Schedule,
    initial_states: ArrayLike,
    *,
    horizon: Fraction,
    start: Fraction = Fraction(0),
    times: ArrayLike = (),
    metrics: MetricOptions | None = None,
    saturation: Saturation | None = None,
    tolerances: Tolerances | None = None,
    backend: Backend = "default",
    executor: Executor | None = None,
    stack: int = STACK,
) -> EnsembleResult:
    """Simulate N runs, phase by phase between the schedule's knots, each run with its own steps.

    Parameters
    ----------
    laws, bodies : one for all runs, or one for each
        Laws may differ in their exact or float parameters (a parameter set is a law).
    schedule : Schedule
        Common to all runs.
    initial_states : (7,) or (N, 7)
        Unit quaternion and rate (rad/s); with the controller states too, (N, n), they replace
        the law's own initial values.
    horizon, start : Fraction
        End and start of the runs, s.
    times : (T,) ascending, within [start, horizon], s
        Where states are wanted; none by default.
    metrics : MetricOptions, optional
        Asks for peaks, impulse, least R and settling time of every run, with these tolerances.
    saturation : Saturation, optional
        Limit on the applied torque.
    tolerances : Tolerances, optional
        Of every single run: no run's error hides in a mean.
    backend : "default" or "fast"
        numpy, or heyoka (extra `fast`), which compiles for about a second and then is several
        times faster; a stack with a run that escapes goes to the default backend.
    executor : concurrent.futures.Executor, optional
        Stacks are handed to its workers (threads, processes, or a cluster that offers the
        same interface).
    stack : int
        Runs a stack.

    Raises
    ------
    ValueError
        On inputs that do not fit each other, naming them.
    """
    if backend not in ("default", "fast"):
        raise ValueError(f"backend must be 'default' or 'fast', received {backend!r}")
    runs = gather_runs(laws, bodies, initial_states, saturation)
    grid = _checked_times(times, start, horizon)
    phases = _common_phases(laws, schedule, start, horizon)
    chosen = tolerances if tolerances is not None else Tolerances()
    edges = range(0, runs.count, stack)
    parts = [runs.part(a, min(a + stack, runs.count)) for a in edges]
    common = (phases, grid, chosen, metrics, backend)
    if executor is None:
        results = [_simulate_part(part, *common) for part in parts]
    else:
        futures = [
            executor.submit(_simulate_part, part, phases, grid, chosen, metrics, backend) for part in parts
        ]
        results = [future.result() for future in futures]
    return _joined(results)


def _simulate_part(
    runs: Runs,
    phases: tuple[Phase, ...],
    times: Array,
    tolerances: Tolerances,
    options: MetricOptions | None,
    backend: Backend,
) -> EnsembleResult:
    """One stack of runs."""
    if backend == "fast":
        from .taylor import TaylorError, integrate_taylor

        try:
            return _observed(integrate_taylor, runs, phases, times, tolerances, options)
        except TaylorError:
            pass  # the default backend stops a run that escapes alone, and keeps the others
    return _observed(integrate_stack, runs, phases, times, tolerances, options)


def _observed(
    integrate: Integrate,
    runs: Runs,
    phases: tuple[Phase, ...],
    times: Array,
    tolerances: Tolerances,
    options: MetricOptions | None,
) -> EnsembleResult:
    """Integrate a stack and read off what was asked for."""
    size = runs.states.shape[0]
    grid = GridObserver(times, runs.count, size)
    figures = MetricsObserver(runs, phases, options) if options is not None else None
    observers: list[Observer] = [grid] if times.size else []
    observers += [figures] if figures is not None else []
    ends = integrate(runs, phases, tolerances, tuple(observers))
    grid.close()
    completed = np.isnan(ends.stop_times)
    metrics = figures.metrics(completed, float(phases[-1].end)) if figures is not None else None
    names = runs.loop.state_names
    return EnsembleResult(
        times, grid.states, ends.states.T, ends.stop_times, ends.evaluations, names, metrics
    )


def _joined(results: list[EnsembleResult]) -> EnsembleResult:
    if len(results) == 1:
        return results[0]
    return EnsembleResult(
        times=results[0].times,
        states=np.concatenate([r.states for r in results]),
        final_states=np.concatenate([r.final_states for r in results]),
        stop_times=np.concatenate([r.stop_times for r in results]),
        evaluations=np.concatenate([r.evaluations for r in results]),
        state_names=results[0].state_names,
        metrics=joined_metrics([r.metrics for r in results if r.metrics is not None]),
    )


def _checked_times(times: ArrayLike, start: Fraction, horizon: Fraction) -> Array:
    grid = np.asarray(times, dtype=float).ravel()
    if grid.size and not (
        np.all(np.diff(grid) > 0) and grid[0] >= float(start) and grid[-1] <= float(horizon)
    ):
        raise ValueError(f"times must ascend within [{float(start):g}, {float(horizon):g}] s")
    return grid


def _common_phases(
    laws: Law | Sequence[Law], schedule: Schedule, start: Fraction, horizon: Fraction
) -> tuple[Phase, ...]:
    """Phases of the runs; laws that split time themselves must all split it alike."""
    many = [laws] if isinstance(laws, Law) else list(laws)
    phases = phases_between(schedule, many[0], start, horizon)
    if many[0].signals or type(many[0]).reset_instants is not Law.reset_instants:
        for number, law in enumerate(many[1:], start=1):
            if phases_between(schedule, law, start, horizon) != phases:
                raise ValueError(f"law {number} has other signals or reset instants than law 0: run it apart")
    return phases
