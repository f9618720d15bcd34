"""Common subexpressions computed once, values nobody uses dropped, divisions by 2, 4, ... multiplied.

The model is written for the reader, so J w, J bv or g^2 kappa occur in several terms. Sharing
them changes no rounding: a shared value is the same operation on the same operands (+ and * are
commutative in floating point too). Neither does x / 2 as x * 0.5: both round the same number, and
a product is many times cheaper than a quotient.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import replace

from .walk import Program, Step

COMMUTATIVE = frozenset({"add", "mul", "eq", "ne", "and", "or"})


def shared(program: Program) -> Program:
    """The same program with every distinct operation carried out once, bit-identical."""
    program = _without_power_of_two_divisors(program)
    same: dict[int, int] = {}
    constants: dict[str, int] = {}
    for v, c in program.constants.items():
        same[v] = constants.setdefault(c.hex(), v)
    known: dict[tuple[str, tuple[int, ...]], int] = {}
    steps: list[Step] = []
    for step in program.steps:
        operands = tuple(same.get(o, o) for o in step.operands)
        key = tuple(sorted(operands)) if step.operation in COMMUTATIVE else operands
        if step.operation == "assign":
            same[step.result] = operands[0]
            continue
        first = known.setdefault((step.operation, key), step.result)
        if first == step.result:
            steps.append(replace(step, operands=operands))
        else:
            same[step.result] = first
    results = tuple(tuple(None if v is None else same.get(v, v) for v in row) for row in program.results)
    kept = _needed(steps, results)
    return replace(
        program,
        inputs={v: where for v, where in program.inputs.items() if v in kept},
        constants={v: c for v, c in program.constants.items() if v in kept},
        steps=tuple(step for step in steps if step.result in kept),
        results=results,
    )


def _without_power_of_two_divisors(program: Program) -> Program:
    """Each x / c with c a power of two as x * (1 / c): the same number, rounded once."""
    constants, count = dict(program.constants), program.value_count
    reciprocals: dict[int, int] = {}
    steps: list[Step] = []
    for step in program.steps:
        if step.operation == "div" and _is_power_of_two(program.constants, step.operands[1]):
            divisor = step.operands[1]
            if divisor not in reciprocals:
                reciprocals[divisor], constants[count] = count, 1.0 / constants[divisor]
                count += 1
            step = Step("mul", step.result, (step.operands[0], reciprocals[divisor]))
        steps.append(step)
    return replace(program, constants=constants, steps=tuple(steps), value_count=count)


def _is_power_of_two(constants: Mapping[int, float], value: int) -> bool:
    """Whether a value is a constant +-2^k whose reciprocal is a normal number too."""
    if value not in constants:
        return False
    mantissa, exponent = math.frexp(constants[value])
    return abs(mantissa) == 0.5 and -1020 < exponent < 1020


def _needed(steps: list[Step], results: tuple[tuple[int | None, ...], ...]) -> set[int]:
    needed = {v for row in results for v in row if v is not None}
    for step in reversed(steps):
        if step.result in needed:
            needed.update(step.operands)
    return needed
