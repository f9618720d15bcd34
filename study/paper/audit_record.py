"""The audit of the paper's printed equations, as a record."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import final

from ...reports import parts
from ...reports.provenance import provenance
from ...reports.record import Record
from ...reports.record.document import Sections
from ...reports.record.tables import CellEntry, CodeCell, CollectionEntry, TableEntry, VerdictCell
from ..claims.entries import claim_entries, quantity_entry
from .audit import AuditItem, audit


@final
@dataclass(frozen=True)
class AuditStudy:
    """Every misprint with what shows it."""

    items: tuple[AuditItem, ...]

    @property
    def is_complete(self) -> bool:
        """Whether every printed version is refuted and every corrected one proved."""
        return all(item.is_demonstrated for item in self.items)

    @property
    def sentence(self) -> str:
        """The outcome in one sentence."""
        shown = sum(item.is_demonstrated for item in self.items)
        return (
            f"{shown} of {len(self.items)} misprints shown: the printed version refuted by an exact "
            "counterexample, the corrected one derived."
        )


def run_audit(progress: Callable[[str, float], None] | None = None) -> AuditStudy:
    """Audit the paper."""
    return AuditStudy(audit(progress))


def audit_record(study: AuditStudy) -> Record:
    """The audit as a record of one section."""
    claims = [claim for item in study.items for claim in (item.as_printed, item.as_corrected)]
    section = CollectionEntry(
        title="Audit of the printed equations",
        summary=study.sentence,
        claims=claim_entries(claims),
        tables=(_versions(study.items), _evidence(study.items), _figures(study.items)),
        notes=tuple(f"{item.number}: {text}" for item in study.items for text in item.consequences),
    )
    found = provenance(
        scenario_name="the paper's printed equations", scenario_text="", command="intermit audit"
    )
    return Record.create(
        title="Audit of Ram & Akella, AAS 21-402",
        provenance=found,
        sections=Sections(audit=section),
        arrays={},
    )


def _versions(items: Sequence[AuditItem]) -> TableEntry:
    columns = [parts.column("number", "no."), parts.column("place", "place")]
    columns += [parts.column("printed", "as printed"), parts.column("corrected", "corrected")]
    rows: list[dict[str, CellEntry]] = [
        {
            "number": i.number,
            "place": i.place,
            "printed": CodeCell(code=i.printed),
            "corrected": CodeCell(code=i.corrected),
        }
        for i in items
    ]
    return parts.table("versions", "The equations", columns, rows)


def _evidence(items: Sequence[AuditItem]) -> TableEntry:
    columns = [parts.column("number", "no."), parts.column("printed", "as printed")]
    columns += [parts.column("counterexample", "counterexample"), parts.column("violation", "by")]
    columns += [parts.column("corrected", "corrected"), parts.column("how", "how")]
    rows: list[dict[str, CellEntry]] = []
    for item in items:
        witness = item.as_printed.witness
        rows.append(
            {
                "number": item.number,
                "printed": VerdictCell(verdict=item.as_printed.verdict.value),
                "counterexample": "" if witness is None else witness.description,
                "violation": None if witness is None else quantity_entry(witness.violation),
                "corrected": VerdictCell(verdict=item.as_corrected.verdict.value),
                "how": "; ".join(e.summary for e in item.as_corrected.evidence),
            }
        )
    return parts.table("evidence", "What shows it", columns, rows)


def _figures(items: Sequence[AuditItem]) -> TableEntry:
    columns = [parts.column("number", "no."), parts.column("name", "figure"), parts.column("value", "value")]
    rows: list[dict[str, CellEntry]] = [
        {"number": item.number, "name": figure.label or figure.name, "value": quantity_entry(figure)}
        for item in items
        for figure in item.figures
    ]
    return parts.table("figures", "Figures", columns, rows)
