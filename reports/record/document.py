"""The document of a record: where it comes from, its sections, its outcome; and its JSON Schema."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Annotated, Any, Literal

from pydantic import Field, JsonValue, ValidationError
from pydantic_core import ErrorDetails

from .base import Integer, Part
from .optimum import OptimumEntry
from .problem import ScenarioEntry, ScheduleEntry
from .runs import CaseEntry, EffortEntry, SamplesEntry
from .tables import CollectionEntry

FORMAT = "intermit-record"
VERSION = 1
MAX_PLACE = 120
"""Characters of a place that a message shows."""


class Provenance(Part):
    """Where a record comes from."""

    package_version: str
    scenario_name: str
    scenario_text: str
    input_sha256: str
    date: Annotated[str, Field(description="ISO 8601, given by the user or SOURCE_DATE_EPOCH; else empty")]
    versions: dict[str, str]
    seeds: dict[str, Integer]
    options: dict[str, JsonValue]
    command: str = ""
    author: str = ""
    effort: tuple[EffortEntry, ...] = ()


class Outcome(Part):
    """What the study came to."""

    exit_code: Annotated[Integer, Field(ge=0)]
    sentence: str = ""


class Sections(Part):
    """What was found; a section that was not asked for is not there."""

    scenario: ScenarioEntry | None = None
    schedule: ScheduleEntry | None = None
    cases: tuple[CaseEntry, ...] = ()
    samples: tuple[SamplesEntry, ...] = ()
    optimum: tuple[OptimumEntry, ...] = ()
    comparison: CollectionEntry | None = None
    front: CollectionEntry | None = None
    tuning: CollectionEntry | None = None
    schedule_study: CollectionEntry | None = None
    paper_claims: CollectionEntry | None = None
    audit: CollectionEntry | None = None


class ArrayEntry(Part):
    """An array's shape, and the hash of its little-endian float64 bytes."""

    shape: tuple[Integer, ...]
    sha256: str


class Document(Part):
    """Everything that was found in one study; every page is made from it."""

    format: Literal["intermit-record"]
    version: Annotated[Integer, Field(ge=VERSION, le=VERSION)]
    title: str
    provenance: Provenance
    sections: Sections
    arrays: dict[str, ArrayEntry]
    outcome: Outcome | None = None


def record_schema() -> dict[str, Any]:
    """The JSON Schema of `results.json`, made from these classes."""
    schema = Document.model_json_schema()
    head = {"$schema": "https://json-schema.org/draft/2020-12/schema", "title": "intermit record"}
    return schema | head | {"$id": "https://intermit.invalid/schema/record-1.json"}


def read_document(document: Mapping[str, Any]) -> Document:
    """Read a document's parts.

    Raises
    ------
    ValueError
        With the place, what was expected and what was received, if it departs from its form.
    """
    try:
        return Document.model_validate(document)
    except ValidationError as error:
        problems = [_problem(e, document) for e in error.errors(include_url=False)]
        more = f" (and {len(problems) - 1} more)" if len(problems) > 1 else ""
        raise ValueError(problems[0] + more) from None


def _problem(error: ErrorDetails, document: object) -> str:
    """One departure in words: "record.sections.cases[0]: key 'law' is missing"."""
    last = error["loc"][-1] if error["loc"] else ""
    if error["type"] == "missing":
        return f"{_place(error['loc'], document)}: key {last!r} is missing"
    if error["type"] == "extra_forbidden":
        return f"{_place(error['loc'][:-1], document)}: unknown key {last!r}"
    shown = repr(error["input"])
    shown = shown if len(shown) <= 60 else shown[:57] + "..."
    return f"{_place(error['loc'], document)}: {error['msg'].lower()}, received {shown}"


def _place(loc: tuple[int | str, ...], value: object) -> str:
    """Where in the document: pydantic's place without the names of its types."""
    place = "record"
    for step in loc:
        if isinstance(step, int) and isinstance(value, (list, tuple)):
            place, value = f"{place}[{step}]", value[step]
        elif isinstance(step, str) and isinstance(value, Mapping) and step in value:
            place, value = f"{place}.{step}", value[step]
    return place if len(place) <= MAX_PLACE else f"{place[:MAX_PLACE]}..."
