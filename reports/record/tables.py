"""Studies that end in tables and figures: comparison, front, sweep, tuning, the paper's, the audit."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from .base import ArrayOf, Flag, Part
from .claims import ClaimEntry, QuantityEntry, VerdictWord

Style = Literal["line", "points", "line+points", "step", "band", "bars"]
Role = Literal["law", "optimum", "bound", "reference"]


class VerdictCell(Part):
    """A cell that is a verdict."""

    verdict: VerdictWord


class CodeCell(Part):
    """A cell set as code."""

    code: str


CellEntry = str | QuantityEntry | VerdictCell | CodeCell | None


class ColumnEntry(Part):
    """A table's column."""

    key: str
    label: str
    unit: str = ""


class TableEntry(Part):
    """A table: its rows map a column's key to a cell."""

    key: str
    title: str
    columns: tuple[ColumnEntry, ...]
    rows: tuple[dict[str, CellEntry], ...]
    notes: tuple[str, ...] = ()


class AxisEntry(Part):
    """A figure's axis."""

    label: str
    unit: str = ""
    log: Flag = False


class SeriesEntry(Part):
    """One series of a figure; its unit is the axis's."""

    label: str
    x: Annotated[str, ArrayOf()]
    y: Annotated[str, ArrayOf()]
    upper: Annotated[str | None, ArrayOf(), Field(description="upper edge where style is band")] = None
    style: Style = "line"
    role: Role | None = None


class FigureEntry(Part):
    """A figure that a study drew itself."""

    key: str
    title: str
    x: AxisEntry
    y: AxisEntry
    series: tuple[SeriesEntry, ...]
    alt: Annotated[str, Field(description="what it shows, in one sentence, for those who cannot see it")]
    windows: Annotated[Flag, Field(description="shade the thruster windows (x is time in s)")] = False
    notes: tuple[str, ...] = ()


class CollectionEntry(Part):
    """A study made of claims, tables and figures."""

    title: str = ""
    summary: str = ""
    claims: tuple[ClaimEntry, ...] = ()
    tables: tuple[TableEntry, ...] = ()
    figures: tuple[FigureEntry, ...] = ()
    notes: tuple[str, ...] = ()
