"""What every part of a record is made of: strict fields, units in their metadata, names of arrays."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from dataclasses import dataclass
from typing import Annotated, Any, Self, final

from pydantic import BaseModel, BeforeValidator, ConfigDict, GetJsonSchemaHandler, Strict, model_validator
from pydantic_core import CoreSchema

Integer = Annotated[int, Strict()]
Flag = Annotated[bool, Strict()]


def _from_text(value: object) -> object:
    return float(value) if value in ("inf", "-inf") and isinstance(value, str) else value


@final
@dataclass(frozen=True)
class _OrInfinity:
    """Says in the schema that an infinity is written as text."""

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        del core, handler
        return {"anyOf": [{"type": "number"}, {"enum": ["inf", "-inf"], "title": "infinity as text"}]}


Number = Annotated[
    Annotated[int, Strict()] | Annotated[float, Strict()], BeforeValidator(_from_text), _OrInfinity()
]
"""A number; JSON holds infinities as "inf" and "-inf"."""


@final
@dataclass(frozen=True)
class Unit:
    """Unit of the number or numbers in a field."""

    unit: str

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return handler(core) | {"unit": self.unit}


@final
@dataclass(frozen=True)
class ArrayOf:
    """Marks a field that names an array (or maps names to arrays): its unit and shape, n its times."""

    unit: str = ""
    shape: str = "(n,)"

    def __get_pydantic_json_schema__(self, core: CoreSchema, handler: GetJsonSchemaHandler) -> dict[str, Any]:
        return handler(core) | {"array": {"unit": self.unit, "shape": self.shape}}


class Part(BaseModel):
    """A part of a record: frozen, no key but its own, written with the fields that were given.

    A field whose default is None is left out where it is None; others are written as they were given.
    """

    model_config = ConfigDict(frozen=True, extra="forbid", allow_inf_nan=True, defer_build=True)

    @model_validator(mode="before")
    @classmethod
    def _in_unicode(cls, data: Any) -> Any:
        """Text in names of files may hold what Unicode does not; each such character is a "?"."""
        return {key: well_formed(value) for key, value in data.items()} if isinstance(data, dict) else data

    def given(self) -> dict[str, Any]:
        """The fields to be written, by name, in alphabetical order."""
        fields = type(self).model_fields
        named = ((name, getattr(self, name)) for name in sorted(self.model_fields_set))
        return {name: value for name, value in named if value is not None or fields[name].is_required()}

    def but(self, **changes: Any) -> Self:
        """The same with some fields changed, checked like the whole."""
        return type(self).model_validate(self.given() | changes)

    def array_names(self) -> dict[str, str]:
        """The arrays that fields of this part name, by role ("field" or "field.key"), in order of the roles.

        Parts inside it are asked themselves.
        """
        found: dict[str, str] = {}
        for field, info in sorted(type(self).model_fields.items()):
            value = getattr(self, field)
            if value is None or not any(isinstance(m, ArrayOf) for m in info.metadata):
                continue
            if isinstance(value, str):
                found[field] = value
            else:
                found |= {f"{field}.{key}": value[key] for key in sorted(value)}
        return found


def well_formed(value: Any) -> Any:
    """Text, or a list of texts, with each lone surrogate replaced by a question mark; others as they are."""
    if isinstance(value, str):
        lone = any("\ud800" <= c <= "\udfff" for c in value)
        return value.encode("utf-8", "replace").decode("utf-8") if lone else value
    if isinstance(value, (list, tuple)):
        return tuple(well_formed(v) for v in value)
    return value


def unit_of(part: type[Part], field: str) -> str:
    """Unit that a field's metadata states; "" where it states none.

    Raises
    ------
    KeyError
        If there is no such field.
    """
    metadata = part.model_fields[field].metadata
    return next((m.unit for m in metadata if isinstance(m, (Unit, ArrayOf))), "")


def parts_of(value: object, where: str) -> Iterator[tuple[str, Part]]:
    """Every part inside a value, itself included, each with its place."""
    if isinstance(value, Part):
        yield where, value
        for name in type(value).model_fields:
            yield from parts_of(getattr(value, name), f"{where}.{name}")
    elif isinstance(value, Mapping):
        for key, item in value.items():
            yield from parts_of(item, f"{where}.{key}")
    elif isinstance(value, (list, tuple)):
        for i, item in enumerate(value):
            yield from parts_of(item, f"{where}[{i}]")
