"""The fast backend: heyoka's Taylor integrator, several runs to a vector register (extra `fast`).

Each run still has its own steps and error control, and none crosses a phase's end.
"""

from __future__ import annotations

import copy
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final

import numpy as np

from ..lowering import shared, walk
from ..lowering.heyoka_table import heyoka_expressions, load_heyoka
from ..simulation.coasting import coasting_decays
from ..simulation.phases import Phase, signal_degree
from ..types import Array
from .field import StackedField, Structure, field_function, representative_loop
from .grid import GridObserver
from .runs import Runs
from .stacked import Ends, reset_states
from .step import Observer
from .steps import Tolerances
from .taylor_passages import EndsOnly, EveryStep, Interval, OnGrid, Passage

LANES = 8


class TaylorError(RuntimeError):
    """A run left the numbers or its steps shrank to nothing; the default backend says which and when."""


def integrate_taylor(
    runs: Runs, phases: tuple[Phase, ...], tolerances: Tolerances, observers: tuple[Observer, ...]
) -> Ends:
    """Carry all runs through the phases.

    heyoka's tolerance is relative to the largest component of a state: the smaller of both
    tolerances is handed on.

    Raises
    ------
    TaylorError
        If a run cannot be carried to the end; at once for a law that jumps, which may chatter, and where a
        state decays in a coast to where only the default backend knows it.
    """
    _require_fitting(runs, phases)
    degree, tolerance = signal_degree(phases), min(tolerances.rtol, tolerances.atol * 100)
    integrators = {
        coasting: copy.deepcopy(_integrator(runs.structure, degree, tolerance, coasting=coasting))
        for coasting in {phase.is_torque_free for phase in phases}
    }
    ends = Ends(np.array(runs.states), np.full(runs.count, np.nan), np.zeros(runs.count, dtype=np.int64))
    rows = [
        v if v.ndim == 2 else np.repeat(v[:, None], runs.count, axis=1) for v in (runs.parameters, runs.body)
    ]
    for number, phase in enumerate(phases):
        if phase.resets:
            ends.states[:] = reset_states(runs, ends.states)
        for observer in observers:
            observer.enter(number)
        integrator = integrators[phase.is_torque_free]
        signals = phase.coefficient_array(degree).ravel(order="F")
        integrator.pars[: signals.size] = signals[:, None]
        passage = _passage(Interval(phase), observers, runs.count, integrator.batch_size)
        _cross(integrator, Interval(phase), passage, _Lanes(rows, signals.size), ends)
    return ends


def _passage(interval: Interval, observers: tuple[Observer, ...], count: int, lanes: int) -> Passage:
    if not observers:
        return EndsOnly(interval)
    if len(observers) == 1 and isinstance(observers[0], GridObserver):
        return OnGrid(interval, observers[0], lanes)
    return EveryStep(interval, observers, count)


FORGOTTEN = 10.0
"""Decay, as an exponent, of a state through one coast above which it is left to the default backend."""


def _require_fitting(runs: Runs, phases: tuple[Phase, ...]) -> None:
    parameters = runs.parameters if runs.parameters.ndim == 2 else runs.parameters[:, None]
    decay = coasting_decays(representative_loop(runs.structure), parameters)
    longest = max((float(p.end - p.start) for p in phases if p.is_torque_free), default=0.0)
    if decay is not None and decay.size and decay.max() * longest > FORGOTTEN:
        raise TaylorError("a controller state decays too far in a coast")
    if StackedField(runs.structure, runs.parameters, runs.body, degree=signal_degree(phases)).jumps:
        raise TaylorError("the law jumps")


@final
@dataclass(frozen=True, eq=False)
class _Lanes:
    """Parameters and bodies (p, N) of all runs, and the row at which they go into an integrator."""

    rows: list[Array]
    offset: int


def _cross(integrator: Any, interval: Interval, passage: Passage, inputs: _Lanes, ends: Ends) -> None:
    """Carry all runs across one phase, as many at a time as there are lanes."""
    count, lanes = ends.stop_times.size, integrator.batch_size
    arrived = load_heyoka().taylor_outcome.time_limit
    for first in range(0, count, lanes):
        chosen = np.minimum(np.arange(first, first + lanes), count - 1)
        used, row = min(lanes, count - first), inputs.offset
        integrator.state[:] = ends.states[:, chosen]
        for values in inputs.rows:
            integrator.pars[row : row + len(values)] = values[:, chosen]
            row += len(values)
        integrator.set_time(interval.start)
        passage.carry(integrator, first, used)
        results = integrator.propagate_res
        if any(result[0] != arrived for result in results) or not np.isfinite(integrator.state).all():
            raise TaylorError(f"a run cannot be carried to {float(interval.phase.end):g} s")
        ends.states[:, first : first + used] = integrator.state[:, :used]
        ends.evaluations[first : first + used] += np.array([r[3] for r in results[:used]], dtype=np.int64)
    passage.finish()


@lru_cache(maxsize=16)
def _integrator(structure: Structure, degree: int, tolerance: float, *, coasting: bool) -> Any:
    """Heyoka's integrator of the closed loop in a phase; its parameters are coefficients, law, body."""
    hy = load_heyoka()
    loop = representative_loop(structure)
    program = shared(walk(field_function(structure, degree, coasting=coasting)))
    states = hy.make_vars(*[f"x{i}" for i in range(loop.state.numel())])
    arguments: list[list[Any]] = [[hy.time], list(states)]
    used = 0
    for size in program.argument_sizes[2:]:
        arguments.append([hy.par[used + i] for i in range(size)])
        used += size
    (rates,) = heyoka_expressions(program, arguments)
    lanes = max(hy.recommended_simd_size(), LANES)
    return hy.taylor_adaptive_batch(
        sys=list(zip(states, rates, strict=True)),
        state=np.ones((len(rates), lanes)),
        pars=np.ones((used, lanes)),
        tol=tolerance,
        force_avx512=True,
    )
