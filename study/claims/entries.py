"""From verdict objects to the plain mappings of the record."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from ...reports.record.values import plain
from ...verify.verdict import Claim, Evidence, Quantity, Witness


def quantity_entry(quantity: Quantity) -> dict[str, Any]:
    """One number with its bounds, unit, label and whether they are rigorous."""
    return {
        "name": quantity.name,
        "low": quantity.low,
        "high": quantity.high,
        "unit": quantity.unit,
        "label": quantity.label or quantity.name.replace("_", " "),
        "rigorous": quantity.rigorous,
        "side": quantity.side,
    }


def witness_entry(witness: Witness) -> dict[str, Any]:
    """State or instant that refutes, with its violation."""
    return {
        "description": witness.description,
        "values": dict(witness.values),
        "violation": quantity_entry(witness.violation),
    }


def evidence_entry(evidence: Evidence) -> dict[str, Any]:
    """One piece of support; of its details those a document can hold (not, say, a certificate object)."""
    return {
        "kind": evidence.kind.value,
        "summary": evidence.summary,
        "source": evidence.source,
        "details": {key: value for key, value in evidence.details.items() if _sayable(value)},
    }


def _sayable(value: Any) -> bool:
    try:
        plain(value)
    except ValueError:
        return False
    return True


def claim_entry(claim: Claim, *, recheck: str = "") -> dict[str, Any]:
    """One claim, field for field; `recheck` is a command that checks it again."""
    entry: dict[str, Any] = {
        "key": claim.key,
        "title": claim.title,
        "statement": claim.statement,
        "verdict": claim.verdict.value,
        "evidence": [evidence_entry(e) for e in claim.evidence],
        "quantities": [quantity_entry(q) for q in claim.quantities],
        "margins": [quantity_entry(q) for q in claim.margins],
        "witness": None if claim.witness is None else witness_entry(claim.witness),
        "reason": claim.reason,
        "next_step": claim.next_step,
        "source": claim.source,
        "counted": claim.counted,
    }
    return entry | ({"recheck": recheck} if recheck else {})


def claim_entries(claims: Iterable[Claim], *, recheck: str = "") -> list[dict[str, Any]]:
    """Many claims, in the order given."""
    return [claim_entry(c, recheck=recheck) for c in claims]
