"""One run of a closed loop, integrated phase by phase with dense output."""

from __future__ import annotations

import math
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
from .coasting import PLANT, coast, coasting_decay, free_loop, turn_freely
from .phases import Phase, phases_between, signal_degree
from .right_hand_side import Passage, RightHandSide, SimulationError
from .switching import SlidingError, Switching, jumping_functions
from .trajectory import Segment, Trajectory

KNOWN = 1000
"""A filter state that was integrated is known while it is above this many absolute tolerances."""
LEAST_FILTER_STATE = 1e-25
"""A filter state that a gain divides by may fall to this, s: below it the loop is too stiff to integrate."""
FINEST = 1e-13
"""Relative tolerance of one period that stands for many."""


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
    controller: ArrayLike | None = None,
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
    controller : ArrayLike, optional
        (m,) controller states at the start; by default the law's own initial values.
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
    if controller is not None:
        state[PLANT:] = np.asarray(controller, dtype=float)
    method = method if method is not None else DOP853()
    run = _Run(
        body,
        RightHandSide(loop, body, degree),
        RightHandSide(free_loop(), body, 0),
        coasting_decay(loop),
        _switching(loop, body, degree),
        method,
        float(horizon),
    )
    reset = _reset_map(loop)
    segments: list[Segment] = []
    for phase in phases:
        if phase.resets:
            state = reset(state, loop.parameter_values(), body_values(body))
        segments += run.through(phase, state)
        state = segments[-1].end_state
        _require_gain(loop, segments[-1], run.decay, method)
    return Trajectory(loop, body, schedule, tuple(segments), run.evaluations)


def _switching(loop: ClosedLoop, body: RigidBody, degree: int) -> Switching | None:
    """What carries a law that jumps from switch to switch; None for one that does not."""
    try:
        functions = jumping_functions(loop, degree)
    except UnknownOperationError as unknown:
        raise SimulationError(f"the law jumps, and its switches cannot be located: {unknown}") from None
    if functions is None:
        return None
    return Switching(functions, degree, loop.parameter_values(), body_values(body))


@final
@dataclass(frozen=True, eq=False)
class _Run:
    """What carries one run from phase to phase.

    Attributes
    ----------
    body : that turns
    field, free : right-hand sides of the closed loop, and of the body without torque
    decay : of `coasting_decay`
    switching : for a law that jumps
    """

    body: RigidBody
    field: RightHandSide
    free: RightHandSide
    decay: Array | None
    switching: Switching | None
    method: DOP853
    horizon: float

    def through(self, phase: Phase, state: Array) -> list[Segment]:
        """Segments of one phase.

        Raises
        ------
        SimulationError
            Where it cannot be carried to the phase's end.
        """
        method = self.method
        if phase.is_torque_free and self.decay is not None:
            return [coast(phase, state, self.decay, self._turn(phase))]
        atol = self._tolerances(state)
        if self.switching is not None:
            try:
                return self.switching.through(phase, state, method.rtol, atol)
            except (SlidingError, FloatingPointError) as stopped:
                raise SimulationError(str(stopped)) from None
        found = self.field.through(phase, state, method.rtol, atol, self.horizon)
        return [_segment(phase, found)]

    def _turn(self, phase: Phase) -> Callable[[Array], Passage]:
        """What carries the body's own state through a coast; one period of many, to the last digits."""

        def through(part: Phase, body: Array) -> Passage:
            exact = part.end < phase.end
            rtol, atol = (FINEST, FINEST / 100) if exact else (self.method.rtol, self.method.atol)
            return self.free.through(part, body, rtol, atol, self.horizon)

        return lambda body: turn_freely(phase, body, self.body.inertia, through)

    def _tolerances(self, state: Array) -> Array | float:
        """Absolute tolerances: those of states that decay in coasts are no more than relative ones."""
        if self.decay is None or not self.decay.size:
            return self.method.atol
        sizes = np.abs(state[-self.decay.size :])
        known = np.where(
            (self.decay > 0) & (sizes > 0),
            self.method.rtol * np.maximum(sizes, LEAST_FILTER_STATE),
            self.method.atol,
        )
        least = np.minimum(known, self.method.atol)
        return np.concatenate([np.full(state.size - least.size, self.method.atol), least])

    @property
    def evaluations(self) -> int:
        """Right-hand sides so far."""
        acting = self.field.count if self.switching is None else self.switching.evaluations
        return acting + self.free.count


def _segment(phase: Phase, found: Passage) -> Segment:
    """A passage in time counted from its phase's start, as part of the run."""
    start, times = float(phase.start), float(phase.start) + found.times
    times[-1] = float(phase.end)
    return Segment(phase, times, found.states, lambda t: found.dense(np.asarray(t) - start))


def divides_by_filter(loop: ClosedLoop) -> bool:
    """Whether a law's gain depends on its filter state R."""
    import casadi as ca

    R, gain = loop.controller_states.get("R"), loop.control.gain
    return R is not None and gain is not None and bool(ca.depends_on(ca.SX(gain), R))


def _require_gain(loop: ClosedLoop, segment: Segment, decay: Array | None, method: DOP853) -> None:
    """Refuse a run whose gain divides by a filter state of which nothing is left.

    Raises
    ------
    SimulationError
        Saying when; and, where R is known exactly, that this is what the law does.
    """
    if not divides_by_filter(loop):
        return
    values = segment.states[loop.state_names.index("R")]
    if decay is None and values.min() < KNOWN * method.atol:
        at = float(segment.times[int(np.argmax(values < KNOWN * method.atol))])
        raise SimulationError(
            f"the run stopped at t = {at:.6g} s: R has decayed below {KNOWN * method.atol:g} s, where its "
            "value is the integration's error, and the gain divides by it; shorten the idle time before"
        )
    if decay is None or values[-1] >= LEAST_FILTER_STATE:
        return
    rate = float(decay[list(loop.controller_states).index("R")])
    at = segment.times[0] + math.log(values[0] / LEAST_FILTER_STATE) / rate
    raise SimulationError(
        f"the run stopped at t = {at:.6g} s: while no window is open R falls as exp(-{rate:g} t), and is "
        f"below {LEAST_FILTER_STATE:g} s there: the filter has forgotten its start, and the next window "
        "begins with a gain of one over R. That is the law's own property: start the run later "
        "(initial.time), shorten the idle time, or lower lambda"
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
