"""Reading a certificate file: every number exact, no field twice, none unread."""

from __future__ import annotations

import json
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

from .exact_numbers import MAX_DIGITS, Invalid, Matrix, Vector, exact, show


class Node:
    """One place in the file; it remembers what has been read, so that nothing rides along unread."""

    def __init__(self, value: Any, path: str) -> None:
        self.path = path
        self._value = value
        self._children: dict[str, Node] = {}
        self._whole = False

    def __getitem__(self, key: str) -> Node:
        """Return the member of that name."""
        if not isinstance(self._value, dict) or key not in self._value:
            raise Invalid(f"{self.path}: field {key!r} is missing")
        return self._child(key, self._value[key])

    def _child(self, key: str, value: Any) -> Node:
        if key not in self._children:
            self._children[key] = Node(value, f"{self.path}.{key}")
        return self._children[key]

    def has(self, key: str) -> bool:
        """Whether there is a member of that name."""
        return isinstance(self._value, dict) and key in self._value

    def keys(self) -> list[str]:
        """Names of the members, in the file's order."""
        if not isinstance(self._value, dict):
            raise Invalid(f"{self.path}: expected an object")
        return list(self._value)

    def items(self) -> list[Node]:
        """Entries of a list."""
        return [self._child(str(i), value) for i, value in enumerate(self._list())]

    def _list(self) -> list[Any]:
        if not isinstance(self._value, list):
            raise Invalid(f"{self.path}: expected a list")
        return self._value

    def text(self) -> str:
        """Return a piece of text."""
        self._whole = True
        if not isinstance(self._value, str):
            raise Invalid(f"{self.path}: expected text")
        return self._value

    def number(self) -> Fraction:
        """Return an exact number."""
        self._whole = True
        try:
            return exact(self._value)
        except Invalid as error:
            raise Invalid(f"{self.path}: {error}") from None

    def integer(self, low: int = 0, high: int = 10**9) -> int:
        """Return an integer in [low, high]."""
        value = self.number()
        if value.denominator != 1 or not low <= value <= high:
            raise Invalid(f"{self.path}: expected an integer from {low} to {high}, received {show(value)}")
        return int(value)

    def vector(self, length: int | None = None) -> Vector:
        """Return a list of exact numbers."""
        self._whole = True
        try:
            values = [exact(x) for x in self._list()]
        except Invalid as error:
            raise Invalid(f"{self.path}: {error}") from None
        if length is not None and len(values) != length:
            raise Invalid(f"{self.path}: expected {length} numbers, received {len(values)}")
        return values

    def matrix(self, rows: int | None = None, columns: int | None = None) -> Matrix:
        """Return a list of equally long rows of exact numbers."""
        table = [row.vector(columns) for row in self.items()]
        if rows is not None and len(table) != rows:
            raise Invalid(f"{self.path}: expected {rows} rows, received {len(table)}")
        if len({len(row) for row in table}) > 1:
            raise Invalid(f"{self.path}: rows differ in length")
        return table

    def unread(self) -> Iterator[str]:
        """Paths of the fields that nothing has read."""
        if self._whole:
            return
        if isinstance(self._value, dict):
            members = list(self._value.items())
        elif isinstance(self._value, list):
            members = [(str(i), value) for i, value in enumerate(self._value)]
        else:
            yield self.path
            return
        for key, value in members:
            if key in self._children:
                yield from self._children[key].unread()
            elif value not in ({}, []):
                yield f"{self.path}.{key}"


def _unique(pairs: list[tuple[str, Any]]) -> dict[str, Any]:
    members = dict(pairs)
    if len(members) != len(pairs):
        raise Invalid("a field is given twice")
    return members


def _no_float(text: str) -> Any:
    raise Invalid(f"the number {text[:40]} must be an exact string")


def _integer(text: str) -> int:
    if len(text) > MAX_DIGITS:
        raise Invalid(f"a number of {len(text)} characters: at most {MAX_DIGITS} digits are read")
    return int(text)


def parse(text: str) -> Node:
    """Parse a certificate file."""
    try:
        value = json.loads(
            text,
            object_pairs_hook=_unique,
            parse_int=_integer,
            parse_float=_no_float,
            parse_constant=_no_float,
        )
    except (ValueError, RecursionError) as error:
        raise Invalid(f"not JSON: {error}") from None
    return Node(value, "file")
