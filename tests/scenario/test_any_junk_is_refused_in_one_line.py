"""Whatever stands in a scenario file, it becomes a scenario or one line: never another exception."""

import tomllib
from decimal import Decimal

import pytest
from intermit.scenario import TEMPLATE, ScenarioError
from intermit.scenario.document import Document
from intermit.scenario.scenario import build_scenario
from intermit.scenario.schema import ScenarioFile
from intermit.scenario.validate import table_of, validate

JUNK = [
    "0",
    "-1",
    "1e-30",
    "1e30",
    "nan",
    "-inf",
    "true",
    '""',
    '"x"',
    '"a\\u0000b"',
    '"../../.."',
    "[]",
    "[[]]",
    "[1]",
    "[1, 2]",
    "[1, 2, 3]",
    "[1, 2, 3, 4]",
    "[0, 0, 0]",
    "[0, 0, 0, 0]",
    "[[1, 2], [3]]",
    "[[1, 2, 3], [2, 1, 0], [3, 0, 1]]",
    "[true]",
    "[[[1], [1], [1]], [[1], [1], [1]], [[1], [1], [1]]]",
    "{}",
    "{ a = 1 }",
    "[{}]",
    "1979-05-27",
    "99999999999999999999999999",
    "'''a\nb'''",
]


def keys():
    for name, field in ScenarioFile.model_fields.items():
        table = table_of(field.annotation)
        yield name, None
        if table is not None:
            for key, inner in table.model_fields.items():
                yield name, inner.alias or key


@pytest.mark.parametrize(("table", "key"), list(keys()), ids=lambda value: str(value))
def test_junk(tmp_path, table, key):
    outcomes = set()
    for junk in JUNK:
        tables = tomllib.loads(TEMPLATE, parse_float=Decimal)
        value = tomllib.loads(f"x = {junk}", parse_float=Decimal)["x"]
        if key is None:
            tables[table] = value
        elif table == "law":
            tables["law"][0][key] = value
        else:
            tables.setdefault(table, {})[key] = value
        document = Document(tables, {}, tmp_path / "s.toml")
        try:
            build_scenario(validate(document), document)
        except ScenarioError as error:
            message = str(error)
            outcomes.add("refused")
            assert message.startswith("s.toml: ")
            assert table in message or "initial" in message
            assert "\n" not in message
            assert len(message) < 400
            assert "pydantic" not in message
        else:
            outcomes.add("loaded")
    assert "refused" in outcomes
