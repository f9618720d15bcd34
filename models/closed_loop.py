"""The closed loop, once: rigid body, schedule signals and a law as one set of CasADi expressions.

Simulation, sampling, proofs and optimisation all start here. Inertia, law parameters and the
values of g stay symbols, so one loop serves every body and every parameter set.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass
from fractions import Fraction
from functools import lru_cache
from typing import Any, final

import casadi as ca
import numpy as np

from .laws import Control, Expression, Law, PlantSymbols, TimeSymbols
from .laws.scaled import augmented_rate
from .norms import LARGEST_COMPONENT, Norm
from .rigid_body import RigidBody, attitude_rate, momentum_rate
from .types import Array

PLANT_STATES = ("b0", "b1", "b2", "b3", "w1", "w2", "w3")
INERTIA_NAMES = ("J11", "J12", "J13", "J22", "J23", "J33")
INERTIA_ENTRIES = ((0, 0), (0, 1), (0, 2), (1, 1), (1, 2), (2, 2))
"""Positions of those names in J."""


@final
@dataclass(frozen=True)
class Saturation:
    """A limit on the applied torque, N m, block by block: components clipped, lengths scaled back."""

    limit: Fraction
    norm: Norm = LARGEST_COMPONENT

    def apply(self, torque: Expression) -> Expression:
        """Limited torque, as an expression."""
        return self.norm.limited(torque, float(self.limit))


@final
@dataclass(frozen=True, eq=False)
class ClosedLoop:
    """Symbols and expressions of one closed loop.

    Attributes
    ----------
    state : SX (n,): b0, b1, b2, b3, w1, w2, w3 (rad/s), then the controller states
    body : SX (12,): the six entries of J (kg m^2, row-wise upper triangle), then of J^-1
    parameters : SX (m,): the law's parameters, in order of `law.parameters`
    time : SX (2 + 2 s,): g, g' (1/s), then each signal of the law and its rate
    plant, time_symbols : the same symbols as a law sees them
    controller_states, parameter_symbols : SX by name
    control : what the law returned
    applied_torque : SX (3,): g u after saturation, N m
    momentum_rate : SX (3,): J w', N m, free of J^-1
    state_rate : SX (n,): x'
    """

    law: Law
    saturation: Saturation | None
    state: Expression
    body: Expression
    parameters: Expression
    time: Expression
    plant: PlantSymbols
    time_symbols: TimeSymbols
    controller_states: Mapping[str, Expression]
    parameter_symbols: Mapping[str, Expression]
    control: Control
    applied_torque: Expression
    momentum_rate: Expression
    state_rate: Expression

    @property
    def state_names(self) -> tuple[str, ...]:
        """Names in the order of `state`."""
        return (*PLANT_STATES, *(s.name for s in self.law.controller_states))

    @property
    def arguments(self) -> tuple[Expression, ...]:
        """Arguments of every function made from the loop: (state, time, parameters, body)."""
        return (self.state, self.time, self.parameters, self.body)

    @property
    def augmented_rate(self) -> Expression:
        """Omega = w + 2 g^2 kappa bv, rad/s; for a law outside the family, w itself."""
        if self.control.gain is None:
            return self.plant.w
        return augmented_rate(self.plant, self.time_symbols, self.control.gain)

    @property
    def augmented_momentum_rate(self) -> Expression:
        """J Omega' along the closed loop, N m, free of J^-1."""
        gain, gain_rate = self.control.gain, self.control.gain_rate
        if gain is None or gain_rate is None:
            return self.momentum_rate
        g, g_rate, bv = self.time_symbols.g, self.time_symbols.g_rate, self.plant.bv
        shift = 2 * g * g_rate * gain * bv + g**2 * (gain_rate * bv + gain * self.plant.bv_rate)
        return self.momentum_rate + 2 * (self.plant.J @ shift)

    def total_derivative(self, expression: Expression) -> Expression:
        """d/dt of an expression in (state, g, signals) along the closed loop."""
        along_state = ca.jtimes(expression, self.state, self.state_rate)
        direction = ca.SX.zeros(self.time.shape[0])
        for i in range(0, self.time.shape[0], 2):
            direction[i] = self.time[i + 1]
        return along_state + ca.jtimes(expression, self.time, direction)

    def has_true_gain_rate(self) -> bool:
        """Whether the stated rate of the gain is its rate along the loop, at two ordinary states."""
        gain, stated = self.control.gain, self.control.gain_rate
        if gain is None or stated is None:
            return True
        function = self.function("gain_rate", self.total_derivative(ca.SX(gain)), ca.SX(stated))
        sizes = [argument.numel() for argument in self.arguments]
        for start in (0.37, 0.71):
            values = [np.array([0.3 + (start + 0.618 * i) % 1 for i in range(size)]) for size in sizes]
            rate, said = (float(x) for x in function(*values))
            if np.isfinite([rate, said]).all() and abs(rate - said) > 1e-9 * (1 + abs(rate) + abs(said)):
                return False
        return True

    def strays(self, *expressions: Expression) -> list[str]:
        """Names of the symbols in expressions that are none of the loop's own."""
        known = {s.element_hash() for s in ca.symvar(ca.veccat(*self.arguments))}
        return sorted({s.name() for s in ca.symvar(ca.veccat(*expressions)) if s.element_hash() not in known})

    def function(self, name: str, *expressions: Expression) -> Any:
        """CasADi function (state, time, parameters, body) -> expressions."""
        return ca.Function(name, list(self.arguments), list(expressions))

    def initial_state(self, quaternion: Array, rate: Array) -> Array:
        """State vector (n,) from a unit quaternion (4,) and a rate (3,), rad/s."""
        controller = [float(s.initial) for s in self.law.controller_states]
        return np.concatenate([np.asarray(quaternion, float), np.asarray(rate, float), controller])

    def parameter_values(self) -> Array:
        """The law's parameters as floats, in order, (m,)."""
        return np.array([float(v) for v in self.law.parameters.values()])


