"""The first screen: what was asked, what came out, and how to check it again."""

from __future__ import annotations

from collections.abc import Iterator

from ..numbers import write
from ..record import Record
from ..record.claims import ClaimEntry, QuantityEntry
from ..record.document import Sections
from ..record.runs import CaseEntry
from ..record.tables import CollectionEntry
from .blocks import Block, Card, Cards, Chapter, ClaimDetails, Group, Text, Verdicts
from .wording import plural, short

VERDICTS = ("PROVED", "REFUTED", "UNDECIDED")
FLOORS = ("certified_floor", "filter_floor")
"""Quantities of a certificate or a claim that are a certified floor of R."""
HEADLINE_NUMBERS = (
    ("peak_torque_component", "peak torque, largest component"),
    ("peak_torque_euclidean", "peak torque, Euclidean"),
    ("settling_time", "settling time"),
    ("least_filter_state", "least R along the run"),
)
"""Metrics of a run that stand on a law's card, if the record has them, and what they are called there."""


def groups(record: Record) -> tuple[Group, ...]:
    """Claims by subject: the schedule's, each law's, the optimum's, the collections'."""
    found = ((label, tuple(claims)) for label, claims in _groups(record.sections) if claims)
    return tuple(Group(label, claims, i + 1) for i, (label, claims) in enumerate(found))


def _groups(sections: Sections) -> Iterator[tuple[str, tuple[ClaimEntry, ...]]]:
    if sections.schedule is not None:
        yield "Schedule", sections.schedule.claims
    for case in sections.cases:
        yield case.label, case.claims
    for _, title, collection in collections(sections):
        yield title, collection.claims


def collections(sections: Sections) -> Iterator[tuple[str, str, CollectionEntry]]:
    """The studies made of tables and figures that the record holds: key, title, and what is in it."""
    held = (
        ("comparison", "Law against optimum", sections.comparison),
        ("front", "Peak torque against settling time", sections.front),
        ("tuning", "Tuning", sections.tuning),
        ("schedule-study", "Schedule study", sections.schedule_study),
        ("paper-claims", "The paper's claims", sections.paper_claims),
        ("audit", "Audit of the printed equations", sections.audit),
    )
    for key, title, collection in held:
        if collection is not None:
            yield key, title, collection


def refutation(claim: ClaimEntry) -> str:
    """Say in one line what refutes a claim, and by how much; empty if nothing does."""
    if claim.witness is None:
        return ""
    violation = claim.witness.violation
    return f"{claim.witness.description}: {violation.words} {write(violation).text}"


def claim_numbers(claim: ClaimEntry) -> tuple[QuantityEntry, ...]:
    """Numbers the verdict table shows: the margins, or without any the first rigorous quantity."""
    return claim.margins or tuple(q for q in claim.quantities if q.rigorous)[:1]


def counted(claims: tuple[ClaimEntry, ...]) -> tuple[tuple[str, int], ...]:
    """How many of the claims that count have each verdict."""
    deciding = [c.verdict for c in claims if c.counted]
    return tuple((v, deciding.count(v)) for v in VERDICTS if v in deciding)


def answer(record: Record) -> str:
    """One sentence: how many claims, how they came out."""
    claims = tuple(c for g in groups(record) for c in g.claims)
    parts = [f"{count} {verdict}" for verdict, count in counted(claims)]
    if not parts:
        summaries = [collection.summary for _, _, collection in collections(record.sections)]
        said = record.outcome.sentence if record.outcome is not None else ""
        return next((s for s in (*summaries, said) if s), "No claim was asked for.")
    total = sum(count for _, count in counted(claims))
    return f"{plural(total, 'claim')} asked: {', '.join(parts)}."


def verdict_chapter(record: Record) -> Chapter:
    """Cards, then the table."""
    found = groups(record)
    blocks: list[Block] = [Text(sentence) for sentence in _not_proved(found)]
    cards = tuple(_card(case, record) for case in record.sections.cases)
    if cards:
        blocks.append(Cards(cards))
    others = tuple(c for g in found for _, c in g.entries(counted=False))
    if len(others) < sum(len(g.claims) for g in found):
        blocks.append(Verdicts(found))
    if others:
        blocks.append(Verdicts(found, counted=False, summary=_others(others)))
    blocks.extend(Text(note, "warning") for note in _warnings(record.sections))
    return Chapter("verdicts", "Verdicts", tuple(blocks))


def _not_proved(found: tuple[Group, ...]) -> Iterator[str]:
    """Name the counted claims that fail, the refuted first: what a reader asks next."""
    for verdict in ("REFUTED", "UNDECIDED"):
        by_title: dict[str, list[str]] = {}
        for group in found:
            for _, claim in group.entries(counted=True):
                if claim.verdict == verdict:
                    by_title.setdefault(short(claim.title), []).append(short(group.label))
        if by_title:
            named = "; ".join(f"{title} ({', '.join(labels)})" for title, labels in by_title.items())
            yield f"{verdict}: {named}."


def _others(claims: tuple[ClaimEntry, ...]) -> str:
    """Say how the findings that do not decide the outcome came out."""
    verdicts = [c.verdict for c in claims]
    parts = [f"{verdicts.count(v)} {v}" for v in VERDICTS if v in verdicts]
    return f"Also found, not counted in the outcome: {', '.join(parts)}"


def _card(case: CaseEntry, record: Record) -> Card:
    numbers = [q.labelled("certified floor of R") for q in floors(case)][:1]
    for run in case.runs[:1]:
        by_name = {q.name: q for q in run.metrics}
        numbers += [by_name[name].labelled(label) for name, label in HEADLINE_NUMBERS if name in by_name]
    numbers += _ratios(case.label, record)
    return Card(case.label, counted(case.claims), tuple(numbers))


def _ratios(label: str, record: Record) -> list[QuantityEntry]:
    """The law's peak over the least any controller needs, in the first norm compared."""
    comparison = record.sections.comparison
    for table in comparison.tables if comparison is not None else ():
        for row in table.rows:
            ratio = row.get("ratio")
            if row.get("law") == label and isinstance(ratio, QuantityEntry):
                return [ratio.labelled("peak over the least possible")]
    return []


def floors(case: CaseEntry) -> list[QuantityEntry]:
    """Certified floors of R, from the certificates or, without any, from the claims."""
    held = [*(c.quantities for c in case.certificates), *(c.quantities for c in case.claims)]
    return [q for quantities in held for q in quantities if q.name in FLOORS and q.rigorous]


def _warnings(sections: Sections) -> Iterator[str]:
    for case in sections.cases:
        for run in case.runs:
            if run.saturated:
                where = f"{case.label}, {run.label}"
                yield f"{where}: the torque was limited; no claim covers a saturated run."


def claims_chapter(record: Record) -> Chapter | None:
    """Every claim in full, at the end."""
    found = groups(record)
    return Chapter("claims", "The claims in full", (ClaimDetails(found),)) if found else None
