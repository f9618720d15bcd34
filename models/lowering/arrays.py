"""A program over many samples at once: numpy calls that write into a few small, reused buffers.

Samples are kept as a structure of arrays, one row a quantity, and go through in blocks small
enough for the cache. Values that depend only on uniform arguments (inertia, law parameters) are
computed once a call, as scalars. As long as only + - * / and square roots occur, each a single
correctly rounded operation, results are bit-identical to CasADi's own evaluation.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from .walk import Program, check_arguments, check_operations

Array = NDArray[np.float64]

BLOCK = 4096
"""Samples a block: a program's live buffers (some forty of 32 kB) stay in the second-level cache."""

EXACT = frozenset(["assign", "add", "sub", "mul", "div", "neg", "sq", "twice", "inv", "sqrt"]) | frozenset(
    ["fabs", "copysign", "floor", "ceil", "fmin", "fmax"]
)
"""Operations numpy and CasADi round identically."""

_EMIT: Mapping[str, str] = {
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


def if_else_zero(condition: Any, value: Any, out: Array | None = None) -> Any:
    """`value` where `condition` is not 0, else exactly 0 (also where `value` is not finite)."""
    chosen = np.where(np.not_equal(condition, 0.0), value, 0.0)
    if out is None:
        return chosen
    np.copyto(out, chosen)
    return out


@final
class ArrayFunction:
    """A program emitted as numpy calls.

    Parameters
    ----------
    program : Program
    uniform : sequence of int
        Arguments that hold one set of numbers for all samples; the others have one for each.
    block : int
        Samples a block.

    Attributes
    ----------
    is_exact : bool
        Whether results are bit-identical to CasADi's (only correctly rounded operations occur).
    buffer_count : int
        Block buffers the program needs; memory is 8 * block * buffer_count bytes, whatever the
        number of samples.
    sample_operations : int
        numpy calls a block (operations that differ from sample to sample).
    """

    def __init__(self, program: Program, *, uniform: Sequence[int] = (), block: int = BLOCK) -> None:
        check_operations(program, _EMIT, "the array backend")
        if block < 1:
            raise ValueError(f"block must be at least 1 sample, received {block}")
        unknown = sorted(set(uniform) - set(range(len(program.argument_sizes))))
        if unknown:
            raise ValueError(f"function {program.name} has no argument {unknown[0]} to be uniform")
        self.program, self.block, self.uniform = program, block, frozenset(uniform)
        self.is_exact = program.operations <= EXACT
        plan = _Plan(program, self.uniform)
        self.buffer_count, self.sample_operations = plan.buffer_count, len(plan.body)
        self._local = threading.local()
        self._once, self._body = _compile(program.name, plan)
        self._result_sizes = tuple(len(row) for row in program.results)

    def __call__(self, *arguments: Array) -> list[Array]:
        """Evaluate (n_i, N) arrays, one row an element (uniform ones (n_i,)), into new (m_j, N) arrays."""
        rows, count = self._check(arguments)
        results = [np.empty((size, count)) for size in self._result_sizes]
        self.into(rows, results)
        return results

    def into(self, arguments: Sequence[Array], results: Sequence[Array]) -> None:
        """Evaluate into existing (m_j, N) arrays, apart from the arguments; allocates nothing of size N."""
        rows, count = self._check(arguments)
        if [r.shape for r in results] != [(size, count) for size in self._result_sizes]:
            raise ValueError(
                f"function {self.program.name}: expected results of shape "
                f"{[(size, count) for size in self._result_sizes]}, received {[r.shape for r in results]}"
            )
        with np.errstate(all="ignore"):
            self.run_blocks(rows, results, self.known(rows), count)

    def known(self, rows: Sequence[Array]) -> tuple[Array, ...]:
        """Values that depend on uniform arguments only: the same for every later `run_blocks` on them."""
        return tuple(np.asarray(value) for value in self._once(*rows))

    def run_blocks(
        self, rows: Sequence[Array], results: Sequence[Array], known: tuple[Array, ...], count: int
    ) -> None:
        """Evaluate without any check, for inner loops: float rows, results and `known` values must fit."""
        for start in range(0, count, self.block):
            stop = min(start + self.block, count)
            self._body(rows, results, self._buffers(stop - start), known, start, stop)

    def _buffers(self, count: int) -> Array:
        """Buffers of the calling thread, packed for `count` samples (a power-of-two stride would thrash)."""
        memory: Array | None = getattr(self._local, "memory", None)
        if memory is None:
            self._local.memory = memory = np.empty(self.buffer_count * self.block)
        return memory[: self.buffer_count * count].reshape(self.buffer_count, count)

    def stream(self, blocks: Iterable[Sequence[Array]]) -> Iterator[list[Array]]:
        """Results of each block of arguments in turn; they are overwritten by the next block.

        Memory does not grow with the number of blocks: reduce a block (its minimum, its count of
        violations) before asking for the next.
        """
        held: list[Array] = []
        for arguments in blocks:
            rows, count = self._check(arguments)
            if not held or held[0].shape[1] < count:
                held = [np.empty((size, count)) for size in self._result_sizes]
            views = [h[:, :count] for h in held]
            self.into(rows, views)
            yield views

    def _check(self, arguments: Sequence[Array]) -> tuple[list[Array], int]:
        rows = [np.asarray(a, dtype=float) for a in arguments]
        check_arguments(self.program, [len(a) for a in rows])
        counts = {a.shape[1] for i, a in enumerate(rows) if i not in self.uniform}
        if len(counts) != 1:
            raise ValueError(
                f"function {self.program.name}: expected arguments with one number of samples, "
                f"received {sorted(counts)}"
            )
        return rows, counts.pop()


class _Plan:
    """Which values are computed once and which for each sample, and in which buffer each lives."""

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
            once = "{0}" if operation == "assign" else _EMIT[operation].replace(", {out}", "")
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
        self.body.append(_EMIT[operation].format(*used, out=out))

    def source(self) -> str:
        """Two functions: `once` (uniform values) and `body` (one block)."""
        program, known = self.program, "".join(f"{k}, " for k in self.known)
        once = [f"def once({', '.join(f'a{i}' for i in self.arguments)}):"]
        once += [f"    {line}" for line in self.once] + [f"    return ({known})"]
        body = ["def body(rows, results, buffers, known, start, stop):", f"    ({known}) = known"]
        body += [f"    b{i} = buffers[{i}]" for i in range(self.buffer_count)]
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


def _compile(name: str, plan: _Plan) -> tuple[Callable[..., Any], Callable[..., Any]]:
    namespace: dict[str, Any] = {**vars(np), "if_else_zero": if_else_zero, **plan.constants}
    exec(compile(plan.source(), f"<{name}>", "exec"), namespace)  # noqa: S102 - own text
    return namespace["once"], namespace["body"]
