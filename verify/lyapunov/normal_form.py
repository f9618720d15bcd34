"""A closed loop in exact polynomials on the unit sphere of quaternions.

Coordinates are c = 1 - b0, bv, y = w + shift and the controller states; the sphere makes
c^2 = 2 c - |bv|^2, so that every polynomial has one normal form, of degree at most 1 in c.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction

import casadi as ca

from ...models.closed_loop import ClosedLoop
from ...models.laws import Expression
from ...models.lowering import FIELD, evaluate
from ..certificates.program import algebraic_program
from ..exact.matrix import Rows
from ..exact.polynomial import Polynomial, Ring
from .candidates import Candidate
from .exact_states import body_entries, program_of
from .forms import symbol_names

ATTITUDE, RATE = ("b1", "b2", "b3"), ("y1", "y2", "y3")
FLOOR, ABOVE_FLOOR = "k_target", "s"


def on_sphere(p: Polynomial) -> Polynomial:
    """Return the normal form on the unit sphere."""
    ring = p.ring
    c = ring.symbol("c")
    return p.modulo(c * c - c * 2 + sum((ring.symbol(b) ** 2 for b in ATTITUDE), ring.constant(0)))


def decay_polynomials(
    candidate: Candidate, inertia: Rows, *, weight: Fraction | None
) -> tuple[Polynomial, Polynomial]:
    """Derive -V' and W at one inertia, in normal form, every parameter a number.

    Where V has the floor R_min = 1/k_target, R = (1 + s)/k_target with s >= 0.

    Raises
    ------
    NotPolynomialError
        If the law or V divides by something not known to be positive.
    """
    loop = candidate.loop
    states, timed = list(loop.controller_states), _timed(loop)
    positive = [FLOOR, *(name for name in states if name == "R")]
    ring = Ring([FLOOR, ABOVE_FLOOR, *states, *timed, "c", *ATTITUDE, *RATE], positive)
    known = {name: ring.symbol(name) for name in (*states, *timed)}
    extra = {
        FLOOR: (candidate.floor, ring.symbol(FLOOR)),
        "weight": (candidate.weight, ring.constant(weight if weight is not None else 1)),
    }
    used = {name: pair for name, pair in extra.items() if pair[0] is not None}

    def values(w: Sequence[Polynomial], *results: Expression) -> list[list[Polynomial]]:
        program = program_of(loop, [symbol for symbol, _ in used.values()], list(results))
        quaternion = [ring.constant(1) - ring.symbol("c"), *(ring.symbol(b) for b in ATTITUDE)]
        arguments = [
            [*quaternion, *w, *(known[name] for name in states)],
            [known[name] for name in timed],
            [ring.constant(x) for x in loop.law.parameters.values()],
            [ring.constant(x) for x in body_entries(inertia)],
            *([value] for _, value in used.values()),
        ]
        return evaluate(program, FIELD, arguments, ring.constant)

    y = [ring.symbol(name) for name in RATE]
    (shift,) = values(y, candidate.shift)
    w = [a - b for a, b in zip(y, shift, strict=True)]
    rate, reference = values(w, -loop.total_derivative(candidate.value), candidate.reference)
    pair = [on_sphere(rate[0]), on_sphere(reference[0])]
    if candidate.floor is not None:
        level = (ring.constant(1) + ring.symbol(ABOVE_FLOOR)) / ring.symbol(FLOOR)
        pair = [on_sphere(p.substitute("R", level)) for p in pair]
    return pair[0], pair[1]


def _timed(loop: ClosedLoop) -> list[str]:
    """Names of g, of the signals and of their rates, in the order of `ClosedLoop.time`."""
    return [f"{name}{end}" for name in ("g", *loop.time_symbols.signals) for end in ("", "_rate")]


def vanishes(
    loop: ClosedLoop,
    expression: Expression,
    extra: Mapping[str, Expression] | None = None,
    *,
    positive: Sequence[str] = ("R",),
    sphere: bool = False,
) -> bool:
    """Whether an expression is identically zero as a polynomial, every parameter and inertia a symbol.

    Parameters
    ----------
    loop : ClosedLoop
        Whose symbols it uses.
    expression : Expression
        Any shape.
    extra : Mapping[str, Expression], optional
        Further symbols that it uses, by name.
    positive : Sequence[str]
        Names that may be divided by.
    sphere : bool
        Whether it need be zero for |beta| = 1 only.

    Raises
    ------
    NotAlgebraicError, NotPolynomialError
        If it uses more than + - * /, or divides by something else.
    """
    symbols = symbol_names(loop) | dict(extra or {})
    program = algebraic_program(symbols, [ca.SX(expression)])
    ring = Ring(list(symbols), [name for name in symbols if name in positive])
    (values,) = evaluate(program, FIELD, [[ring.symbol(name)] for name in symbols], ring.constant)
    if sphere:
        unit = sum((ring.symbol(b) ** 2 for b in ("b0", *ATTITUDE)), ring.constant(-1))
        values = [p.modulo(unit) for p in values]
    return not any(values)
