"""The jumps of a model, found by the one walk: each is a held value, and the argument that switches it."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any, final

import casadi as ca

from .operations import FIELD
from .walk import Program, evaluate, walk

JUMPS: Mapping[str, tuple[Callable[..., Any], Callable[..., Any]]] = {
    "sign": (ca.sign, lambda x: x),
    "floor": (ca.floor, lambda x: x),
    "ceil": (ca.ceil, lambda x: x),
    "lt": (lambda x, y: x < y, lambda x, y: y - x),
    "le": (lambda x, y: x <= y, lambda x, y: y - x),
    "fmod": (lambda x, y: ca.if_else(x / y < 0, ca.ceil(x / y), ca.floor(x / y)), lambda x, y: x / y),
    "remainder": (lambda x, y: ca.floor(x / y + 0.5), lambda x, y: x / y),
    "eq": (lambda x, y: x == y, lambda x, y: x - y),
    "ne": (lambda x, y: x != y, lambda x, y: x - y),
}
"""Operation -> what jumps in it, and the continuous argument whose passage makes it jump."""

_NAMES = (
    "sqrt exp log sin cos tan asin acos atan atan2 sinh cosh tanh asinh acosh atanh log1p expm1 hypot fabs "
    "fmin fmax erf"
)
_TABLE: Mapping[str, Callable[..., Any]] = {
    **FIELD,
    **{name: getattr(ca, name) for name in _NAMES.split()},
    "pow": lambda x, y: x**y,
    "constpow": lambda x, y: x**y,
    "not": ca.logic_not,
    "and": ca.logic_and,
    "or": ca.logic_or,
    "if_else_zero": lambda condition, x: ca.if_else(condition, x, 0),
}


@final
@dataclass(frozen=True, eq=False)
class JumpSplit:
    """A function with its jumps taken out.

    Attributes
    ----------
    arguments : SX, as of the function
    values : SX (m,), the jumping values as the arguments make them
    sources : SX (m,), the argument that switches each value, the jumping values held
    held : SX (m,), symbols of the held values
    result : SX, the function's first result with the jumping values held: smooth but for kinks
    """

    arguments: tuple[Any, ...]
    values: Any
    sources: Any
    held: Any
    result: Any


def jumps(program: Program) -> bool:
    """Whether a program has an operation that jumps."""
    return bool(program.operations & (JUMPS.keys() | {"copysign"}))


def split_jumps(function: Any) -> JumpSplit | None:
    """Take the jumps out of a CasADi SX function; None if it has none.

    Raises
    ------
    UnknownOperationError
        If the function has an operation that is in no table.
    """
    program = walk(function)
    if not jumps(program):
        return None
    arguments = tuple(ca.SX.sym(f"a{i}", *function.size_in(i)) for i in range(function.n_in()))
    true = _Recorder(hold=False)
    _run(program, true, arguments)
    held = _Recorder(hold=True)
    result = _run(program, held, arguments)
    shape = function.size_out(0)
    return JumpSplit(
        arguments, ca.vertcat(*true.values), ca.vertcat(*held.sources), ca.vertcat(*held.values),
        ca.reshape(ca.vertcat(*result), *shape),
    )  # fmt: skip


@final
class _Recorder:
    """Carries out jumping operations, keeps their values and sources, and may hold the values as symbols."""

    def __init__(self, *, hold: bool) -> None:
        self._hold = hold
        self.values: list[Any] = []
        self.sources: list[Any] = []

    def operation(self, name: str) -> Callable[..., Any]:
        """The operation of that name, recorded."""
        value_of, source_of = JUMPS[name]

        def carry_out(*operands: Any) -> Any:
            value = ca.SX.sym(f"held{len(self.values)}") if self._hold else ca.SX(value_of(*operands))
            self.values.append(value)
            self.sources.append(ca.SX(source_of(*operands)))
            return value

        return carry_out


def _run(program: Program, recorder: _Recorder, arguments: tuple[Any, ...]) -> list[Any]:
    sign = recorder.operation("sign")
    table = {
        **_TABLE,
        **{name: recorder.operation(name) for name in JUMPS},
        "copysign": lambda x, y: ca.fabs(x) * sign(y),
        **{name: _modulo(recorder.operation(name)) for name in ("fmod", "remainder")},
    }
    elements = [ca.vertsplit(ca.vec(ca.densify(a))) if a.numel() else [] for a in arguments]
    row = evaluate(program, table, elements, ca.SX)[0]
    return [ca.SX(x) for x in row]


def _modulo(quotient: Callable[..., Any]) -> Callable[..., Any]:
    return lambda x, y: x - y * quotient(x, y)
