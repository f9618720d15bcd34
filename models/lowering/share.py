"""Common subexpressions computed once, values nobody uses dropped.

The model is written for the reader, so J w, J bv or g^2 kappa occur in several terms. Sharing
them changes no rounding: a shared value is the same operation on the same operands (+ and * are
commutative in floating point too).
"""

from __future__ import annotations

from dataclasses import replace

from .walk import Program, Step

COMMUTATIVE = frozenset({"add", "mul", "eq", "ne", "and", "or"})


def shared(program: Program) -> Program:
    """The same program with every distinct operation carried out once, bit-identical."""
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


def _needed(steps: list[Step], results: tuple[tuple[int | None, ...], ...]) -> set[int]:
    needed = {v for row in results for v in row if v is not None}
    for step in reversed(steps):
        if step.result in needed:
            needed.update(step.operands)
    return needed
