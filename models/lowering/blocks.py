"""Functions of many samples, evaluated block by block in bounded memory."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Iterable, Iterator, Sequence
from itertools import pairwise

import numpy as np

from ..types import Array
from .walk import Program, check_arguments


class BlockFunction(ABC):
    """A program over samples kept as a structure of arrays, one row a quantity.

    Attributes
    ----------
    program : Program
    uniform : frozenset of int
        Arguments that hold one set of numbers for all samples; the others have one for each.
    block : int
        Samples a block.
    """

    def __init__(self, program: Program, *, uniform: Sequence[int] = (), block: int) -> None:
        if block < 1:
            raise ValueError(f"block must be at least 1 sample, received {block}")
        unknown = sorted(set(uniform) - set(range(len(program.argument_sizes))))
        if unknown:
            raise ValueError(f"function {program.name} has no argument {unknown[0]} to be uniform")
        self.program, self.uniform, self.block = program, frozenset(uniform), block
        self._result_sizes = tuple(len(row) for row in program.results)

    @abstractmethod
    def _evaluate(self, rows: Sequence[Array], results: Sequence[Array], count: int) -> None:
        """Write the results of `count` checked samples."""

    def __call__(self, *arguments: Array) -> list[Array]:
        """Evaluate (n_i, N) arrays, one row an element (uniform ones (n_i,)), into new (m_j, N) arrays."""
        rows, count = self._check(arguments)
        results = self.allocate(count)
        self._evaluate(rows, results, count)
        return results

    def allocate(self, count: int) -> list[Array]:
        """Room for the results of `count` samples, (m_j, count) each: consecutive rows of one array."""
        room = np.empty((sum(self._result_sizes), count))
        edges = np.cumsum([0, *self._result_sizes])
        return [room[a:b] for a, b in pairwise(edges)]

    def into(self, arguments: Sequence[Array], results: Sequence[Array]) -> None:
        """Evaluate into existing (m_j, N) arrays, apart from the arguments; allocates nothing of size N."""
        rows, count = self._check(arguments)
        expected = [(size, count) for size in self._result_sizes]
        if [r.shape for r in results] != expected:
            raise ValueError(
                f"function {self.program.name}: expected results of shape {expected}, "
                f"received {[r.shape for r in results]}"
            )
        self._evaluate(rows, results, count)

    def stream(self, blocks: Iterable[Sequence[Array]]) -> Iterator[list[Array]]:
        """Results of each block of arguments in turn; they are overwritten by the next block.

        Memory does not grow with the number of blocks: reduce a block (its minimum, its count of
        violations) before asking for the next.
        """
        held: list[Array] = []
        for arguments in blocks:
            rows, count = self._check(arguments)
            if not held or held[0].shape[1] != count:
                held = self.allocate(count)
            self._evaluate(rows, held, count)
            yield held

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
