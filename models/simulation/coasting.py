"""Coasts: while g = 0 the body turns freely, and controller states that only decay are known exactly.

A filter's R' = -lambda R has the solution R(t0) exp(-lambda (t - t0)): it is written down, not integrated,
so that a coast costs what the body's turns cost, from rest nothing, and R keeps its digits however small.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from fractions import Fraction
from functools import lru_cache
from typing import Any

import casadi as ca
import numpy as np

from ..closed_loop import ClosedLoop, close_loop
from ..laws.free_motion import FreeMotion
from ..types import Array
from .nutation import closes, is_repetitive, kept_times, rate_period, repeated, turns
from .phases import Phase
from .right_hand_side import Passage, SimulationError
from .trajectory import Segment

MAX_TURNS = 8000
"""Turns of one coast: each costs some 200 right-hand sides, about 2 ms."""
PLANT = 7
"""States of the body: they come first."""


def coasting_decay(loop: ClosedLoop) -> Array | None:
    """Decay rates (m,), 1/s, of the controller states while g = 0; None where one does anything else.

    None too where a disturbance acts: the body then does not turn freely, nor stays at rest.

    State i is then x_i(t0) exp(-rate_i (t - t0)), exactly: its rate at g = g' = 0 is -rate_i x_i for a
    rate_i that depends on the law's parameters alone.
    """
    function = _decay_function(loop)
    if function is None or loop.control.disturbance is not None:
        return None
    values: Any = function(loop.parameter_values())
    return np.asarray(values, dtype=float).ravel()


def coasting_decays(loop: ClosedLoop, parameters: Array) -> Array | None:
    """The same (m, N) for N sets of parameters (p, N)."""
    function = _decay_function(loop)
    return None if function is None else np.asarray(function(parameters), dtype=float)


@lru_cache(maxsize=64)
def _decay_function(loop: ClosedLoop) -> Any:
    """CasADi function parameters -> decay rates (m,); None if a controller state is not of that kind."""
    names = [state.name for state in loop.law.controller_states]
    states = [loop.controller_states[name] for name in names]
    if not states:
        return ca.Function("no_states", [loop.parameters], [ca.SX(0, 1)])
    rates = ca.vertcat(*(loop.control.state_rates[name] for name in names))
    (idle,) = ca.substitute([rates], [loop.time[:2]], [ca.SX.zeros(2)])
    decay = []
    for i, state in enumerate(states):
        slope = ca.gradient(idle[i], state)
        (left,) = ca.substitute([idle[i]], [state], [ca.SX(0)])
        if not left.is_zero() or any(
            ca.depends_on(slope, symbols) for symbols in (loop.state, loop.time, loop.body)
        ):
            return None
        decay.append(-slope)
    return ca.Function("decay", [loop.parameters], [ca.vertcat(*decay)])


def free_loop() -> ClosedLoop:
    """Return the loop of a body that no torque acts on."""
    return close_loop(FreeMotion())


def turn_freely(
    phase: Phase, body: Array, inertia: Array, through: Callable[[Phase, Array], Passage]
) -> Passage:
    """Carry a body's state (7,) through a coast: period by period of its rate where that is long.

    Parameters
    ----------
    phase : Phase
        The coast.
    body : Array
        Attitude and rate at its start, (7,).
    inertia : Array
        (3, 3), kg m^2.
    through : Callable[[Phase, Array], Passage]
        Integrates a phase from a state.

    Raises
    ------
    SimulationError
        If the coast has more turns than can be followed, with the instant and their number.
    """
    rate, length = body[4:], float(phase.end - phase.start)
    period = rate_period(inertia, rate)
    if is_repetitive(rate, period, length) and turns(rate, period) < MAX_TURNS:
        one = through(replace(phase, end=phase.start + Fraction(period)), body)
        if closes(body, one.states[:, -1]):
            dense = repeated(one.dense, body, one.states[:, -1], period)
            times = kept_times(one.times, period, rate, length)
            return Passage(times, dense(times), dense)
    if (number := turns(rate, length)) > MAX_TURNS:
        size = float(np.linalg.norm(rate))
        raise SimulationError(
            f"the run stopped at t = {float(phase.start):.6g} s: from there the body coasts for "
            f"{length:.6g} s without torque at {size:.3g} rad/s, {number:.3g} turns: at most "
            f"{MAX_TURNS} of a coast can be followed; end the run before (simulation.horizon), or shorten "
            "the idle time"
        )
    return through(phase, body)


def coast(phase: Phase, state: Array, decay: Array, turn: Callable[[Array], Passage]) -> Segment:
    """Carry a state (n,) through a phase without torque; a body at rest stays as it is.

    Parameters
    ----------
    phase : Phase
        The phase, g = 0 in it.
    state : Array
        State at its start, (n,).
    decay : Array
        What `coasting_decay` gives, (m,).
    turn : Callable[[Array], Passage]
        Carries the body's own state (7,) through the phase.
    """
    start, length = float(phase.start), float(phase.end - phase.start)
    body, controller = state[:PLANT], state[PLANT:]
    if np.any(body[4:]):
        found = turn(body)
    else:
        still = np.stack([body, body], axis=1)
        found = Passage(
            np.array([0.0, length]), still, lambda s: np.repeat(body[:, None], np.size(s), axis=1)
        )

    def whole(local: Array, bodies: Array) -> Array:
        return np.vstack([bodies, controller[:, None] * np.exp(-decay[:, None] * local)])

    def dense(t: Array) -> Array:
        local = np.atleast_1d(np.asarray(t, dtype=float)) - start
        return whole(local, found.dense(local))

    times = start + found.times
    times[-1] = float(phase.end)
    return Segment(phase, times, whole(found.times, found.states), dense)
