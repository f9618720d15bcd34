"""A program over many samples at once: numpy calls that write into a few small, reused buffers.

Values that depend only on uniform arguments (inertia, law parameters) are computed once a call,
as scalars. As long as only + - * / and square roots occur, each a single correctly rounded
operation, results are bit-identical to CasADi's own evaluation.
"""

from __future__ import annotations

import threading
from collections.abc import Callable, Sequence
from typing import Any, final

import numpy as np

from ..types import Array
from .blocks import BlockFunction
from .plan import EMIT, Plan
from .walk import Program, check_operations

EXACT = frozenset(["assign", "add", "sub", "mul", "div", "neg", "sq", "twice", "inv", "sqrt"]) | frozenset(
    ["fabs", "copysign", "floor", "ceil", "fmin", "fmax"]
)
"""Operations numpy and CasADi round identically."""
WORKING_SET = 1 << 20
"""Bytes of block buffers: with the samples themselves they stay in a second-level cache of 2 MB."""
LINE = 8
"""Floats in a line of the cache: rows that begin between two lines cost a quarter of the speed."""
MIN_BLOCK, MAX_BLOCK = 1024, 8192


@final
class ArrayFunction(BlockFunction):
    """A program emitted as numpy calls; safe to share between threads.

    Attributes
    ----------
    is_exact : bool
        Whether results are bit-identical to CasADi's (only correctly rounded operations occur).
    buffer_count : int
        Block buffers the program needs; memory is 8 * block * buffer_count bytes a thread,
        whatever the number of samples.
    sample_operations : int
        numpy calls a block (operations that differ from sample to sample).

    Parameters
    ----------
    block : int, optional
        Samples a block; by default as many as keep all buffers within `WORKING_SET`.
    """

    def __init__(self, program: Program, *, uniform: Sequence[int] = (), block: int | None = None) -> None:
        check_operations(program, EMIT, "the array backend")
        plan = Plan(program, frozenset(uniform))
        super().__init__(
            program, uniform=uniform, block=_block(plan.buffer_count) if block is None else block
        )
        self.is_exact = program.operations <= EXACT
        self.buffer_count, self.sample_operations = plan.buffer_count, len(plan.body)
        self._local = threading.local()
        self._once, self._body = _compile(program.name, plan)

    def _evaluate(self, rows: Sequence[Array], results: Sequence[Array], count: int) -> None:
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

    def _buffers(self, count: int) -> tuple[Array, ...]:
        """Buffers of the calling thread for `count` samples, each on a line of the cache, packed."""
        kept: tuple[int, tuple[Array, ...]] | None = getattr(self._local, "kept", None)
        if kept is None or kept[0] != count:
            memory: Array | None = getattr(self._local, "memory", None)
            if memory is None:
                self._local.memory = memory = aligned(self.buffer_count * _rounded(self.block))
            stride = _rounded(count)
            kept = count, tuple(memory[i * stride :][:count] for i in range(self.buffer_count))
            self._local.kept = kept
        return kept[1]


def aligned(size: int) -> Array:
    """Room for `size` floats that begins on a line of the cache."""
    room = np.empty(size + LINE)
    first = -(room.ctypes.data // room.itemsize) % LINE
    return room[first : first + size]


def _rounded(count: int) -> int:
    return -(-count // LINE) * LINE


def _block(buffer_count: int) -> int:
    fitting = WORKING_SET // (8 * max(buffer_count, 1)) // 64 * 64
    return min(max(fitting, MIN_BLOCK), MAX_BLOCK)


def if_else_zero(condition: Any, value: Any, out: Array | None = None) -> Any:
    """`value` where `condition` is not 0, else exactly 0 (also where `value` is not finite)."""
    chosen = np.where(np.not_equal(condition, 0.0), value, 0.0)
    if out is None:
        return chosen
    np.copyto(out, chosen)
    return out


def _compile(name: str, plan: Plan) -> tuple[Callable[..., Any], Callable[..., Any]]:
    namespace: dict[str, Any] = {**vars(np), "if_else_zero": if_else_zero, **plan.constants}
    exec(compile(plan.source(), f"<{name}>", "exec"), namespace)  # noqa: S102 - own text
    return namespace["once"], namespace["body"]
