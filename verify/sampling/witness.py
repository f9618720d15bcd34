"""A violation found in floats, moved to a rational state and evaluated again in balls.

The attitude is put exactly on S^3 by stereographic projection from a rational point; every other
coordinate is the float itself. The result encloses V' at that state: if it excludes 0 the claim
V' <= 0 is false there, whatever floats said.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from fractions import Fraction
from typing import Any, Literal

from ...models.lowering import FIELD, evaluate, walk
from ...models.rigid_body import RigidBody
from ...models.types import Array
from ..exact.ball import float_above, float_below
from ..exact.direction import sphere_point
from ..exact.rational import rational
from ..lyapunov.exact_states import body_entries
from ..verdict import Quantity, Witness
from .domain import SampledDomain
from .function import RESULTS, DerivativeFunction

PRECISION = 256
"""Bits of the balls."""
DENOMINATOR = 10**6
"""Denominator of the rationals near the floats: a witness that can be written down."""


def exact_witness(
    check: DerivativeFunction,
    body: RigidBody,
    domain: SampledDomain,
    coordinates: Array,
    *,
    weight: Fraction,
    gain_target: Fraction,
    violated: Literal["rate", "stated"] = "rate",
) -> Witness | None:
    """Witness against V' <= 0 ("rate") or against V' as stated ("stated") near a float state.

    Returns
    -------
    Witness or None
        None if the enclosure of the violation does not exclude 0, or the law's expressions use an
        operation that balls do not have.
    """
    if walk(check.function).operations - ball_table().keys():
        return None
    state = _rational_state(coordinates, domain)
    parameters = list(check.loop.law.parameters.values())
    # J_min enters only the paper's bound, which no witness uses.
    extra = [weight, gain_target, Fraction(0)]
    arguments = [state, parameters, body_entries(body.exact_inertia), extra]
    values = dict(zip(RESULTS, _evaluate(check.function, arguments), strict=True))
    if violated == "rate":
        violation, name = values["rate"], "V'"
    else:
        violation, name = values["by_differentiation"] - values["stated"], "V' minus V' as stated"
    if not violation.is_finite():
        return None
    low, high = float_below(violation), float_above(violation)
    if violated == "rate" and not low > 0:
        return None
    if low <= 0 <= high:
        return None
    return Witness(
        description=f"{name} at a rational state, evaluated in balls of {PRECISION} bits",
        values=_named(check, state),
        violation=Quantity("storage_rate", low, high, "kg m^2/s^2", f"{name} at the state", rigorous=True),
    )


def _rational_state(coordinates: Array, domain: SampledDomain) -> list[Fraction]:
    """Rational coordinates near the floats, inside the domain, with the attitude exactly unit."""
    low, high = domain.bounds()
    q = [float(x) for x in coordinates[:4]]
    sign = 1 if q[0] >= 0 else -1
    s = [Fraction(x / (1 + abs(q[0]))).limit_denominator(DENOMINATOR) for x in q[1:]]
    scalar, *vector = sphere_point(s)
    others = []
    for value, a, b in zip(coordinates[4:], low, high, strict=True):
        near = Fraction(float(value)).limit_denominator(DENOMINATOR)
        others.append(min(max(near, Fraction(a)), Fraction(b)))
    return [sign * scalar, *vector, *others]


def _evaluate(function: Any, arguments: Sequence[Sequence[Fraction]]) -> list[Any]:
    import flint

    with flint.ctx.workprec(PRECISION):
        balls = [[flint.arb(rational(x)) for x in row] for row in arguments]
        results = evaluate(walk(function), ball_table(), balls, flint.arb)
    return [row[0] for row in results]


def ball_table() -> Mapping[str, Callable[..., Any]]:
    """Operations on balls: those of a field, and what a law's expression may add."""
    names = ("sqrt", "exp", "log", "sin", "cos", "tan", "atan", "sinh", "cosh", "tanh")
    functions = {name: _method(name) for name in names}
    choices = {"fmin": lambda x, y: x.min(y), "fmax": lambda x, y: x.max(y)}
    return {**FIELD, **functions, **choices, "fabs": abs}


def _method(name: str) -> Callable[[Any], Any]:
    def apply(x: Any) -> Any:
        return getattr(x, name)()

    return apply


def _named(check: DerivativeFunction, state: Sequence[Fraction]) -> dict[str, float | list[float]]:
    rate_name = "Omega" if check.uses_augmented_rate else "w"
    values: dict[str, float | list[float]] = {
        "beta": [float(x) for x in state[:4]],
        rate_name: [float(x) for x in state[4:7]],
    }
    names = [*check.loop.controller_states, "g", "g_rate"]
    return values | {name: float(x) for name, x in zip(names, state[7:], strict=True)}