def body_values(body: RigidBody) -> Array:
    """The 12 numbers of `ClosedLoop.body` for a rigid body."""
    J, inverse = body.inertia, body.inverse_inertia
    return np.array([J[i, j] for i, j in INERTIA_ENTRIES] + [inverse[i, j] for i, j in INERTIA_ENTRIES])


def close_loop(law: Law, saturation: Saturation | None = None) -> ClosedLoop:
    """Build the closed loop of a law, symbolically.

    Loops are remembered; a law that is changed, by class or by instance, gets its own.

    Raises
    ------
    ValueError
        If the law returns a torque that is not (3,), not one rate for each controller state, uses a
        symbol that it was not given, or gives one name twice.
    """
    return _close_loop(law, saturation, _identity(law))


_PARTS = ("control", "parameters", "controller_states", "signals", "__getattribute__", "__getattr__")


def _identity(law: Law) -> tuple[object, ...]:
    """What tells laws apart that call themselves equal: class, methods, and attributes that are no fields."""
    kind = type(law)
    known = {f.name for f in fields(kind)} if is_dataclass(kind) else set[str]()
    parts = tuple(getattr(kind, name, None) for name in _PARTS)
    extra = [(name, id(value)) for name, value in vars(law).items() if name not in known]
    return (kind, parts, id(law) if extra else 0, *extra)


@lru_cache(maxsize=64)
def _close_loop(law: Law, saturation: Saturation | None, identity: tuple[object, ...]) -> ClosedLoop:
    del identity
    b0, bv, w = ca.SX.sym("b0"), ca.SX.sym("bv", 3), ca.SX.sym("w", 3)
    body = ca.SX.sym("body", 12)
    J, inverse = _symmetric(body[:6]), _symmetric(body[6:])
    b0_rate, bv_rate = attitude_rate(b0, bv, w)
    plant = PlantSymbols(b0, bv, w, J, b0_rate, bv_rate)
    _check_names(law)
    states = {s.name: ca.SX.sym(s.name) for s in law.controller_states}
    parameters = {name: ca.SX.sym(name) for name in law.parameters}
    time = _time_symbols(law)
    control = law.control(plant, time, states, parameters)
    _check_control(law, control, states)
    again = law.control(plant, time, states, parameters)
    _check_control(law, again, states)
    torque = time.g * control.torque
    torque = saturation.apply(torque) if saturation is not None else torque
    Jw_rate = momentum_rate(J, w, _acting(control, torque))
    rates = [control.state_rates[name] for name in states]
    signals = [x for name in time.signals for x in (time.signals[name], time.signal_rates[name])]
    loop = ClosedLoop(
        law=law,
        saturation=saturation,
        state=ca.vertcat(b0, bv, w, *states.values()),
        body=body,
        parameters=ca.vertcat(*parameters.values()) if parameters else ca.SX(0, 1),
        time=ca.vertcat(time.g, time.g_rate, *signals),
        plant=plant,
        time_symbols=time,
        controller_states=states,
        parameter_symbols=parameters,
        control=control,
        applied_torque=torque,
        momentum_rate=Jw_rate,
        state_rate=ca.vertcat(b0_rate, bv_rate, inverse @ Jw_rate, *rates),
    )
    if strays := loop.strays(loop.state_rate):
        raise ValueError(f"law {law.name} uses the symbol {strays[0]}, which is none of those it was given")
    _check_repeatable(loop, again)
    return loop


