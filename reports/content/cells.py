"""A table's cell in plain words, as terminals and notebooks show it."""

from __future__ import annotations

from ..numbers import write
from ..record.claims import QuantityEntry
from ..record.tables import CodeCell, VerdictCell
from .blocks import Cell


def cell_text(cell: Cell) -> str:
    """Text, a verdict, a code, or a quantity with the digits it deserves; "-" for nothing."""
    if cell is None:
        return "-"
    if isinstance(cell, str):
        return cell
    if isinstance(cell, VerdictCell):
        return cell.verdict
    if isinstance(cell, CodeCell):
        return cell.code
    if isinstance(cell, QuantityEntry):
        return write(cell).ascii
    return f"{len(cell.matrix)} x {len(cell.matrix[0])} matrix"
