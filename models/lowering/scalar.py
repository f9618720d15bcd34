"""A program as one plain Python function of floats: the quickest right-hand side for a single run.

Calling a CasADi function from Python costs more in conversions than its arithmetic; the emitted
function has none. Results are bit-identical to CasADi's as long as only + - * / and square
roots occur; the others are the C library's, as CasADi's are.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Mapping, Sequence
from typing import Any

from .walk import Program, check_operations

ScalarFunction = Callable[..., list[float]]

TEMPLATES: Mapping[str, str] = {
    "assign": "{0}",
    "add": "{0} + {1}",
    "sub": "{0} - {1}",
    "mul": "{0} * {1}",
    "div": "{0} / {1}",
    "neg": "-{0}",
    "sq": "{0} * {0}",
    "twice": "{0} + {0}",
    "inv": "1.0 / {0}",
    "sqrt": "sqrt({0})",
    "pow": "pow({0}, {1})",
    "constpow": "pow({0}, {1})",
    "exp": "exp({0})",
    "log": "log({0})",
    "sin": "sin({0})",
    "cos": "cos({0})",
    "tan": "tan({0})",
    "asin": "asin({0})",
    "acos": "acos({0})",
    "atan": "atan({0})",
    "atan2": "atan2({0}, {1})",
    "sinh": "sinh({0})",
    "cosh": "cosh({0})",
    "tanh": "tanh({0})",
    "hypot": "hypot({0}, {1})",
    "fabs": "abs({0})",
    "fmin": "({0} if {0} < {1} else {1})",
    "fmax": "({0} if {0} > {1} else {1})",
    "lt": "float({0} < {1})",
    "le": "float({0} <= {1})",
    "eq": "float({0} == {1})",
    "ne": "float({0} != {1})",
    "not": "float(not {0})",
    "and": "float(bool({0} and {1}))",
    "or": "float(bool({0} or {1}))",
    "if_else_zero": "({1} if {0} else 0.0)",
    "floor": "float(floor({0}))",
    "ceil": "float(ceil({0}))",
    "copysign": "copysign({0}, {1})",
    "sign": "(1.0 if {0} > 0.0 else -1.0 if {0} < 0.0 else {0})",
}

_REPEATED = frozenset({"sq", "twice", "fmin", "fmax", "sign"})
_MAX_INLINED = 400


def emit_scalar(program: Program) -> ScalarFunction:
    """Compile a program into a Python function of sequences of floats.

    The function takes one sequence of floats for each argument and returns the elements of all
    results in one list, result after result. Where CasADi would return an infinity or a NaN
    (division by zero, root of a negative) it raises ZeroDivisionError, OverflowError or
    ValueError.

    Raises
    ------
    UnknownOperationError
        If the program uses an operation that plain Python has no counterpart for.
    """
    check_operations(program, TEMPLATES, "the scalar backend")
    namespace: dict[str, Any] = dict(vars(math))
    exec(compile(scalar_source(program), f"<{program.name}>", "exec"), namespace)  # noqa: S102 - own text
    function: ScalarFunction = namespace["emitted"]
    return function


def scalar_source(program: Program) -> str:
    """Python source of the function `emit_scalar` compiles; values used once are written in place."""
    text = {v: f"x{v}" for v in program.inputs}
    text.update(
        {v: f"({c!r})" if math.copysign(1.0, c) < 0 else repr(c) for v, c in program.constants.items()}
    )
    uses = _use_counts(program)
    lines = [f"def emitted({', '.join(f'a{i}' for i in range(len(program.argument_sizes)))}):"]
    lines += [f"    x{v} = a{a}[{e}]" for v, (a, e) in program.inputs.items()]
    for step in program.steps:
        expression = TEMPLATES[step.operation].format(*(text[o] for o in step.operands))
        if uses.get(step.result, 0) == 1 and len(expression) < _MAX_INLINED:
            text[step.result] = f"({expression})"
        else:
            text[step.result] = f"v{step.result}"
            lines.append(f"    v{step.result} = {expression}")
    elements = ["0.0" if v is None else text[v] for row in program.results for v in row]
    return "\n".join([*lines, f"    return [{', '.join(elements)}]", ""])


def _use_counts(program: Program) -> dict[int, int]:
    """Times each value's text would be written."""
    counts: dict[int, int] = {}
    used: list[Sequence[int | None]] = list(program.results)
    for step in program.steps:
        used.append(step.operands * 3 if step.operation in _REPEATED else step.operands)
    for values in used:
        for v in values:
            if v is not None:
                counts[v] = counts.get(v, 0) + 1
    return counts
