"""One run of a closed loop, integrated phase by phase with dense output."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

import numpy as np
from numpy.typing import ArrayLike

from ..closed_loop import ClosedLoop, Saturation, body_values, close_loop
from ..laws import Law
from ..lowering import UnknownOperationError
from ..rigid_body import RigidBody
from ..schedule import Schedule
from ..types import Array
from .phases import Phase, phase_field, phases_between, signal_degree
from .switching import SlidingError, Switching, jumping_functions
from .trajectory import Segment, Trajectory

KNOWN = 1000
"""A filter state is known while it is above this many absolute tolerances: to some 0.1 per cent."""
MAX_EVALUATIONS = 2_000_000
"""Right-hand sides of one run, some 10 microseconds each."""
PACE = 50_000
"""Right-hand sides after which a run's pace is looked at."""
TINY = 1e-300
"""Keeps a quotient by no progress finite."""
HOPELESS = 50
"""A run that at its pace would take this many times MAX_EVALUATIONS stops at once."""
LAST_STEPS, GROWTH = 50, 10.0
"""A state that grew so much within the last steps before their size vanished escapes; else they are stiff."""


class SimulationError(RuntimeError):
    """A run that could not be carried to its horizon: it says when it stopped and why."""


@final
@dataclass(frozen=True, kw_only=True)
class DOP853:
    """Dormand-Prince 8(5,3), scipy's, restarted at every phase.

    Attributes
    ----------
    rtol, atol : local tolerances; the defaults keep the paper's scenario within 1e-8 relative
        of a run at 1e-13
    """

    rtol: float = 1e-11
    atol: float = 1e-13

    def __post_init__(self) -> None:
        if not (0 < self.rtol < 1 and self.atol > 0):
            raise ValueError(f"tolerances must be positive: rtol {self.rtol}, atol {self.atol}")


def simulate(
    law: Law,
    body: RigidBody,
    schedule: Schedule,
    *,
    quaternion: ArrayLike,
    rate: ArrayLike,
    horizon: Fraction,
    start: Fraction = Fraction(0),
    saturation: Saturation | None = None,
    method: DOP853 | None = None,
) -> Trajectory:
    """Simulate a law on a body through a schedule, from one state.

    Parameters
    ----------
    law, body, schedule : Law, RigidBody, Schedule
        What is simulated.
    quaternion : ArrayLike
        (4,), scalar first, unit; error attitude against the target.
    rate : ArrayLike
        (3,), rad/s, body frame.
    horizon, start : Fraction
        End and start of the run, s.
    saturation : Saturation, optional
        Limit on the applied torque; no claim of the package covers a saturated run (the adaptive gain can
        even escape in finite time there: its rate grows like k^2 once the torque no longer holds Omega down).
    method : DOP853, optional
        Integrator and its tolerances.

    Raises
    ------
    ValueError
        If the quaternion is not unit to 1e-9 or the horizon is not after the start.
    SimulationError
        If the state leaves the numbers (an unstable law may), the step size vanishes, or a law that
        jumps would slide along a switching surface or switches without end.
    """
    q = np.asarray(quaternion, dtype=float)
    if q.shape != (4,) or abs(np.linalg.norm(q) - 1) > 1e-9:
        raise ValueError(
            f"the initial quaternion must be unit, shape (4,): received norm {np.linalg.norm(q)}"
        )
    loop = close_loop(law, saturation)
    phases = phases_between(schedule, law, start, horizon)
    degree = signal_degree(phases)
    state = loop.initial_state(q, np.asarray(rate, dtype=float))
    method = method if method is not None else DOP853()
    field = _RightHandSide(loop, body, degree)
    reset = _reset_map(loop)
    try:
        functions = jumping_functions(loop, degree)
    except UnknownOperationError as unknown:
        raise SimulationError(f"the law jumps, and its switches cannot be located: {unknown}") from None
    switching = None
    if functions is not None:
        switching = Switching(functions, degree, loop.parameter_values(), body_values(body))
    segments: list[Segment] = []
    for phase in phases:
        if phase.resets:
            state = reset(state, loop.parameter_values(), body_values(body))
        if switching is None:
            segments.append(_integrate_phase(field, phase, state, method, float(horizon)))
        else:
            segments += _integrate_switching(switching, phase, state, method)
        state = segments[-1].end_state
        _require_known_gain(loop, segments[-1], method)
    count = field.count if switching is None else switching.evaluations
    return Trajectory(loop, body, schedule, tuple(segments), count)


def _integrate_switching(switching: Switching, phase: Phase, state: Array, method: DOP853) -> list[Segment]:
    try:
        return switching.through(phase, state, method.rtol, method.atol)
    except (SlidingError, FloatingPointError) as stopped:
        raise SimulationError(str(stopped)) from None


class _RightHandSide:
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

    def in_phase(self, phase: Phase, horizon: float) -> Callable[[float, Array], Array]:
        """Right-hand side (t, x) -> x' with the phase's signals; it stops a run that goes on without end."""
        # CasADi matrices are column-major, numpy's row-major: the transpose has the right layout
        self._coefficients[...] = phase.coefficient_array(self._degree).T
        origin = float(phase.origin)

        def evaluate(t: float, x: Array) -> Array:
            self.count += 1
            if self.count % PACE == 0 or self.count > MAX_EVALUATIONS:
                self._require_pace(t, horizon)
            self._tau[0] = t - origin
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


def _integrate_phase(
    field: _RightHandSide, phase: Phase, state: Array, method: DOP853, horizon: float
) -> Segment:
    from scipy.integrate import solve_ivp

    start, end = float(phase.start), float(phase.end)
    solution = solve_ivp(
        field.in_phase(phase, horizon), (start, end), state,
        method="DOP853", rtol=method.rtol, atol=method.atol, dense_output=True,
    )  # fmt: skip
    if not solution.success or not np.all(np.isfinite(solution.y[:, -1])):
        raise SimulationError(_why_stopped(field.state_names, solution.t[-1], solution.y))
    return Segment(phase, solution.t, solution.y, solution.sol)


def _require_known_gain(loop: ClosedLoop, segment: Segment, method: DOP853) -> None:
    """Refuse a run whose gain divides by a filter state that has decayed into the integration's error.

    Through a long idle stretch R falls as exp(-lambda t), and what is left of it is noise, its sign included.

    Raises
    ------
    SimulationError
        Saying when, and what R would have to be.
    """
    import casadi as ca

    R, gain = loop.controller_states.get("R"), loop.control.gain
    if R is None or gain is None or not ca.depends_on(ca.SX(gain), R):
        return
    values, least = segment.states[loop.state_names.index("R")], KNOWN * method.atol
    if values.min() < least:
        at = float(segment.times[int(np.argmax(values < least))])
        raise SimulationError(
            f"the run stopped at t = {at:.6g} s: R has decayed below {least:g} s, where its value is the "
            "integration's error, and the gain divides by it; shorten the idle time before, or lower lambda"
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


def _reset_map(loop: ClosedLoop) -> Callable[[Array, Array, Array], Array]:
    """New state at a reset instant, from (state, parameters, body)."""
    import casadi as ca

    changes = loop.law.reset(loop.plant, loop.controller_states, loop.parameter_symbols)
    new = ca.SX(loop.state)
    for i, controller in enumerate(loop.law.controller_states):
        if controller.name in changes:
            new[7 + i] = changes[controller.name]
    function = ca.Function("reset", [loop.state, loop.parameters, loop.body], [new])

    def apply(*values: Array) -> Array:
        result: Any = function(*values)
        return np.asarray(result, dtype=float).ravel()

    return apply
