"""Same study, same bytes; a record that departs from its schema or its arrays is refused."""

import copy
import json
from pathlib import Path

import jsonschema
import numpy as np
import pytest
from intermit.reports import Record, RecordError, read_record, write_record
from intermit.reports.parts import quantity
from intermit.reports.provenance import input_hash, provenance, source_date
from intermit.reports.record import record_schema
from intermit.reports.record.document import read_document
from intermit.reports.record.values import plain
from pydantic import ValidationError


def small(**changes: object) -> dict[str, object]:
    run = {
        "key": "run",
        "label": "from rest",
        "metrics": [quantity("peak", 1.0, 2.0)],
        "arrays": {"time": "t", "rate": "w"},
    }
    case = {"key": "adaptive", "label": "Adaptive", "law": "adaptive", "runs": [run]}
    return {
        "title": "A study",
        "provenance": provenance(scenario_name="s", scenario_text="x = 1\n", date="2021-02-01"),
        "sections": {"cases": [case]},
        "arrays": {"t": np.linspace(0, 1, 5), "w": np.ones((5, 3))},
    } | changes


def test_written_and_read_back_it_is_the_same_byte_for_byte(tmp_path: Path) -> None:
    record = Record.create(**small())  # type: ignore[arg-type]
    (tmp_path / "a").mkdir()
    (tmp_path / "b").mkdir()
    write_record(record, tmp_path / "a")
    write_record(read_record(tmp_path / "a" / "results.json"), tmp_path / "b")
    for name in ("results.json", "results.npz"):
        assert (tmp_path / "a" / name).read_bytes() == (tmp_path / "b" / name).read_bytes()
    assert sorted(p.name for p in (tmp_path / "a").iterdir()) == ["results.json", "results.npz"]


def test_it_cannot_be_changed() -> None:
    record = Record.create(**small())  # type: ignore[arg-type]
    with pytest.raises(TypeError):
        record.document["title"] = "other"  # type: ignore[index]
    with pytest.raises(TypeError):
        record.document["sections"]["cases"][0]["label"] = "other"
    with pytest.raises(ValidationError, match="frozen"):
        record.sections.cases[0].label = "other"
    with pytest.raises(ValueError, match="read-only"):
        record.array("t")[0] = 1.0


def test_the_schema_is_valid_and_accepts_it() -> None:
    schema = record_schema()
    jsonschema.Draft202012Validator.check_schema(schema)
    document = json.loads(Record.create(**small()).to_json())  # type: ignore[arg-type]
    jsonschema.Draft202012Validator(schema).validate(document)
    assert plain(read_document(document)) == document


def spoiled(document: dict, rng: np.random.Generator) -> dict:
    """Change one random node: drop it, or replace it by a value of another type."""
    document = copy.deepcopy(document)
    nodes: list[tuple[object, object]] = []

    def walk(value: object) -> None:
        items = (
            value.items() if isinstance(value, dict) else enumerate(value) if isinstance(value, list) else ()
        )
        for key, item in list(items):
            nodes.append((value, key))
            walk(item)

    walk(document)
    holder, key = nodes[rng.integers(len(nodes))]
    choice = rng.integers(4)
    if choice == 0 and isinstance(holder, dict):
        del holder[key]
    elif choice == 1 and isinstance(holder, dict):
        holder["surprise"] = 1
    else:
        holder[key] = [None, 3, "text", [], {}, True, -1.5][rng.integers(7)]  # type: ignore[index]
    return document


def fits(document: dict) -> bool:
    try:
        read_document(document)
    except ValueError:
        return False
    return True


