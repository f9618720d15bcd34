"""The title block: what a report is about, its answer, and which record it was made from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from ..record import Record
from .comparing import comparison_sentence
from .verdicts import answer

OUTCOMES = {0: "PROVED", 1: "REFUTED", 3: "UNDECIDED"}
"""What a study's exit code stands for."""


@final
@dataclass(frozen=True)
class Heading:
    """Everything above the first chapter.

    Attributes
    ----------
    title, sentence : the report's name and its answer in one sentence
    scenario, author, date, version : as the record has them; any may be empty
    digests : sha256 of the record, or of both records of a comparison
    status : the outcome's verdict, empty for a comparison or a study without one
    """

    title: str
    sentence: str
    scenario: str
    author: str
    date: str
    version: str
    digests: tuple[str, ...]
    status: str = ""

    @property
    def digest(self) -> str:
        """The digests in words."""
        return " and ".join(self.digests)

    @property
    def brief_digest(self) -> str:
        """The first characters of each digest, enough to tell records apart."""
        return " and ".join(d[:12] for d in self.digests)


def heading(record: Record) -> Heading:
    """Title block of one record's report."""
    origin, outcome = record.provenance, record.outcome
    return Heading(
        title=record.title,
        sentence=answer(record),
        scenario=origin.scenario_name,
        author=origin.author,
        date=origin.date,
        version=origin.package_version,
        digests=(record.sha256,),
        status=OUTCOMES.get(outcome.exit_code, "") if outcome is not None else "",
    )


def comparison_heading(a: Record, b: Record) -> Heading:
    """Title block of two records side by side; what both share is said once."""
    one, two = heading(a), heading(b)
    return Heading(
        title=_both(one.title, two.title),
        sentence=comparison_sentence(a, b),
        scenario=_both(one.scenario, two.scenario),
        author=_both(one.author, two.author),
        date=_both(one.date, two.date),
        version=_both(one.version, two.version),
        digests=(*one.digests, *two.digests),
    )


def _both(one: str, two: str) -> str:
    return one if one == two else " / ".join(part for part in (one, two) if part)
