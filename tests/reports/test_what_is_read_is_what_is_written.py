"""A field of the record that no study writes does not exist; readers know no key but the classes' fields."""

import ast
from pathlib import Path
from typing import get_args

import intermit
import pytest
from intermit.reports.record import base, claims, document, optimum, problem, record_schema, runs, tables
from intermit.reports.record.base import ArrayOf, Part

ROOT = Path(intermit.__file__).parent
ASSEMBLED = {document.Document, document.ArrayEntry}
"""Put together by `Record.create` from the arrays and what it is given."""
PARTS = [
    part
    for module in (claims, document, optimum, problem, runs, tables)
    for part in vars(module).values()
    if isinstance(part, type) and issubclass(part, Part) and part is not Part and part not in ASSEMBLED
]


def sources(*rooms: str) -> list[Path]:
    return [p for room in rooms for p in sorted((ROOT / room).rglob("*.py"))]


def written(files: list[Path]) -> dict[str, set[str]]:
    """Keywords with which each class is called, by the class's name."""
    found: dict[str, set[str]] = {}
    for path in files:
        for node in ast.walk(ast.parse(path.read_text(encoding="utf-8"))):
            if isinstance(node, ast.Call) and isinstance(node.func, ast.Name):
                found.setdefault(node.func.id, set()).update(k.arg for k in node.keywords if k.arg)
    return found


WRITTEN = written([*sources("study"), ROOT / "reports/parts.py", ROOT / "reports/provenance.py"])


@pytest.mark.parametrize("part", dict.fromkeys(PARTS), ids=lambda p: p.__name__)
def test_every_field_has_a_writer(part: type[Part]) -> None:
    assert set(part.model_fields) <= WRITTEN.get(part.__name__, set())


def test_a_field_without_writer_would_be_seen() -> None:
    class QuantityEntry(claims.QuantityEntry):
        invented: str = ""

    assert set(QuantityEntry.model_fields) - WRITTEN["QuantityEntry"] == {"invented"}


@pytest.mark.parametrize(
    ("arrays", "roles"),
    [
        (runs.RunArrays, runs.RunRole),
        (runs.BoundArrays, runs.BoundRole),
        (optimum.OptimumArrays, optimum.OptimumRole),
    ],
)
def test_roles_are_the_fields(arrays: type[Part], roles: object) -> None:
    assert {*get_args(roles)} == {*arrays.model_fields} - {"time", "controller"}


def test_a_changed_part_is_checked_like_a_new_one() -> None:
    part = tables.ColumnEntry(key="k", label="l")
    assert part.but(label="m").label == "m"
    with pytest.raises(ValueError, match="invented"):
        part.but(invented=1)


def test_no_page_reads_keys_of_the_document() -> None:
    """Pages and commands read typed parts; the document's JSON is for files and for tests."""
    for path in sources("cli", "study", "reports/content", "reports/exports", "reports/html", "reports/pdf"):
        text = path.read_text(encoding="utf-8")
        assert ".document[" not in text, path
        assert ".document.get" not in text, path


def test_the_schema_states_the_unit_of_every_field_that_has_one() -> None:
    schema = record_schema()["$defs"]
    for part in PARTS:
        for field, info in part.model_fields.items():
            stated = schema[part.__name__]["properties"][field]
            for mark in info.metadata:
                if isinstance(mark, ArrayOf):
                    assert stated["array"] == {"unit": mark.unit, "shape": mark.shape}
                elif isinstance(mark, base.Unit):
                    assert stated["unit"] == mark.unit
    assert schema["RunArrays"]["properties"]["rate"]["array"] == {"unit": "rad/s", "shape": "(n, 3)"}
    assert schema["ScenarioEntry"]["properties"]["inertia"]["unit"] == "kg m^2"
