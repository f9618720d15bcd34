"""The attitude loop linearised about the target: its local rates, by Floquet analysis.

At b0 = 1, w = 0 the controller states follow their own equilibrium motion (the filter R its
periodic steady state, the adaptive gain a constant); deviations (bv, w) obey a linear system of
the schedule's period. For the family with gain kappa all six exponents are -mean(g^2 kappa), in
defective pairs: -lambda/2 for the persistence filter whatever schedule and inertia, -k mean(g^2)
for the adaptive scaling.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final

import numpy as np

from .closed_loop import body_values, close_loop
from .floquet import Floquet
from .laws import Law
from .lowering import emit_scalar, shared, walk
from .rigid_body import RigidBody
from .schedule import Schedule
from .simulation.phases import Phase, phase_arguments, phases_between, signal_degree
from .types import Array

TOLERANCE = 1e-13
NEWTON_STEPS = 8


@final
@dataclass(frozen=True, eq=False)
class LocalRates:
    """Local stability of a law about the target attitude.

    Attributes
    ----------
    floquet : of the deviations (bv, w), (6, 6)
    controller_states : at the start of the period, on their periodic motion, by name
    """

    floquet: Floquet
    controller_states: dict[str, float]


def local_rates(
    law: Law, body: RigidBody, schedule: Schedule, *, controller_states: Mapping[str, float] | None = None
) -> LocalRates:
    """Floquet analysis of the linearised attitude loop over one period of the schedule.

    Parameters
    ----------
    law, body, schedule : Law, RigidBody, Schedule
        What is analysed; the schedule must be periodic.
    controller_states : mapping, optional
        Where the search for the controller's periodic motion starts: a state that rests at the target (the
        adaptive gain) keeps this value. The law's initial values unless given.

    Raises
    ------
    ValueError
        If the schedule is not periodic, a name is unknown, or no periodic motion is found.
    """
    if schedule.period is None:
        raise ValueError("local rates need a periodic schedule: give it a period")
    names = [s.name for s in law.controller_states]
    values = {s.name: float(s.initial) for s in law.controller_states} | dict(controller_states or {})
    if unknown := sorted(set(values) - set(names)):
        raise ValueError(f"law {law.name} has no controller state {unknown[0]}; it has {names}")
    phases = phases_between(schedule, law, 0 * schedule.period, schedule.period)
    system = _System(law, body, phases)
    start = np.array([values[name] for name in names])
    for _ in range(NEWTON_STEPS):
        end, sensitivity, monodromy = system.period_map(start)
        gap = end - start
        if np.all(np.abs(gap) <= 1e-12 * np.maximum(np.abs(start), 1e-3)):
            floquet = Floquet(float(schedule.period), monodromy)
            return LocalRates(floquet, dict(zip(names, start.tolist(), strict=True)))
        # a state that rests anywhere leaves its direction free: least squares does not move it
        start = start + np.linalg.lstsq(np.eye(start.size) - sensitivity, gap, rcond=1e-9)[0]
    raise ValueError(f"law {law.name}: the controller states find no periodic motion at the target")


class _System:
    """Controller states, their sensitivity and the deviations' transition, integrated together."""

    def __init__(self, law: Law, body: RigidBody, phases: tuple[Phase, ...]) -> None:
        loop = close_loop(law)
        self._phases, self._degree = phases, signal_degree(phases)
        self._count = len(law.controller_states)
        self._function = emit_scalar(_lowered(law, self._degree))
        self._parameters = loop.parameter_values().tolist()
        self._body = body_values(body).tolist()

    def period_map(self, start: Array) -> tuple[Array, Array, Array]:
        """Controller states after a period, their sensitivity to `start`, and the monodromy matrix."""
        from scipy.integrate import solve_ivp

        c = self._count
        state = np.concatenate([start, np.eye(c).ravel(), np.eye(6).ravel()])
        for phase in self._phases:
            field = self._field(phase)
            span = (float(phase.start - phase.origin), float(phase.end - phase.origin))
            solution = solve_ivp(field, span, state, method="DOP853", rtol=TOLERANCE, atol=TOLERANCE / 100)
            state = solution.y[:, -1]
        sensitivity = state[c : c + c * c].reshape(c, c, order="F")
        return state[:c], sensitivity, state[c + c * c :].reshape(6, 6, order="F")

    def _field(self, phase: Phase) -> Any:
        coefficients = phase.coefficient_array(self._degree).ravel(order="F").tolist()
        function, parameters, body = self._function, self._parameters, self._body

        def evaluate(tau: float, z: Array) -> list[float]:
            return function((tau,), z.tolist(), coefficients, parameters, body)

        return evaluate


@lru_cache(maxsize=32)
def _lowered(law: Law, degree: int) -> Any:
    """Rates of (controller states, their sensitivity, transition) as a program."""
    import casadi as ca

    loop = close_loop(law)
    tau, coefficients, time = phase_arguments(loop, degree)
    at_target = ca.vertcat(1, ca.SX.zeros(6), loop.state[7:])
    count = loop.state.numel() - 7

    def there(expression: Any) -> Any:
        return ca.substitute([expression], [loop.state, loop.time], [at_target, time])[0]

    # the six deviations: bv' and w' by bv and w (b0 deviates in second order only)
    deviations = there(ca.jacobian(loop.state_rate[1:7], loop.state[1:7]))
    controller_rate = there(loop.state_rate[7:])
    controller_jacobian = there(ca.jacobian(loop.state_rate[7:], loop.state[7:]))
    sensitivity, transition = ca.SX.sym("D", count, count), ca.SX.sym("X", 6, 6)
    z = ca.vertcat(loop.state[7:], ca.vec(sensitivity), ca.vec(transition))
    rates = ca.vertcat(
        controller_rate, ca.vec(controller_jacobian @ sensitivity), ca.vec(deviations @ transition)
    )
    arguments = [tau, z, coefficients, loop.parameters, loop.body]
    return shared(walk(ca.Function("linearised", arguments, [ca.densify(rates)])))
