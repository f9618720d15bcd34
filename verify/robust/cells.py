"""Cells of S = 1 - b0: a step takes its constants at a bound of S that holds throughout it."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil
from typing import Any, final

from ..flow.stepping import Modes
from .constants import CELLS, Constants, cell_end, greatest_n

LAST = CELLS - 1
"""The cell that holds every S."""
WIDER = (1.03, 1.2, 1.7)
"""Factors by which the bound of S at a step's start is taken for the whole step, in turn."""


def cell_of(modes: Modes) -> int:
    """The cell of S whose upper end bounds it throughout a step in these modes: their third word's number."""
    return int(modes[2].split()[-1])


def cells_above(S: float) -> list[int]:
    """Cells to try for a step that begins with this bound of S, the tightest first."""
    return sorted({min(LAST, max(0, ceil(S * wider * CELLS / 2))) for wider in WIDER} | {LAST})


@final
class Cells:
    """2 B3 N and m by the cell of S, and what says that S lies in it."""

    def __init__(self, constants: Constants) -> None:
        self.constants = constants
        self._known: dict[int, tuple[Fraction, Fraction]] = {}

    def of(self, cell: int) -> tuple[Fraction, Fraction]:
        """2 B3 N and m at the upper end of a cell."""
        if cell not in self._known:
            whirl = 2 * self.constants.gyroscopic * greatest_n(cell_end(cell))
            self._known[cell] = (whirl, self.constants.forcing(cell))
        return self._known[cell]

    def within(self, cell: int, S: Any) -> Iterator[Any]:
        """What must be >= 0 for S to lie in a cell; the last one holds every S."""
        if cell < LAST:
            yield cell_end(cell) - S
