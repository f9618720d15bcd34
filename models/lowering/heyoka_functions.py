"""A program over many samples, compiled by heyoka to vector instructions (extra `fast`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, final

import numpy as np

from ..types import Array
from .blocks import BlockFunction
from .heyoka_table import heyoka_expressions, load_heyoka
from .walk import Program

HEYOKA_BLOCK = 4096
KEPT = 8
"""Compiled functions kept, one for each set of uniform arguments."""


@final
class HeyokaFunction(BlockFunction):
    """A program compiled for the machine's vector width.

    Uniform arguments become constants of the compiled function; compiling takes some 0.1 to 0.5 s
    for each set of them, so this pays from about 10 million samples on. Results agree with CasADi's
    to rounding (sums may be reordered), not bit for bit. Quickest with a single varying argument,
    whose rows need no copying.
    """

    def __init__(self, program: Program, *, uniform: Sequence[int] = (), block: int = HEYOKA_BLOCK) -> None:
        super().__init__(program, uniform=uniform, block=block)
        self._varying = [i for i in range(len(program.argument_sizes)) if i not in self.uniform]
        self._compiled: dict[bytes, Any] = {}
        heyoka_expressions(program, self._arguments([np.ones(n) for n in program.argument_sizes]))

    def _arguments(self, rows: Sequence[Array]) -> list[list[Any]]:
        """Variables for what varies, constants for what does not."""
        hy = load_heyoka()
        return [
            [hy.expression(float(c)) for c in rows[i]]
            if i in self.uniform
            else [hy.expression(f"x{i}_{e}") for e in range(size)]
            for i, size in enumerate(self.program.argument_sizes)
        ]

    def _function(self, rows: Sequence[Array]) -> Any:
        """The compiled function for these uniform arguments."""
        key = b"".join(rows[i].tobytes() for i in sorted(self.uniform))
        if key not in self._compiled:
            arguments = self._arguments(rows)
            outputs = [e for row in heyoka_expressions(self.program, arguments) for e in row]
            if len(self._compiled) >= KEPT:
                del self._compiled[next(iter(self._compiled))]
            variables = [v for i in self._varying for v in arguments[i]]
            self._compiled[key] = load_heyoka().cfunc(outputs, variables)
        return self._compiled[key]

    def _evaluate(self, rows: Sequence[Array], results: Sequence[Array], count: int) -> None:
        function = self._function(rows)
        whole, out = rows[self._varying[0]], _joined(results)
        if len(self._varying) == 1 and whole.flags.c_contiguous and out is not None:
            function(whole, outputs=out, batch_parallel=False)
            return
        size = min(self.block, max(count, 1))
        for start in range(0, count, size):
            part = slice(start, min(start + size, count))
            inputs = np.concatenate([rows[i][:, part] for i in self._varying])
            outputs, row = function(inputs, batch_parallel=False), 0
            for result in results:
                result[:, part] = outputs[row : row + len(result)]
                row += len(result)


def _joined(results: Sequence[Array]) -> Array | None:
    """The one contiguous array of which the results are the rows, in order; None if there is none."""
    base = results[0].base
    if not isinstance(base, np.ndarray) or base.ndim != 2 or not base.flags.c_contiguous:
        return None
    row = 0
    for result in results:
        rows = base[row : row + len(result)]
        if result.shape != rows.shape or result.ctypes.data != rows.ctypes.data:
            return None
        row += len(result)
    return base if row == len(base) else None
