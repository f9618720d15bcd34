"""A program over many samples, compiled by heyoka to vector instructions (extra `fast`)."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from .blocks import BlockFunction
from .heyoka_table import heyoka_expressions, load_heyoka
from .walk import Program

Array = NDArray[np.float64]

HEYOKA_BLOCK = 4096


@final
class HeyokaFunction(BlockFunction):
    """A program compiled for the machine's vector width.

    Compiling costs some 0.1 to 0.5 s, so this pays from about 10 million samples on. Results agree
    with CasADi's to rounding (sums may be reordered), not bit for bit.
    """

    def __init__(self, program: Program, *, uniform: Sequence[int] = (), block: int = HEYOKA_BLOCK) -> None:
        super().__init__(program, uniform=uniform, block=block)
        hy = load_heyoka()
        varying = [i for i in range(len(program.argument_sizes)) if i not in self.uniform]
        names = {i: [f"x{i}_{e}" for e in range(program.argument_sizes[i])] for i in varying}
        variables = {i: [hy.expression(name) for name in names[i]] for i in varying}
        arguments: list[list[Any]] = []
        parameters = 0
        for i, size in enumerate(program.argument_sizes):
            if i in self.uniform:
                arguments.append([hy.par[parameters + e] for e in range(size)])
                parameters += size
            else:
                arguments.append(variables[i])
        outputs = [e for row in heyoka_expressions(program, arguments) for e in row]
        self._varying = varying
        self._function = hy.cfunc(outputs, [v for i in varying for v in variables[i]])
        self._parameter_count = int(self._function.nparams)

    def _evaluate(self, rows: Sequence[Array], results: Sequence[Array], count: int) -> None:
        size = min(self.block, max(count, 1))
        inputs = np.empty((sum(len(rows[i]) for i in self._varying), size))
        outputs = np.empty((sum(len(r) for r in results), size))
        uniform = np.concatenate([rows[i] for i in sorted(self.uniform)]) if self.uniform else np.empty(0)
        # unused trailing parameters are not part of the compiled function
        parameters = np.ascontiguousarray(np.repeat(uniform[: self._parameter_count, None], size, axis=1))
        for start in range(0, count, size):
            stop = min(start + size, count)
            if stop - start < size:
                inputs, outputs, parameters = (
                    np.ascontiguousarray(a[:, : stop - start]) for a in (inputs, outputs, parameters)
                )
            row = 0
            for i in self._varying:
                inputs[row : row + len(rows[i])] = rows[i][:, start:stop]
                row += len(rows[i])
            self._function(inputs, outputs=outputs, pars=parameters, batch_parallel=False)
            row = 0
            for result in results:
                result[:, start:stop] = outputs[row : row + len(result)]
                row += len(result)