def _acting(control: Control, torque: Expression) -> Expression:
    """What acts on the body where the thrusters are asked for a torque."""
    if control.thrust is not None:
        torque = control.thrust @ torque
    return torque if control.disturbance is None else torque + control.disturbance


def _check_repeatable(loop: ClosedLoop, again: Control) -> None:
    """Refuse a law that returns something else when it is asked again: a run would not be what was proved."""
    law, names = loop.law, list(loop.controller_states)
    both = [ca.veccat(c.torque, *(c.state_rates[name] for name in names)) for c in (loop.control, again)]
    if strays := loop.strays(both[1]):
        raise ValueError(f"law {law.name} uses the symbol {strays[0]}, which is none of those it was given")
    sizes = [argument.numel() for argument in loop.arguments]
    values = [np.array([0.3 + (0.37 + 0.618 * i) % 1 for i in range(size)]) for size in sizes]
    first, second = (np.array(x) for x in loop.function("twice", *both)(*values))
    if not np.array_equal(first, second, equal_nan=True):
        raise ValueError(
            f"law {law.name} returns another torque or rate when it is asked again: control must depend "
            "on its arguments alone (no counters, no random numbers)"
        )


def _symmetric(entries: Expression) -> Expression:
    matrix = ca.SX(3, 3)
    for entry, (i, j) in enumerate(INERTIA_ENTRIES):
        matrix[i, j] = entries[entry]
        matrix[j, i] = entries[entry]
    return matrix


def _time_symbols(law: Law) -> TimeSymbols:
    names = [signal.name for signal in law.signals]
    return TimeSymbols(
        ca.SX.sym("g"),
        ca.SX.sym("g_rate"),
        {name: ca.SX.sym(name) for name in names},
        {name: ca.SX.sym(f"{name}_rate") for name in names},
    )


def _check_names(law: Law) -> None:
    names = [*(s.name for s in law.controller_states), *(s.name for s in law.signals), *law.parameters]
    twice = next((name for i, name in enumerate(names) if name in names[:i]), None)
    if twice is not None:
        raise ValueError(f"law {law.name}: two of its states, signals and parameters are called {twice!r}")
    stated: Mapping[str, object] = law.parameters  # a class of the user's may return anything
    for name, value in stated.items():
        if isinstance(value, bool) or not isinstance(value, (int, Fraction)):
            raise TypeError(
                f"law {law.name}: parameter {name} must be exact, an int or a Fraction, received {value!r} "
                f"({type(value).__name__})"
            )


def _check_control(law: Law, control: Any, states: Mapping[str, Expression]) -> None:
    if not isinstance(control, Control):
        raise TypeError(
            f"law {law.name}: control must return a Control(torque, ...), received {type(control).__name__}"
        )
    for what, value in (("torque", control.torque), *control.state_rates.items()):
        if isinstance(value, (list, tuple, np.ndarray)):
            kind = type(value).__name__
            raise TypeError(
                f"law {law.name}: {what} must be an expression, not {kind}: build it with casadi.vertcat"
            )
    shape = ca.SX(control.torque).shape
    if shape != (3, 1):
        raise ValueError(f"law {law.name}: the torque must have shape (3,), received {shape}")
    if set(control.state_rates) != set(states):
        raise ValueError(
            f"law {law.name}: expected rates for {sorted(states)}, received {sorted(control.state_rates)}"
        )
