"""The right-hand side of a run on CasADi's own buffers, and one phase of it integrated in local time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from typing import final

import numpy as np

from ..closed_loop import ClosedLoop, body_values
from ..rigid_body import RigidBody
from ..types import Array
from .phases import Phase, phase_field

MAX_EVALUATIONS = 2_000_000
"""Right-hand sides of one run, some 10 microseconds each."""
PACE = 50_000
"""Right-hand sides after which a run's pace is looked at."""
TINY = 1e-300
"""Keeps a quotient by no progress finite."""
HOPELESS = 50
"""A run that at its pace would take this many times MAX_EVALUATIONS stops at once."""
AHEAD = 1e-9
"""How far ahead of a state, relative to the time, a law that is no number is looked for."""
LAST_STEPS, GROWTH = 50, 10.0
"""A state that grew so much within the last steps before their size vanished escapes; else they are stiff."""


class SimulationError(RuntimeError):
    """A run that could not be carried to its horizon: it says when it stopped and why."""


@final
@dataclass(frozen=True, eq=False)
class Passage:
    """A phase integrated.

    Attributes
    ----------
    times : (m,), s from the phase's start
    states : (n, m)
    dense : s from the phase's start -> states, (n, len)
    """

    times: Array
    states: Array
    dense: Callable[[Array], Array]


@final
class RightHandSide:
    """Right-hand side on CasADi's own buffers: no conversion of arrays at each call."""

    def __init__(self, loop: ClosedLoop, body: RigidBody, degree: int) -> None:
        function = phase_field(loop, degree)
        self.count = 0
        self._seen: float | None = None
        self.state_names = loop.state_names
        self._tau = np.zeros(1)
        self._state = np.zeros(loop.state.shape[0])
        self._coefficients = np.zeros((degree + 1, loop.time.shape[0] // 2))
        self._rate = np.zeros(loop.state.shape[0])
        self._parameters, self._body = loop.parameter_values(), body_values(body)
        self._degree = degree
        # the buffer must outlive this object's calls: CasADi keeps no reference of its own
        self._buffer, self._evaluate = function.buffer()
        inputs = (self._tau, self._state, self._coefficients, self._parameters, self._body)
        for i, value in enumerate(inputs):
            self._buffer.set_arg(i, value.data)
        self._buffer.set_res(0, self._rate.data)

    def through(
        self, phase: Phase, state: Array, rtol: float, atol: Array | float, horizon: float
    ) -> Passage:
        """Integrate a phase in time counted from its start: its steps do not depend on the origin of time.

        Raises
        ------
        SimulationError
            If the step size vanishes, a state is no longer a number, or the run goes on without end.
        """
        from scipy.integrate import solve_ivp

        field = self._in_phase(phase, horizon)
        _require_number(field, float(phase.start), 0.0, state)
        with np.errstate(over="ignore", invalid="ignore"):  # a trial step may overshoot: it is refused
            solution = solve_ivp(
                field, (0.0, float(phase.end - phase.start)), state,
                method="DOP853", rtol=rtol, atol=atol, dense_output=True,
            )  # fmt: skip
        if not solution.success or not np.all(np.isfinite(solution.y[:, -1])):
            at = float(phase.start) + float(solution.t[-1])
            _require_number(field, float(phase.start), float(solution.t[-1]), solution.y[:, -1])
            raise SimulationError(_why_stopped(self.state_names, at, solution.y))
        return Passage(solution.t, solution.y, solution.sol)

    def _in_phase(self, phase: Phase, horizon: float) -> Callable[[float, Array], Array]:
        """Right-hand side (s from the phase's start, x) -> x'; it stops a run that goes on without end."""
        # CasADi matrices are column-major, numpy's row-major: the transpose has the right layout
        self._coefficients[...] = phase.coefficient_array(self._degree).T
        start, offset = float(phase.start), float(phase.start - phase.origin)

        def evaluate(t: float, x: Array) -> Array:
            self.count += 1
            if self.count % PACE == 0 or self.count > MAX_EVALUATIONS:
                self._require_pace(start + t, horizon)
            self._tau[0] = offset + t
            self._state[:] = x
            self._evaluate()
            return self._rate.copy()

        return evaluate

    def _require_pace(self, t: float, horizon: float) -> None:
        """Stop a run that has used its right-hand sides, or will by far at the pace of its last ones."""
        before, self._seen = self._seen, t
        to_come = 0.0 if before is None else PACE * (horizon - t) / max(t - before, TINY)
        if self.count <= MAX_EVALUATIONS and to_come <= HOPELESS * MAX_EVALUATIONS:
            return
        pace = f", and would take {to_come:.1g} more" if to_come > self.count else ""
        raise SimulationError(
            f"the run stopped at t = {t:.6g} s after {min(self.count, MAX_EVALUATIONS)} right-hand sides"
            f"{pace}: its quickest motion is far quicker than its horizon is long; give a shorter horizon, "
            "or slower parameters"
        )


def _require_number(field: Callable[[float, Array], Array], start: float, t: float, state: Array) -> None:
    """Refuse a state, or one just ahead of it, at which the law is no number.

    Raises
    ------
    SimulationError
        With the instant and the state.
    """
    if not np.all(np.isfinite(state)):
        return
    rate = field(t, state)
    if np.all(np.isfinite(rate)) and np.all(np.isfinite(field(t, state + AHEAD * max(1.0, t) * rate))):
        return
    values = [", ".join(f"{x:.6g}" for x in part) for part in (state[:4], state[4:7])]
    raise SimulationError(
        f"the run stopped at t = {start + t:.6g} s: the law is not a number there (0/0, or a function "
        f"outside its range), at quaternion ({values[0]}), rate ({values[1]}) rad/s"
    )


def _why_stopped(names: tuple[str, ...], time: float, states: Array) -> str:
    """Say why, from the steps (n, m) up to there."""
    state = states[:, -1]
    if not np.all(np.isfinite(state)):
        return f"the run stopped at t = {time:.6g} s: a state is no longer a number"
    largest = int(np.argmax(np.abs(state)))
    before = abs(states[largest, max(0, states.shape[1] - LAST_STEPS)])
    if abs(state[largest]) > GROWTH * before:
        return (
            f"the run stopped at t = {time:.6g} s: the step size vanished while {names[largest]} grew to "
            f"{state[largest]:.3g} (a state that escapes in finite time does this)"
        )
    return (
        f"the run stopped at t = {time:.6g} s: the steps it needs are below the spacing of numbers there, "
        "and no state grows: its quickest motion is too quick (stiff); lower the law's gains and rates"
    )
