"""The report's table of contents: which chapters a record gives, in which order."""

from __future__ import annotations

from ..record import Record
from .blocks import Chapter
from .optimum import optimum_chapter
from .problem import problem_chapter, provenance_chapter, schedule_chapter
from .runs import attitude_chapter, filter_chapter, storage_chapter, torque_chapter
from .studies import collection_chapter, samples_chapter
from .verdicts import claims_chapter, collections, verdict_chapter


def chapters(record: Record) -> tuple[Chapter, ...]:
    """Chapters of the report; those the record has nothing for are left out."""
    found = [
        verdict_chapter(record),
        problem_chapter(record),
        schedule_chapter(record),
        filter_chapter(record),
        torque_chapter(record),
        attitude_chapter(record),
        storage_chapter(record),
        samples_chapter(record),
        optimum_chapter(record),
        *(collection_chapter(record, *held) for held in collections(record.sections)),
        claims_chapter(record),
        provenance_chapter(record),
    ]
    return tuple(c for c in found if c is not None)
