"""The first screen: what was asked, what came out, and how to check it again."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

from ..record import Record
from .blocks import Block, Card, Cards, Chapter, ClaimDetails, Group, Text, Verdicts
from .wording import plural

VERDICTS = ("PROVED", "REFUTED", "UNDECIDED")
HEADLINE_NUMBERS = ("peak_component", "peak_euclidean", "settling_time", "filter_minimum")
"""Metrics of a run that stand on a law's card, if the record has them."""


def groups(record: Record) -> tuple[Group, ...]:
    """Claims by subject: the study's own, the schedule's, each law's, the optimum's, the collections'."""
    return tuple(Group(label, tuple(claims)) for label, claims in _groups(record.sections) if claims)


def _groups(sections: Mapping[str, Any]) -> Iterator[tuple[str, list[Mapping[str, Any]]]]:
    yield "Study", list(sections.get("claims", ()))
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
    "linear": "Linear plant",
    "audit": "Audit of the printed equations",
    "appendix": "More",
}


def counted(claims: tuple[Mapping[str, Any], ...]) -> tuple[tuple[str, int], ...]:
    """How many of the claims that count have each verdict."""
    deciding = [c["verdict"] for c in claims if c.get("counted", True)]
    return tuple((v, deciding.count(v)) for v in VERDICTS if v in deciding)


def answer(record: Record) -> str:
    """One sentence: how many claims, how they came out."""
    claims = tuple(c for g in groups(record) for c in g.claims)
    parts = [f"{count} {verdict}" for verdict, count in counted(claims)]
    if not parts:
        return "No claim was asked for."
    total = sum(count for _, count in counted(claims))
    return f"{plural(total, 'claim')} asked: {', '.join(parts)}."


def verdict_chapter(record: Record) -> Chapter:
    """Cards, then the table."""
    blocks: list[Block] = []
    cards = tuple(_card(case) for case in record.sections.get("cases", ()))
    sentence = record.document.get("outcome", {}).get("sentence", "")
    if sentence:
        blocks.append(Text(sentence))
    if cards:
        blocks.append(Cards(cards))
    found = groups(record)
    if found:
        blocks.append(Verdicts(found))
    blocks.extend(Text(note, "warning") for note in _warnings(record.sections))
    return Chapter("verdicts", "Verdicts", tuple(blocks))


def _card(case: Mapping[str, Any]) -> Card:
    numbers = [
        q
        for c in case.get("certificates", ())
        for q in c["quantities"]
        if "floor" in q["name"] and q.get("rigorous")
    ][:1]
    for run in case.get("runs", ())[:1]:
        by_name = {q["name"]: q for q in run["metrics"]}
        numbers += [by_name[name] for name in HEADLINE_NUMBERS if name in by_name]
    return Card(case["label"], counted(tuple(case.get("claims", ()))), tuple(numbers))


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
