"""The default backend: all runs of a stack through each phase, then on to the next."""

from __future__ import annotations

from dataclasses import dataclass, replace
from functools import lru_cache
from typing import final

import numpy as np
from numpy.typing import NDArray

from ..lowering import ArrayFunction, shared, walk
from ..simulation.coasting import coasting_decays
from ..simulation.integrate import LEAST_FILTER_STATE, divides_by_filter
from ..simulation.phases import Phase, signal_degree
from ..types import Array
from .field import StackedField, Structure, representative_loop
from .runs import Runs
from .step import Index, Mask, Observer, Step, nested
from .steps import Stack, Tolerances

COEFFICIENTS = 7
"""Coefficients of a step's interpolant."""
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

    A run whose state leaves the numbers, or whose step shrinks to nothing, stops alone. So does one whose
    gain divides by a filter state of which a coast has left nothing, and a
    run of a law that jumps, where it chatters: no integrator gets past a surface that it slides along.
    """
    loop = representative_loop(runs.structure)
    parameters = runs.parameters if runs.parameters.ndim == 2 else runs.parameters[:, None]
    decay = coasting_decays(loop, np.broadcast_to(parameters, (parameters.shape[0], runs.count)))
    field = StackedField(
        runs.structure, runs.parameters, runs.body, degree=signal_degree(phases), held=decay is not None
    )
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
            span, coasts = (float(phase.start), float(phase.end)), phase.is_torque_free and decay is not None
            atol = None if coasts else _absolute(ends.states[:, alive], decay, alive, tolerances)
            stack = Stack(field, alive, ends.states[:, alive], *span, tolerances, atol)
            if decay is None or not coasts:
                _through(stack, observers, ends)
                continue
            known = _Known(decay, span[0])
            _through(stack, tuple(_Coasting(o, known) for o in observers), ends)
            known.finish(ends, observers, alive, span[1])
            if divides_by_filter(loop):
                R = ends.states[loop.state_names.index("R"), alive]
                ends.stop_times[alive[R < LEAST_FILTER_STATE]] = span[1]
    return ends


def _absolute(states: Array, decay: Array | None, alive: Index, tolerances: Tolerances) -> Array | None:
    """Absolute tolerances (n, m): those of states that decay in coasts are no more than relative ones."""
    if decay is None or not decay.size:
        return None
    atol = np.full(states.shape, tolerances.atol)
    size = np.abs(states[-len(decay) :])
    relative = tolerances.rtol * np.maximum(size, LEAST_FILTER_STATE)
    scaled = (decay[:, alive] > 0) & (size > 0)
    atol[-len(decay) :] = np.where(scaled, np.minimum(relative, tolerances.atol), tolerances.atol)
    return atol


@final
@dataclass(frozen=True, eq=False)
class _Known:
    """What the controller states (c, N) do in a coast that begins at `start`, s: they decay as known."""

    decay: Array
    start: float

    def finish(self, ends: Ends, observers: tuple[Observer, ...], alive: Index, end: float) -> None:
        """Put in the states at the end of the coast, and show them as a step of no length."""
        arrived = alive[np.isnan(ends.stop_times[alive])]
        count = len(self.decay)
        if not count or not arrived.size:
            return
        ends.states[-count:, arrived] *= np.exp(-self.decay[:, arrived] * (end - self.start))
        states = np.ascontiguousarray(ends.states[:, arrived].T)
        still = np.zeros((arrived.size, COEFFICIENTS, states.shape[1]))
        at, none = np.full(arrived.size, end), np.zeros(arrived.size)
        for observer in observers:
            observer.see(Step(arrived, at, at, none, states, still, nested))


@final
class _Coasting(Observer):
    """Shows another observer the steps of a coast with the controller states as they decay."""

    def __init__(self, observer: Observer, known: _Known) -> None:
        self._observer, self._known = observer, known

    def see(self, step: Step) -> None:
        """Pass the step on."""
        decay = np.ascontiguousarray(self._known.decay[:, step.runs].T)
        shown = step if not decay.size else replace(step, decay=decay, since=self._known.start)
        self._observer.see(shown)


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
