"""docs/scenario.md names every table and key that the file may have, and no other in its tables."""

import re
from pathlib import Path

from intermit.models.laws import LAWS
from intermit.scenario.schema import ScenarioFile
from intermit.scenario.validate import table_of

# beside the tests, not in the installed package, which ships no docs
PAGE = Path(__file__).parents[2] / "docs" / "scenario.md"


PARAMETERS = {name for law in LAWS.values() for name in law.described()}


def keys(model, prefix=()):
    for name, field in model.model_fields.items():
        path = (*prefix, field.alias or name)
        inner = table_of(field.annotation)
        if inner is None:
            yield path
        else:
            yield from keys(inner, path)


def test_every_key_is_documented():
    named = set(re.findall(r"`([A-Za-z0-9_.]+)`", PAGE.read_text(encoding="utf-8")))
    missing = [path for path in keys(ScenarioFile) if path[-1] not in named and ".".join(path) not in named]
    assert missing + sorted(PARAMETERS - named) == []


def test_no_documented_key_is_unknown():
    known = {part for path in keys(ScenarioFile) for part in path} | {"extends", "with", "or"} | PARAMETERS
    first_cells = re.findall(r"^\| ([^|]+) \|", PAGE.read_text(encoding="utf-8"), flags=re.MULTILINE)
    named = {key for cell in first_cells for key in re.findall(r"`([A-Za-z0-9_.]+)`", cell)}
    assert {key for key in named if not set(key.split(".")) <= known} == set()
