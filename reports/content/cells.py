"""A table's cell in plain words, as terminals and notebooks show it."""

from __future__ import annotations

from ..numbers import write
from .blocks import Cell


def cell_text(cell: Cell) -> str:
    """Text, a verdict with its words, a code, or a quantity with the digits it deserves; "-" for nothing."""
    if cell is None:
        return "-"
    if isinstance(cell, str):
        return cell
    if "verdict" in cell:
        return f"{cell['verdict']} {cell.get('text', '')}".strip()
    if "code" in cell:
        return str(cell["code"])
    return write(cell).ascii
