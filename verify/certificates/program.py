"""CasADi expressions as lines of a certificate: "v7 = mul b1 v3", "v2 = const 1/2"."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from math import isfinite
from typing import final

import casadi as ca

from ...models.laws import Expression
from ...models.lowering import Program, walk
from .format import exact_text

OPERATIONS = frozenset({"assign", "neg", "sq", "twice", "inv", "add", "sub", "mul", "div"})
"""What the stand-alone checker can carry out on polynomials."""


class NotAlgebraicError(ValueError):
    """An expression that is not built of + - * / alone."""


@final
@dataclass(frozen=True)
class Lines:
    """Instructions, and for each result the names of its elements."""

    instructions: tuple[str, ...]
    results: tuple[tuple[str, ...], ...]


def write_lines(symbols: Mapping[str, Expression], results: Sequence[Expression]) -> Lines:
    """Write expressions as instructions of the certificate.

    Parameters
    ----------
    symbols : mapping of name to scalar SX symbol
        What the expressions may depend on; names as the certificate knows them.
    results : sequence of SX
        The expressions; elements in column-major order.

    Raises
    ------
    NotAlgebraicError
        If an expression uses another operation (a root, a sine, a case distinction), a constant that
        is not finite, or a symbol that is none of these.
    """
    return _lines(algebraic_program(symbols, results), list(symbols))


def algebraic_program(symbols: Mapping[str, Expression], results: Sequence[Expression]) -> Program:
    """Program of expressions of these symbols, each an argument of its own.

    Raises
    ------
    NotAlgebraicError
        As `write_lines`.
    """
    known = {symbol.element_hash() for symbol in symbols.values()}
    strays = sorted({s.name() for s in ca.symvar(ca.veccat(*results)) if s.element_hash() not in known})
    if strays:
        raise NotAlgebraicError(f"the expression uses {', '.join(strays)}, which nothing here defines")
    function = ca.Function("program", list(symbols.values()), list(results))
    program = walk(function)
    strange = sorted(program.operations - OPERATIONS)
    if strange:
        raise NotAlgebraicError(f"the expression uses {', '.join(strange)}; only + - * / can be proved here")
    for constant in program.constants.values():
        if not isfinite(constant):
            raise NotAlgebraicError(f"the expression holds the constant {constant}")
    return program


def _lines(program: Program, names: Sequence[str]) -> Lines:
    name = {v: names[argument] for v, (argument, _) in program.inputs.items()}
    lines: list[str] = []
    for v, constant in program.constants.items():
        name[v] = f"v{v}"
        lines.append(f"v{v} = const {exact_text(Fraction(constant))}")
    for step in program.steps:
        name[step.result] = f"v{step.result}"
        operands = " ".join(name[o] for o in step.operands)
        lines.append(f"v{step.result} = {step.operation} {operands}")
    zero = f"v{program.value_count}"
    if any(v is None for row in program.results for v in row):
        lines.append(f"{zero} = const 0")
    results = tuple(tuple(zero if v is None else name[v] for v in row) for row in program.results)
    return Lines(tuple(lines), results)
