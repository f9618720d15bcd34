"""Inequalities tried against the law's own motion: a comparison system that is wrong is mostly caught here.

At random states each component is put on what it bounds, the others there or loosely beyond, and its true
slope (the chain rule on the closed loop) is compared with the slope that the system allows. Passing proves
nothing; a violation is a contradiction, and the system is not used.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import casadi as ca
import numpy as np

from ...models.closed_loop import body_values, close_loop
from ...models.laws import Law
from ...models.rigid_body import RigidBody
from ...models.types import Array
from ..flow.inequalities import StatedSystem, outermost
from .comparison import BodyBounds
from .law_system import LawSystem
from .recognise import NoComparisonError, law_words

STATES = 400
"""States tried on each body: half of them with attitude and rate along the axis of least inertia."""
TOLERANCE = 1e-9
"""Relative to the slopes: both are formed in floats."""


def require_sound(law: Law, system: LawSystem, bounds: BodyBounds, *, states: int = STATES) -> None:
    """Raise NoComparisonError with the state where the law's motion contradicts its comparison system."""
    found = contradiction(law, system, bounds, states=states)
    if found is not None:
        raise NoComparisonError(
            f"the proof that {law_words(law)} brings is contradicted by its motion: {found}"
        )


def contradiction(law: Law, system: LawSystem, bounds: BodyBounds, *, states: int = STATES) -> str | None:
    """Return a state at which a component would be crossed, in words; None where none was found."""
    loop = close_loop(law)
    measures = dict(system.measures(loop))
    if set(measures) != set(system.names):
        return "it does not say what each of its components bounds (measures)"
    values = [ca.SX(measures[name]) for name in system.names]
    rates = [loop.total_derivative(value) for value in values]
    function = loop.function("measures", ca.vertcat(*values), ca.vertcat(*rates))
    generator = np.random.default_rng(1)
    for body in _bodies(bounds):
        constants = (loop.parameter_values(), body_values(body))
        for number in range(states):
            state, time = _draw(loop.state.numel(), loop.time.numel(), generator, along_axis=number % 2 == 0)
            held, slopes = (np.array(x).ravel() for x in function(state, time, *constants))
            if not np.isfinite([*held, *slopes]).all():
                continue
            true = dict(zip(system.names, slopes.tolist(), strict=True))
            at = dict(zip(system.names, held.tolist(), strict=True))
            for part in _systems(system, at):
                wrong = _crossed(part, at, true, float(time[0]) ** 2, generator)
                if wrong:
                    place = f"b0 = {state[0]:.4g}, w = ({', '.join(f'{x:.4g}' for x in state[4:7])}) rad/s"
                    return f"at {place}, g = {time[0]:.4g}, {wrong}"
    return None


def _bodies(bounds: BodyBounds) -> Sequence[RigidBody]:
    """Two bodies at the ends of the bounds: a sphere, and one with a single axis of least inertia."""
    least, greatest, zero = bounds.least, bounds.greatest, Fraction(0)
    rows = [[(least, greatest, greatest)[i] if i == j else zero for j in range(3)] for i in range(3)]
    ball = [[least if i == j else zero for j in range(3)] for i in range(3)]
    return (RigidBody.from_rows(ball), RigidBody.from_rows(rows))


def _draw(size: int, times: int, generator: np.random.Generator, *, along_axis: bool) -> tuple[Array, Array]:
    """Draw a state and (g, g', signals): a unit quaternion, a rate, controller states > 0."""
    s = generator.uniform(0.02, 1.4)
    axis, rate = generator.normal(size=3), generator.normal(size=3) * generator.choice([0.01, 0.3, 1.0])
    if along_axis:
        axis = np.array([1.0, *(generator.normal(size=2) * 1e-3)])
        rate = axis * generator.normal() * generator.choice([0.01, 0.3, 1.0])
    b0 = 1 - s * s
    bv = axis / np.linalg.norm(axis) * np.sqrt(max(1 - b0 * b0, 0.0))
    controller = generator.uniform(0.05, 3.0, size=size - 7)
    time = generator.normal(size=times)
    time[0] = generator.choice([0.0, 1.0, generator.uniform()])
    return np.concatenate([[b0], bv, rate, controller]), time


def _systems(system: LawSystem, at: Mapping[str, float]) -> Sequence[StatedSystem]:
    """The system, and that of a part that repeats."""
    repeating, _ = system.tail([at[name] for name in system.names])
    return (system, repeating) if isinstance(repeating, StatedSystem) else (system,)


def _crossed(
    system: StatedSystem,
    at: Mapping[str, float],
    true: Mapping[str, float],
    G: float,
    generator: np.random.Generator,
) -> str:
    """Say which component would be crossed, with all on what they bound, and with the others loosened."""
    names = system.names
    for touching in names:
        loosen = generator.uniform(1.0, 2.0, size=len(names)) ** generator.integers(0, 2, size=len(names))
        x = [
            at[name] if name == touching else at[name] * (factor if sign > 0 else 1 / factor)
            for name, sign, factor in zip(names, system.signs, loosen.tolist(), strict=True)
        ]
        for modes in system.choices(x, 1.0):
            if any(float(value) < 0 for value in system.signs_of(x, modes, system.floats)):
                continue
            slopes = system.slopes(G, x, modes, system.floats)
            if touching not in slopes:
                continue
            sign = system.signs[names.index(touching)]
            allowed = outermost(slopes[touching], sign)
            excess = sign * (true[touching] - allowed)
            if excess > TOLERANCE * (abs(true[touching]) + abs(allowed) + 1e-6):
                return (
                    f"{touching} moves by {true[touching]:.6g} where it touches its bound, "
                    f"and the inequality allows {allowed:.6g}"
                )
    return ""
