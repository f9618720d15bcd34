"""What `intermit explain` prints: a claim in general, then as it stands in one scenario."""

from __future__ import annotations

from collections.abc import Iterable, Mapping
from typing import TYPE_CHECKING, Any

from ..verify.claim_table import CLAIM_KEYS, ClaimKey
from ..verify.verdict import Claim, Verdict
from .claim_tables import STYLES, plain_table, quantity_text, witness_text

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from ..study.check.result import CheckStudy


def print_keys(console: Console) -> None:
    """List every claim with its key."""
    table = plain_table("Key", "Claim", "Decides the exit code")
    for entry in CLAIM_KEYS.values():
        table.add_row(entry.key, entry.title, "yes" if entry.counts else "if [check] claims lists it")
    console.print(table)


def print_claim(console: Console, entry: ClaimKey) -> None:
    """A claim in general terms: what it says, on what it rests, where it comes from."""
    console.print(f"{entry.key}: {entry.title}", style="bold")
    rows = {"Says": entry.says, "Rests on": entry.rests_on, "Source": entry.source, "Derived in": entry.page}
    console.print(_grid(rows.items()))


def print_found(console: Console, key: str, study: CheckStudy) -> None:
    """The claim as it stands in a scenario, for the schedule or for each law."""
    groups = [("the schedule", study.claims), *((case.choice.label, case.claims) for case in study.cases)]
    found = [(name, claim) for name, claims in groups for claim in claims if claim.key == key]
    console.print(f"\nIn {study.scenario.name} ({study.scenario.path.name})", style="bold")
    if not found:
        console.print("  nothing was claimed: the scenario does not give what this claim needs")
    for name, claim in found:
        _found(console, name, claim)


def _found(console: Console, name: str, claim: Claim) -> None:
    from rich.text import Text

    head = Text(f"\n{name}: ")
    console.print(head.append(claim.verdict.value, style=STYLES[claim.verdict]))
    console.print(_grid(_parts(claim)))


def _parts(claim: Claim) -> Iterable[tuple[str, str]]:
    yield "Claim", claim.statement
    for quantity in claim.quantities:
        yield "Number", f"{quantity_text(quantity)}{' (certain)' if quantity.rigorous else ''}"
    for quantity in claim.margins:
        yield "Margin", quantity_text(quantity)
    if claim.witness is not None:
        yield "Refuted by", f"{claim.witness.description}: {witness_text(claim.witness)}"
    if claim.verdict is Verdict.UNDECIDED:
        yield "Because", claim.reason
        yield "Next step", claim.next_step
    for evidence in claim.evidence:
        yield evidence.kind.value.capitalize(), evidence.summary
        if evidence.source:
            yield "  from", evidence.source
        for label, text in _details(evidence.details):
            yield f"  {label}", text
    if claim.source:
        yield "Source", claim.source
    yield "Exit code", "decided by this claim too" if claim.counted else "not decided by this claim"


def _details(details: Mapping[str, Any]) -> Iterable[tuple[str, str]]:
    """Details that can be said in a line; certificates and arrays are left to `intermit certify`."""
    for name, value in details.items():
        if isinstance(value, float):
            yield name.replace("_", " "), f"{value:.8g}"
        elif isinstance(value, (str, int)):
            yield name.replace("_", " "), str(value)
        elif isinstance(value, list) and len(value) <= 16 and all(isinstance(x, (int, float)) for x in value):
            yield name.replace("_", " "), "(" + ", ".join(f"{x:.6g}" for x in value) + ")"


def _grid(rows: Iterable[tuple[str, str]]) -> Table:
    from rich.table import Table

    grid = Table.grid(padding=(0, 2))
    grid.add_column(max_width=22, overflow="fold")
    grid.add_column(overflow="fold")
    for name, text in rows:
        grid.add_row(name, text)
    return grid