def test_the_classes_agree_with_the_schema_made_from_them() -> None:
    validator = jsonschema.Draft202012Validator(record_schema())
    document = json.loads(Record.create(**small()).to_json())  # type: ignore[arg-type]
    rng = np.random.default_rng(1)
    refused = 0
    for _ in range(400):
        candidate = spoiled(document, rng)
        ours, theirs = fits(candidate), validator.is_valid(candidate)
        assert ours == theirs
        refused += not ours
    assert refused > 100


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"arrays": {"t": np.zeros(5)}}, "no array is called 'w'"),
        ({"arrays": {"t": np.zeros(5), "w": np.ones((4, 3))}}, "4 rows beside 5 times"),
        ({"arrays": {"t": np.zeros(5), "w": np.ones((5, 3)), "z": np.ones(1)}}, "'z' is not named"),
        ({"arrays": {"t": np.zeros(5), "w": np.full((5, 3), np.nan)}}, "no NaN"),
        ({"sections": {"casez": []}}, "unknown key 'casez'"),
        ({"sections": {"audit": {"claims": [{"key": "k"}]}}}, r"audit\.claims\[0\]: key 'title' is missing"),
        ({"sections": {"cases": object()}}, "cannot hold a object"),
        ({"sections": {"scenario": {"name": "x", "horizon": float("nan")}}}, "received NaN"),
    ],
)
def test_what_does_not_fit_is_refused_with_the_place(change: dict, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        Record.create(**small(**change))  # type: ignore[arg-type]


def test_files_that_do_not_belong_together_are_refused(tmp_path: Path) -> None:
    write_record(Record.create(**small()), tmp_path)  # type: ignore[arg-type]
    good = (tmp_path / "results.npz").read_bytes()
    other = Record.create(**small(arrays={"t": np.linspace(0, 2, 5), "w": np.ones((5, 3))}))  # type: ignore[arg-type]
    (tmp_path / "o").mkdir()
    write_record(other, tmp_path / "o")
    (tmp_path / "results.npz").write_bytes((tmp_path / "o" / "results.npz").read_bytes())
    with pytest.raises(RecordError, match="not the one the document was written with"):
        read_record(tmp_path)
    (tmp_path / "results.npz").write_bytes(good[:100])
    with pytest.raises(RecordError, match=r"results\.npz"):
        read_record(tmp_path)
    (tmp_path / "results.npz").unlink()
    with pytest.raises(RecordError, match="keep both files together"):
        read_record(tmp_path)


@pytest.mark.parametrize(
    "text", ["", "{}", "[]", '{"format": "intermit-record", "version": 99}', "[" * 100000, '{"a": NaN}']
)
def test_what_is_not_a_record_is_refused(tmp_path: Path, text: str) -> None:
    (tmp_path / "results.json").write_text(text)
    with pytest.raises(RecordError):
        read_record(tmp_path / "results.json")


QUANTITY = {"name": "floor", "low": 0.1, "high": "inf", "unit": "s", "label": "floor", "rigorous": True}
EARLIER = {
    "format": "intermit-record",
    "version": 1,
    "title": "Check of paper",
    "provenance": {
        "package_version": "0.0.9",
        "command": "intermit check paper.toml",
        "author": "",
        "scenario_name": "paper",
        "scenario_text": "",
        "input_sha256": "0",
        "date": "",
        "versions": {"numpy": "2.0"},
        "seeds": {"derivative samples": 1},
        "options": {"samples": 100, "claims": []},
        "effort": [{"label": "right-hand sides", "count": 3}],
    },
    "outcome": {"exit_code": 0, "sentence": "1 claim holds."},
    "arrays": {},
    "sections": {
        "scenario": {"name": "paper", "facts": [{"label": "inertia", "matrix": [[1.0]], "unit": "kg m^2"}]},
        "cases": [
            {
                "key": "law1",
                "label": "Adaptive",
                "law": "adaptive-scaling",
                "parameters": [QUANTITY],
                "certificates": [{"key": "c", "label": "bounds", "quantities": [QUANTITY], "notes": []}],
            }
        ],
        "comparison": {
            "tables": [
                {
                    "key": "laws",
                    "title": "Laws",
                    "columns": [{"key": "law", "label": "law", "unit": ""}],
                    "rows": [{"law": "a"}, {"law": None}, {"law": QUANTITY}, {"law": {"code": "x"}}],
                    "notes": [],
                }
            ]
        },
    },
}
"""A record as the release before wrote it: no equations, no bounds of speed and torque."""


def written_as(document: dict, folder: Path) -> Path:
    path = folder / "results.json"
    path.write_text(json.dumps(document, sort_keys=True, indent=1, ensure_ascii=False) + "\n")
    return path


def test_the_release_befores_records_open_and_are_kept(tmp_path: Path) -> None:
    path = written_as(EARLIER, tmp_path)
    record = read_record(path)
    assert record.sections.cases[0].parameters[0].high == float("inf")
    assert record.to_json() == path.read_text()


def test_what_does_not_fit_names_its_version_and_the_remedy(tmp_path: Path) -> None:
    unknown = copy.deepcopy(EARLIER)
    unknown["sections"]["appendix"] = {}  # type: ignore[index]
    with pytest.raises(RecordError) as refused:
        read_record(written_as(unknown, tmp_path))
    said = str(refused.value)
    assert "record.sections: unknown key 'appendix'" in said
    assert "written by intermit 0.0.9 (format version 1): write it again with this version" in said
    assert "\n" not in said


def test_provenance_takes_the_date_from_the_user_or_the_source(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("SOURCE_DATE_EPOCH", raising=False)
    assert source_date() == ""
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "86400")
    assert source_date() == "1970-01-02"
    assert provenance(scenario_name="s", scenario_text="", date="2021-02-01").date == "2021-02-01"
    monkeypatch.setenv("SOURCE_DATE_EPOCH", "yesterday")
    with pytest.raises(ValueError, match="whole seconds"):
        source_date()


def test_the_input_hash_sees_where_one_file_ends() -> None:
    assert input_hash("a", [b"bc"]) != input_hash("ab", [b"c"])


def test_values_become_plain() -> None:
    assert plain({"a": (np.float64(1.5), float("inf")), "b": "\udc80"}) == {"a": [1.5, "inf"], "b": "?"}
