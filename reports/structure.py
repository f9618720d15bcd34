"""A light structural check: the part of JSON Schema that the record's own schema uses.

The shipped schema is the one definition of the format; this reads it without a dependency.
Only the keywords in `KEYWORDS` are understood, and an unknown one is an error, so the schema
cannot quietly say more than is checked.
"""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping
from functools import cache
from importlib.resources import files
from typing import Any

_NOTES = frozenset({"$schema", "$id", "$defs", "title", "description"})
_CHECKS = frozenset({"$ref", "type", "enum", "const", "anyOf", "required", "properties", "minimum"})
_MORE_CHECKS = frozenset({"additionalProperties", "items", "minItems", "maxItems"})
KEYWORDS = _NOTES | _CHECKS | _MORE_CHECKS
_TYPES: dict[str, tuple[type, ...]] = {
    "object": (dict,),
    "array": (list,),
    "string": (str,),
    "number": (int, float),
    "integer": (int,),
    "boolean": (bool,),
    "null": (type(None),),
}


@cache
def record_schema() -> dict[str, Any]:
    """Read the shipped JSON Schema of the record."""
    text = files("intermit.reports").joinpath("schema/record.schema.json").read_text(encoding="utf-8")
    schema: dict[str, Any] = json.loads(text)
    return schema


def faults(value: Any, schema: Mapping[str, Any] | None = None, where: str = "record") -> Iterator[str]:
    """Every way `value` departs from the schema, each as "path: expected ..., received ..."."""
    root = record_schema()
    yield from _faults(value, root if schema is None else schema, root, where)


def _faults(value: Any, schema: Mapping[str, Any], root: Mapping[str, Any], where: str) -> Iterator[str]:
    unknown = set(schema) - KEYWORDS
    if unknown:
        raise ValueError(f"schema keyword not understood at {where}: {sorted(unknown)}")
    if "$ref" in schema:
        yield from _faults(value, root["$defs"][schema["$ref"].removeprefix("#/$defs/")], root, where)
    if "anyOf" in schema and not any(not list(_faults(value, s, root, where)) for s in schema["anyOf"]):
        wanted = ", ".join(str(s.get("title") or s.get("$ref", s.get("type"))) for s in schema["anyOf"])
        yield f"{where}: expected one of ({wanted}), received {_show(value)}"
    if "const" in schema and not _same(value, schema["const"]):
        yield f"{where}: expected {schema['const']!r}, received {_show(value)}"
    if "enum" in schema and not any(_same(value, e) for e in schema["enum"]):
        yield f"{where}: expected one of {schema['enum']}, received {_show(value)}"
    if "type" in schema and not _is(value, schema["type"]):
        yield f"{where}: expected {schema['type']}, received {_show(value)}"
        return
    if "minimum" in schema and isinstance(value, (int, float)) and value < schema["minimum"]:
        yield f"{where}: expected at least {schema['minimum']}, received {_show(value)}"
    if isinstance(value, dict):
        yield from _object_faults(value, schema, root, where)
    if isinstance(value, list):
        yield from _array_faults(value, schema, root, where)


def _object_faults(
    value: dict[str, Any], schema: Mapping[str, Any], root: Mapping[str, Any], where: str
) -> Iterator[str]:
    for key in schema.get("required", ()):
        if key not in value:
            yield f"{where}: key {key!r} is missing"
    properties = schema.get("properties", {})
    extra = schema.get("additionalProperties", True)
    for key, item in value.items():
        if key in properties:
            yield from _faults(item, properties[key], root, f"{where}.{key}")
        elif extra is False:
            yield f"{where}: unknown key {key!r}"
        elif isinstance(extra, Mapping):
            yield from _faults(item, extra, root, f"{where}.{key}")


def _array_faults(
    value: list[Any], schema: Mapping[str, Any], root: Mapping[str, Any], where: str
) -> Iterator[str]:
    if len(value) < schema.get("minItems", 0) or len(value) > schema.get("maxItems", len(value)):
        yield f"{where}: a list of {len(value)} is too short or too long"
    if "items" in schema:
        for i, item in enumerate(value):
            yield from _faults(item, schema["items"], root, f"{where}[{i}]")


def _is(value: Any, names: str | list[str]) -> bool:
    for name in [names] if isinstance(names, str) else names:
        if isinstance(value, bool) and name != "boolean":
            continue
        if isinstance(value, _TYPES[name]):
            return True
    return False


def _same(value: Any, wanted: Any) -> bool:
    """Equality in which True is not 1."""
    return isinstance(value, bool) == isinstance(wanted, bool) and bool(value == wanted)


def _show(value: Any) -> str:
    text = repr(value)
    return text if len(text) <= 60 else text[:57] + "..."
