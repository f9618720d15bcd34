"""The default backend: all runs of a stack through each phase, then on to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import final

import numpy as np
from numpy.typing import NDArray

from ..lowering import ArrayFunction, shared, walk
from ..simulation.phases import Phase, signal_degree
from ..types import Array
from .field import StackedField, Structure, representative_loop
from .runs import Runs
from .step import Mask, Observer
from .steps import Stack, Tolerances

STACK = 1024
"""Runs a stack: enough to drown numpy's overhead, few enough for the second-level cache."""
JUMPING_EVALUATIONS = 20_000
"""Right-hand sides of one phase after which a run of a law that jumps counts as chattering."""


@final
@dataclass(frozen=True, eq=False)
class Ends:
    """How each run ended.

    Attributes
    ----------
    states : (n, N) at the end, or where the run stopped
    stop_times : (N,), s; NaN for a run that reached the horizon
    evaluations : (N,) right-hand sides
    """

    states: Array
    stop_times: Array
    evaluations: NDArray[np.int64]


def integrate_stack(
    runs: Runs, phases: tuple[Phase, ...], tolerances: Tolerances, observers: tuple[Observer, ...]
) -> Ends:
    """Carry all runs through the phases; none ever steps across a phase's end.

    A run whose state leaves the numbers, or whose step shrinks to nothing, stops alone. So does a
    run of a law that jumps, where it chatters: no integrator gets past a surface that it slides along.
    """
    field = StackedField(runs.structure, runs.parameters, runs.body, degree=signal_degree(phases))
    if tolerances.phase_evaluations is None and field.jumps:
        tolerances = replace(tolerances, phase_evaluations=JUMPING_EVALUATIONS)
    ends = Ends(np.array(runs.states), np.full(runs.count, np.nan), np.zeros(runs.count, dtype=np.int64))
    with np.errstate(all="ignore"):
        for number, phase in enumerate(phases):
            alive = np.flatnonzero(np.isnan(ends.stop_times))
            if not alive.size:
                break
            if phase.resets:
                ends.states[:, alive] = reset_states(runs, ends.states)[:, alive]
            field.enter(phase, alive)
            for observer in observers:
                observer.enter(number)
            _through(
                Stack(field, alive, ends.states[:, alive], float(phase.start), float(phase.end), tolerances),
                observers,
                ends,
            )
    return ends


def _through(stack: Stack, observers: tuple[Observer, ...], ends: Ends) -> None:
    """Carry a stack to the end of its phase."""
    while stack.runs.size:
        stack.advance(observers)
        finished = stack.finished
        stuck = stack.stuck & ~finished
        gone: Mask = finished | stuck
        if not gone.any():
            continue
        leaving = stack.runs[gone]
        ends.states[:, leaving] = stack.y[:, gone]
        ends.evaluations[leaving] += stack.evaluations[gone]
        ends.stop_times[stack.runs[stuck]] = stack.t[stuck]
        stack.keep(~gone)


def reset_states(runs: Runs, states: Array) -> Array:
    """States (n, N) after the law has decided anew."""
    function = _reset_function(runs.structure)
    count = runs.count
    parameters, body = (
        np.broadcast_to(v if v.ndim == 2 else v[:, None], (v.shape[0], count))
        for v in (runs.parameters, runs.body)
    )
    return function(states, parameters, body)[0]


@lru_cache(maxsize=64)
def _reset_function(structure: Structure) -> ArrayFunction:
    """New states at a reset instant, from (states, parameters, body)."""
    import casadi as ca

    loop = representative_loop(structure)
    changes = loop.law.reset(loop.plant, loop.controller_states, loop.parameter_symbols)
    new = ca.SX(loop.state)
    for i, controller in enumerate(loop.law.controller_states):
        if controller.name in changes:
            new[7 + i] = changes[controller.name]
    arguments = [loop.state, loop.parameters, loop.body]
    return ArrayFunction(shared(walk(ca.Function("reset", arguments, [new]))))
