"""What `intermit check` prints: verdicts first, then what is not proved, numbers and margins, runs."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from string import ascii_uppercase
from typing import TYPE_CHECKING

from ..reports.numbers import write
from ..reports.record.claims import QuantityEntry
from ..study.simulated_run import metrics
from ..verify.verdict import Claim, Verdict
from .claim_tables import STYLES, Column, number_table, plain_table, verdict_table, witness_text

if TYPE_CHECKING:
    from rich.console import Console
    from rich.table import Table

    from ..study.check.case import Case
    from ..study.check.result import CheckStudy

FUNCTION_NOT_LAW = (
    "V' <= 0 and the conditions on lambda are about one storage function, not about the laws: "
    "convergence does not rest on them and is proved."
)


def print_check(console: Console, studies: Sequence[CheckStudy]) -> None:
    """Print one check, or several side by side."""
    marks = [f"{letter}: " if len(studies) > 1 else "" for letter in ascii_uppercase[: len(studies)]]
    for mark, study in zip(marks, studies, strict=True):
        console.print(f"{mark}{study.scenario.name} ({study.scenario.path.name})", style="bold")
        console.print(f"{' ' * len(mark)}{study.sentence}")
        if clock := study.scenario.clock.words:
            console.print(f"{' ' * len(mark)}{clock}")
    schedules = [
        Column(mark.rstrip(": ") or "verdict", study.claims)
        for mark, study in zip(marks, studies, strict=True)
    ]
    laws = [
        Column(mark + case.choice.label, case.claims)
        for mark, study in zip(marks, studies, strict=True)
        for case in study.cases
    ]
    console.print()
    console.print(verdict_table("The schedule", schedules))
    if laws:
        console.print()
        console.print(verdict_table("The laws", laws))
    if any(not claim.counted for study in studies for claim in study.all_claims):
        console.print("* reported; does not decide the exit code", style="dim")
    for mark, study in zip(marks, studies, strict=True):
        _not_proved(console, mark, study)
    for table in (
        number_table("Schedule's numbers", _as_values(schedules)),
        number_table("Laws' numbers", laws),
    ):
        if table is not None:
            console.print()
            console.print(table)
    for mark, study in zip(marks, studies, strict=True):
        _simulated(console, mark, study)
    console.print(
        f"\nintermit explain CLAIM {studies[0].scenario.path} says what a claim rests on.", style="dim"
    )


def _as_values(columns: Sequence[Column]) -> list[Column]:
    return [Column("value" if c.heading == "verdict" else c.heading, c.claims) for c in columns]


def _not_proved(console: Console, mark: str, study: CheckStudy) -> None:
    """Each refuted claim with what refutes it, each open one with the reason and the next step."""
    groups = [("the schedule", study.claims), *((c.choice.label, c.claims) for c in study.cases)]
    told: dict[tuple[str, ...], list[str]] = {}
    styles: dict[tuple[str, ...], Claim] = {}
    for name, claims in groups:
        for claim in claims:
            if claim.verdict is Verdict.PROVED:
                continue
            lines = (claim.key, claim.verdict.value, claim.statement, *_why(claim))
            told.setdefault(lines, []).append(name)
            styles[lines] = claim
    if not told:
        return
    from rich.padding import Padding
    from rich.text import Text

    console.print(f"\n{mark}Not proved", style="bold")
    if _only_the_function_fails(study):
        console.print(f"  {FUNCTION_NOT_LAW}")
    for (key, verdict, statement, *why), names in told.items():
        head = Text(f"{verdict} ", style=STYLES[styles[(key, verdict, statement, *why)].verdict])
        head.append(f"{key} ({', '.join(names)}): {statement}", style="not bold default")
        console.print(Padding(head, (0, 0, 0, 2)))
        for line in why:
            console.print(Padding(line, (0, 0, 0, 6)))


def _only_the_function_fails(study: CheckStudy) -> bool:
    """Whether some law converges for certain though its storage function may grow."""
    for case in study.cases:
        verdicts = {claim.key: claim.verdict for claim in case.claims}
        refuted = verdicts.get("lyapunov.derivative") is Verdict.REFUTED
        if refuted and verdicts.get("convergence") is Verdict.PROVED:
            return True
    return False


def _why(claim: Claim) -> Iterable[str]:
    if claim.witness is not None:
        yield f"refuted by {witness_text(claim.witness)}"
    if claim.verdict is Verdict.UNDECIDED:
        yield f"because {claim.reason}; next: {claim.next_step}"
    for evidence in claim.evidence:
        yield f"{evidence.kind.value}: {evidence.summary}"


def _simulated(console: Console, mark: str, study: CheckStudy) -> None:
    runs = [(case, metrics(case.run)) for case in study.cases if case.run is not None]
    if not runs:
        return
    console.print(
        f"\n{mark}Simulated from the initial state over [0, {float(study.scenario.horizon):g}] s",
        style="bold",
    )
    console.print(_run_table([(case.choice.label, entries) for case, entries in runs if entries]))
    said: dict[str, list[str]] = {}
    for case, _ in runs:
        for remark in _remarks(case):
            said.setdefault(remark, []).append(case.choice.label)
    for remark, labels in said.items():
        console.print(f"  {', '.join(labels)}: {remark}" if len(labels) < len(runs) else f"  {remark}")


def _run_table(runs: Sequence[tuple[str, Sequence[QuantityEntry]]]) -> Table:
    """One row a figure, one column a law."""
    table = plain_table("Figure", *(label for label, _ in runs))
    names = list(dict.fromkeys(entry.name for _, entries in runs for entry in entries))
    for name in names:
        found = [next((e for e in entries if e.name == name), None) for _, entries in runs]
        table.add_row(name.replace("_", " "), *("-" if e is None else write(e).ascii for e in found))
    return table


def _remarks(case: Case) -> Iterable[str]:
    yield from case.findings.notes
    if case.run is not None and case.run.failure:
        yield case.run.failure
    if case.run is not None and case.run.trajectory is not None and case.run.trajectory.is_saturated_model:
        yield "the torque was limited in this run; no claim covers a saturated run"
