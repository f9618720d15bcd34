"""Numbers with their bounds, and claims with their verdict, evidence and witness."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field, JsonValue

from .base import Flag, Number, Part

Side = Literal["both", "lower", "upper"]
VerdictWord = Literal["PROVED", "REFUTED", "UNDECIDED"]
EvidenceWord = Literal["certificate", "theorem", "witness", "computation", "samples"]
Bound = Annotated[Number | None, Field(description="null: not available")]


class QuantityEntry(Part):
    """A number known to lie in [low, high]; rigorous if that is an enclosure (exact or outward rounded)."""

    name: str
    low: Bound
    high: Bound
    unit: str = ""
    label: str = ""
    rigorous: Flag = False
    side: Annotated[
        Side,
        Field(description="lower: the true value is >= low; upper: it is <= high; both: in [low, high]"),
    ] = "both"
    note: str | None = None

    @property
    def words(self) -> str:
        """Its label, or its name where it has none."""
        return self.label or self.name

    def labelled(self, label: str) -> QuantityEntry:
        """The same number under another label."""
        return self.but(label=label)


class WitnessEntry(Part):
    """A state or instant that refutes, and its violation."""

    description: str
    values: dict[str, JsonValue]
    violation: QuantityEntry


class EvidenceEntry(Part):
    """One piece of support of a claim."""

    kind: EvidenceWord
    summary: str
    source: str = ""
    details: dict[str, JsonValue] = Field(default={})


class ClaimEntry(Part):
    """A statement with its verdict, field for field as it was decided."""

    key: str
    title: str
    statement: str
    verdict: VerdictWord
    evidence: tuple[EvidenceEntry, ...]
    quantities: tuple[QuantityEntry, ...]
    margins: tuple[QuantityEntry, ...]
    witness: WitnessEntry | None
    reason: str = ""
    next_step: str = ""
    source: str = ""
    counted: Flag = True
    recheck: Annotated[str | None, Field(description="a command that checks it again")] = None
