"""The kinds of block a chapter is made of. Writers (HTML, PDF, LaTeX) know these and no record."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import Literal, final

import numpy as np
from numpy.typing import NDArray

from ..record.claims import ClaimEntry, QuantityEntry
from ..record.tables import CellEntry, CodeCell

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class MatrixCell:
    """A matrix and its unit."""

    matrix: tuple[tuple[float, ...], ...]
    unit: str


Cell = CellEntry | MatrixCell
"""Text, nothing, a quantity, a verdict, a code or a matrix."""


def code(text: str) -> CodeCell:
    """A cell set as code."""
    return CodeCell(code=text)


def law_row(label: str, figures: Sequence[QuantityEntry]) -> dict[str, Cell]:
    """A table's row: the law, and each figure under its name."""
    row: dict[str, Cell] = {"law": label}
    return row | {figure.name: figure for figure in figures}


@final
@dataclass(frozen=True)
class Text:
    """A paragraph of plain text; a warning is set apart."""

    text: str
    kind: Literal["plain", "note", "warning"] = "plain"


@final
@dataclass(frozen=True)
class Card:
    """One law's answer at a glance: counts of verdicts and a few numbers."""

    label: str
    verdicts: tuple[tuple[str, int], ...]
    numbers: tuple[QuantityEntry, ...]


@final
@dataclass(frozen=True)
class Cards:
    """Cards side by side."""

    cards: tuple[Card, ...]


@final
@dataclass(frozen=True)
class Group:
    """Claims under one heading; `number` names it in anchors."""

    label: str
    claims: tuple[ClaimEntry, ...]
    number: int = 0

    def entries(self, *, counted: bool) -> tuple[tuple[str, ClaimEntry], ...]:
        """Anchor and claim, of those that decide the exit code or of the others."""
        anchored = ((f"claim-{self.number}-{i + 1}", claim) for i, claim in enumerate(self.claims))
        return tuple((a, claim) for a, claim in anchored if claim.counted is counted)


@final
@dataclass(frozen=True)
class Verdicts:
    """The verdict table: of the claims that count, or (folded away, with a summary) of the others."""

    groups: tuple[Group, ...]
    counted: bool = True
    summary: str = ""


@final
@dataclass(frozen=True)
class ClaimDetails:
    """Every claim in full: numbers, evidence, witness, reason and next step."""

    groups: tuple[Group, ...]


@final
@dataclass(frozen=True)
class Facts:
    """Label and value, row by row."""

    rows: tuple[tuple[str, Cell], ...]
    title: str = ""


@final
@dataclass(frozen=True)
class Table:
    """A table; `columns` are (key, label, unit)."""

    key: str
    title: str
    columns: tuple[tuple[str, str, str], ...]
    rows: tuple[Mapping[str, Cell], ...]
    notes: tuple[str, ...] = ()


@final
@dataclass(frozen=True)
class Equation:
    """One displayed equation in Typst's and LaTeX's notation (trusted, part of the package)."""

    title: str
    typst: str
    latex: str


@final
@dataclass(frozen=True)
class Equations:
    """Displayed equations."""

    equations: tuple[Equation, ...]


@final
@dataclass(frozen=True)
class Verbatim:
    """Text set exactly as it is."""

    title: str
    text: str


@final
@dataclass(frozen=True)
class Line:
    """One series: `y` against `x`; `upper` closes a band."""

    label: str
    x: Array
    y: Array
    style: str = "line"
    colour: int = 0
    dashed: bool = False
    upper: Array | None = None


@final
@dataclass(frozen=True)
class Axis:
    """Label, unit, and whether it is logarithmic."""

    label: str
    unit: str = ""
    log: bool = False


@final
@dataclass(frozen=True)
class Chart:
    """A figure. `windows` are shaded; `reach` is a common (low, high) for y, so that neighbours compare."""

    key: str
    title: str
    x: Axis
    y: Axis
    lines: tuple[Line, ...]
    alt: str
    windows: tuple[tuple[float, float], ...] = ()
    reach: tuple[float, float] | None = None
    notes: tuple[str, ...] = ()


@final
@dataclass(frozen=True)
class Charts:
    """Figures side by side."""

    charts: tuple[Chart, ...]


@final
@dataclass(frozen=True)
class Body:
    """One turning body of the replay: `torque` is the applied g u, N m."""

    label: str
    time: Array
    quaternion: Array
    torque: Array | None


@final
@dataclass(frozen=True)
class Replay:
    """Bodies turning through the windows, on one time axis."""

    bodies: tuple[Body, ...]
    windows: tuple[tuple[float, float], ...]
    inertia: tuple[tuple[float, ...], ...] | None


Block = (
    Text | Cards | Verdicts | ClaimDetails | Facts | Table | Equations | Verbatim | Charts | Replay
)  # a closed list: a writer must know each


@final
@dataclass(frozen=True)
class Chapter:
    """A heading and its blocks; `key` is safe in an address and a file name."""

    key: str
    title: str
    blocks: tuple[Block, ...]


def charts_of(chapters: Sequence[Chapter]) -> tuple[Chart, ...]:
    """Every chart, in order."""
    found: list[Chart] = []
    for chapter in chapters:
        for block in chapter.blocks:
            if isinstance(block, Charts):
                found.extend(block.charts)
    return tuple(found)


def tables_of(chapters: Sequence[Chapter]) -> tuple[Table, ...]:
    """Every table, in order."""
    return tuple(b for chapter in chapters for b in chapter.blocks if isinstance(b, Table))
