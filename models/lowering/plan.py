"""How a program becomes numpy calls: what is computed once, what for each sample, and in which buffer."""

from __future__ import annotations

from collections.abc import Mapping
from typing import final

import numpy as np

from .walk import Program

EMIT: Mapping[str, str] = {
    "assign": "copyto({out}, {0})",
    "add": "add({0}, {1}, {out})",
    "sub": "subtract({0}, {1}, {out})",
    "mul": "multiply({0}, {1}, {out})",
    "div": "divide({0}, {1}, {out})",
    "neg": "negative({0}, {out})",
    "sq": "multiply({0}, {0}, {out})",
    "twice": "add({0}, {0}, {out})",
    "inv": "divide(1.0, {0}, {out})",
    "sqrt": "sqrt({0}, {out})",
    "pow": "power({0}, {1}, {out})",
    "constpow": "power({0}, {1}, {out})",
    "exp": "exp({0}, {out})",
    "log": "log({0}, {out})",
    "sin": "sin({0}, {out})",
    "cos": "cos({0}, {out})",
    "tan": "tan({0}, {out})",
    "asin": "arcsin({0}, {out})",
    "acos": "arccos({0}, {out})",
    "atan": "arctan({0}, {out})",
    "atan2": "arctan2({0}, {1}, {out})",
    "sinh": "sinh({0}, {out})",
    "cosh": "cosh({0}, {out})",
    "tanh": "tanh({0}, {out})",
    "hypot": "hypot({0}, {1}, {out})",
    "fabs": "absolute({0}, {out})",
    "fmin": "fmin({0}, {1}, {out})",
    "fmax": "fmax({0}, {1}, {out})",
    "lt": "less({0}, {1}, {out})",
    "le": "less_equal({0}, {1}, {out})",
    "eq": "equal({0}, {1}, {out})",
    "ne": "not_equal({0}, {1}, {out})",
    "not": "logical_not({0}, {out})",
    "and": "logical_and({0}, {1}, {out})",
    "or": "logical_or({0}, {1}, {out})",
    "floor": "floor({0}, {out})",
    "ceil": "ceil({0}, {out})",
    "copysign": "copysign({0}, {1}, {out})",
    "sign": "sign({0}, {out})",
    "if_else_zero": "if_else_zero({0}, {1}, {out})",
}


@final
class Plan:
    """Places for all values of a program.

    Attributes
    ----------
    body : numpy calls made for every block
    once : assignments of the values that depend on uniform arguments only
    buffer_count : block buffers needed
    """

    def __init__(self, program: Program, uniform: frozenset[int]) -> None:
        self.program = program
        self.arguments = range(len(program.argument_sizes))
        self.text: dict[int, str] = {v: f"c{v}" for v in program.constants}
        self.constants = {f"c{v}": np.array(c) for v, c in program.constants.items()}
        self.once: list[str] = []
        self.known: list[str] = []
        self.body: list[str] = []
        self.buffer_count = 0
        self._free: list[int] = []
        self._held: dict[int, int] = {}
        self._varying: set[int] = set()
        for v, (a, e) in program.inputs.items():
            if a in uniform:
                self._know(v, f"a{a}[{e}]")
            else:
                self._varying.add(v)
                self.text[v] = f"x{v}"
        self._last = program.last_uses()
        self._place_of: dict[int, tuple[int, int]] = {}
        for j, row in enumerate(program.results):
            self._place_of.update({v: (j, e) for e, v in enumerate(row) if v is not None})
        for i, step in enumerate(program.steps):
            self._place(i, step.operation, step.result, step.operands)

    def _know(self, v: int, expression: str) -> None:
        self.text[v] = f"k{v}"
        self.known.append(f"k{v}")
        self.once.append(f"k{v} = {expression}")

    def _place(self, i: int, operation: str, result: int, operands: tuple[int, ...]) -> None:
        used = [self.text[o] for o in operands]
        if not self._varying.intersection(operands):
            once = "{0}" if operation == "assign" else EMIT[operation].replace(", {out}", "")
            self._know(result, once.format(*used))
            return
        self._varying.add(result)
        for o in {o for o in operands if self._last[o] == i}:
            if o in self._held:
                self._free.append(self._held.pop(o))
        if result in self._place_of:
            j, e = self._place_of[result]
            self.text[result] = out = f"r{j}_{e}"
        else:
            if not self._free:
                self._free.append(self.buffer_count)
                self.buffer_count += 1
            self._held[result] = self._free.pop()
            self.text[result] = out = f"b{self._held[result]}"
        self.body.append(EMIT[operation].format(*used, out=out))

    def source(self) -> str:
        """Two functions: `once` (uniform values) and `body` (one block)."""
        program, known = self.program, "".join(f"{k}, " for k in self.known)
        once = [f"def once({', '.join(f'a{i}' for i in self.arguments)}):"]
        once += [f"    {line}" for line in self.once] + [f"    return ({known})"]
        body = ["def body(rows, results, buffers, known, start, stop):", f"    ({known}) = known"]
        if self.buffer_count:
            body.append(f"    ({''.join(f'b{i}, ' for i in range(self.buffer_count))}) = buffers")
        used = {o for s in program.steps for o in s.operands} | {v for row in program.results for v in row}
        for v, (a, e) in program.inputs.items():
            if v in used and self.text[v].startswith("x"):
                body.append(f"    x{v} = rows[{a}][{e}, start:stop]")
        written = set(self.text.values())
        places = [(j, e) for j, row in enumerate(program.results) for e in range(len(row))]
        body += [f"    r{j}_{e} = results[{j}][{e}, start:stop]" for j, e in places if f"r{j}_{e}" in written]
        body += [f"    {line}" for line in self.body]
        for j, e in places:
            value = program.results[j][e]
            text = "0.0" if value is None else self.text[value]
            if text != f"r{j}_{e}":
                body.append(f"    results[{j}][{e}, start:stop] = {text}")
        return "\n".join([*once, *body, ""])
