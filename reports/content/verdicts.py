"""The first screen: what was asked, what came out, and how to check it again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..numbers import write
from ..record import Record
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
    found = ((label, tuple(claims)) for label, claims in _groups(record.document["sections"]) if claims)
    return tuple(Group(label, claims, i + 1) for i, (label, claims) in enumerate(found))


def _groups(sections: Mapping[str, Any]) -> Iterator[tuple[str, list[Mapping[str, Any]]]]:
    yield "Schedule", list(sections.get("schedule", {}).get("claims", ()))
    for case in sections.get("cases", ()):
        yield case["label"], list(case.get("claims", ()))
    for optimum in sections.get("optimum", ()):
        yield optimum["label"], list(optimum.get("claims", ()))
    for key, title in COLLECTIONS.items():
        yield title, list(sections.get(key, {}).get("claims", ()))


COLLECTIONS = {
    "comparison": "Law against optimum",
    "front": "Peak torque against settling time",
    "tuning": "Tuning",
    "schedule_study": "Schedule study",
    "paper_claims": "The paper's claims",
    "audit": "Audit of the printed equations",
}


def refutation(claim: Mapping[str, Any]) -> str:
    """Say in one line what refutes a claim, and by how much; empty if nothing does."""
    witness = claim.get("witness")
    if not witness:
        return ""
    violation = witness["violation"]
    return f"{witness['description']}: {violation.get('label') or violation['name']} {write(violation).text}"


def claim_numbers(claim: Mapping[str, Any]) -> tuple[Mapping[str, Any], ...]:
    """Numbers the verdict table shows: the margins, or without any the first rigorous quantity."""
    rigorous = [q for q in claim["quantities"] if q.get("rigorous")][:1]
    return tuple(claim["margins"] or rigorous)


def counted(claims: tuple[Mapping[str, Any], ...]) -> tuple[tuple[str, int], ...]:
    """How many of the claims that count have each verdict."""
    deciding = [c["verdict"] for c in claims if c.get("counted", True)]
    return tuple((v, deciding.count(v)) for v in VERDICTS if v in deciding)


def answer(record: Record) -> str:
    """One sentence: how many claims, how they came out."""
    claims = tuple(c for g in groups(record) for c in g.claims)
    parts = [f"{count} {verdict}" for verdict, count in counted(claims)]
    if not parts:
        summaries = [record.document["sections"].get(key, {}).get("summary", "") for key in COLLECTIONS]
        said = record.document.get("outcome", {}).get("sentence", "")
        return next((s for s in (*summaries, said) if s), "No claim was asked for.")
    total = sum(count for _, count in counted(claims))
    return f"{plural(total, 'claim')} asked: {', '.join(parts)}."


def verdict_chapter(record: Record) -> Chapter:
    """Cards, then the table."""
    found = groups(record)
    blocks: list[Block] = [Text(sentence) for sentence in _not_proved(found)]
    cards = tuple(_card(case, record) for case in record.document["sections"].get("cases", ()))
    if cards:
        blocks.append(Cards(cards))
    others = tuple(c for g in found for _, c in g.entries(counted=False))
    if len(others) < sum(len(g.claims) for g in found):
        blocks.append(Verdicts(found))
    if others:
        blocks.append(Verdicts(found, counted=False, summary=_others(others)))
    blocks.extend(Text(note, "warning") for note in _warnings(record.document["sections"]))
    return Chapter("verdicts", "Verdicts", tuple(blocks))


def _not_proved(found: tuple[Group, ...]) -> Iterator[str]:
    """Name the counted claims that fail, the refuted first: what a reader asks next."""
    for verdict in ("REFUTED", "UNDECIDED"):
        by_title: dict[str, list[str]] = {}
        for group in found:
            for _, claim in group.entries(counted=True):
                if claim["verdict"] == verdict:
                    by_title.setdefault(short(claim["title"]), []).append(short(group.label))
        if by_title:
            named = "; ".join(f"{title} ({', '.join(labels)})" for title, labels in by_title.items())
            yield f"{verdict}: {named}."


def _others(claims: tuple[Mapping[str, Any], ...]) -> str:
    """Say how the findings that do not decide the outcome came out."""
    verdicts = [c["verdict"] for c in claims]
    parts = [f"{verdicts.count(v)} {v}" for v in VERDICTS if v in verdicts]
    return f"Also found, not counted in the outcome: {', '.join(parts)}"


def _card(case: Mapping[str, Any], record: Record) -> Card:
    numbers = [dict(q) | {"label": "certified floor of R"} for q in floors(case)][:1]
    for run in case.get("runs", ())[:1]:
        by_name = {q["name"]: q for q in run["metrics"]}
        numbers += [
            dict(by_name[name]) | {"label": label} for name, label in HEADLINE_NUMBERS if name in by_name
        ]
    numbers += _ratios(case["label"], record)
    return Card(case["label"], counted(tuple(case.get("claims", ()))), tuple(numbers))


def _ratios(label: str, record: Record) -> list[dict[str, Any]]:
    """The law's peak over the least any controller needs, in the first norm compared."""
    for table in record.document["sections"].get("comparison", {}).get("tables", ()):
        for row in table["rows"]:
            if row.get("law") == label and isinstance(row.get("ratio"), Mapping):
                return [dict(row["ratio"]) | {"label": "peak over the least possible"}]
    return []


def floors(case: Mapping[str, Any]) -> list[Mapping[str, Any]]:
    """Certified floors of R, from the certificates or, without any, from the claims."""
    holders = [*case.get("certificates", ()), *case.get("claims", ())]
    return [
        q for holder in holders for q in holder["quantities"] if q["name"] in FLOORS and q.get("rigorous")
    ]


def _warnings(sections: Mapping[str, Any]) -> Iterator[str]:
    for case in sections.get("cases", ()):
        for run in case.get("runs", ()):
            if run.get("saturated"):
                where = f"{case['label']}, {run['label']}"
                yield f"{where}: the torque was limited; no claim covers a saturated run."


def claims_chapter(record: Record) -> Chapter | None:
    """Every claim in full, at the end."""
    found = groups(record)
    return Chapter("claims", "The claims in full", (ClaimDetails(found),)) if found else None
