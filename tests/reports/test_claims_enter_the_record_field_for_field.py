"""A verdict object's every field is in the record, and nothing else decides what is shown."""

from dataclasses import fields

from intermit.reports import Record
from intermit.reports.provenance import provenance
from intermit.study.claims.entries import claim_entry
from intermit.verify.verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness


def refuted() -> Claim:
    witness = Witness(
        "state", {"b": [0.5, 0.5, 0.5, 0.5], "k": 1.0}, Quantity("V'", 1e-4, 2e-4, "1/s", rigorous=True)
    )
    evidence = Evidence(EvidenceKind.WITNESS, "found", "here", {"tries": 3, "object": object()})
    margins = (Quantity("margin", -2e-4, -1e-4),)
    return Claim("v.decrease", "V decreases", "V' <= 0", Verdict.REFUTED, (evidence,), (), margins, witness)


def test_every_field_is_there() -> None:
    entry = claim_entry(refuted())
    assert entry.model_fields_set - {"recheck"} == {f.name for f in fields(Claim)}
    assert entry.verdict == "REFUTED"
    assert entry.evidence[0].details == {"tries": 3}
    assert entry.witness.violation.low == 1e-4


def test_the_record_takes_it() -> None:
    undecided = Claim("a", "A", "a", Verdict.UNDECIDED, reason="none found", next_step="more samples")
    claims = [claim_entry(refuted()), claim_entry(undecided, recheck="intermit check s.toml")]
    record = Record.create(
        title="t",
        provenance=provenance(scenario_name="s", scenario_text=""),
        sections={"audit": {"claims": claims}},
    )
    assert record.sections.audit.claims[1].recheck == "intermit check s.toml"
