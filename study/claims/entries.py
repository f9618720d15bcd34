"""From verdict objects to the parts of the record."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import Any

from pydantic import JsonValue

from ...reports.record.claims import ClaimEntry, EvidenceEntry, QuantityEntry, WitnessEntry
from ...reports.record.values import plain
from ...verify.verdict import Claim, Evidence, Quantity, Witness


def quantity_entry(quantity: Quantity) -> QuantityEntry:
    """One number with its bounds, unit, label and whether they are rigorous."""
    return QuantityEntry(
        name=quantity.name,
        low=quantity.low,
        high=quantity.high,
        unit=quantity.unit,
        label=quantity.label or quantity.name.replace("_", " "),
        rigorous=quantity.rigorous,
        side=quantity.side,
    )


def witness_entry(witness: Witness) -> WitnessEntry:
    """State or instant that refutes, with its violation."""
    return WitnessEntry(
        description=witness.description,
        values=plain(witness.values),
        violation=quantity_entry(witness.violation),
    )


def evidence_entry(evidence: Evidence) -> EvidenceEntry:
    """One piece of support; of its details those a document can hold (not, say, a certificate object)."""
    return EvidenceEntry(
        kind=evidence.kind.value,
        summary=evidence.summary,
        source=evidence.source,
        details=_sayable(evidence.details),
    )


def _sayable(details: Mapping[str, Any]) -> dict[str, JsonValue]:
    found: dict[str, JsonValue] = {}
    for key, value in details.items():
        try:
            found[key] = plain(value)
        except ValueError:
            continue
    return found


def claim_entry(claim: Claim, *, recheck: str = "") -> ClaimEntry:
    """One claim, field for field; `recheck` is a command that checks it again."""
    return ClaimEntry(
        key=claim.key,
        title=claim.title,
        statement=claim.statement,
        verdict=claim.verdict.value,
        evidence=tuple(evidence_entry(e) for e in claim.evidence),
        quantities=tuple(quantity_entry(q) for q in claim.quantities),
        margins=tuple(quantity_entry(q) for q in claim.margins),
        witness=None if claim.witness is None else witness_entry(claim.witness),
        reason=claim.reason,
        next_step=claim.next_step,
        source=claim.source,
        counted=claim.counted,
        recheck=recheck or None,
    )


def claim_entries(claims: Iterable[Claim], *, recheck: str = "") -> tuple[ClaimEntry, ...]:
    """Many claims, in the order given."""
    return tuple(claim_entry(c, recheck=recheck) for c in claims)
