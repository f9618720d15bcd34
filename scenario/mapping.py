"""A scenario given as a mapping: written as the TOML that says the same, and read like any file."""

from __future__ import annotations

import math
import re
from collections.abc import Mapping, Sequence
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any

from .errors import ScenarioError, quote

NAME = "<dict>"
"""Stands for the file's name where a scenario has none."""
_BARE = re.compile(r"[A-Za-z0-9_-]+")
_ESCAPES = {"\\": "\\\\", '"': '\\"', "\n": "\\n", "\r": "\\r", "\t": "\\t"}


def toml_text(tables: Mapping[str, Any]) -> str:
    """Write the tables of a scenario as TOML.

    A float means its shortest decimal (0.1 is one tenth); arrays and tuples are lists.

    Raises
    ------
    ScenarioError
        For a key that is no text, or a value that TOML has no word for.
    """
    return "".join(_line(key, value) for key, value in tables.items())


def _line(key: object, value: object) -> str:
    return f"{_key(key, '')} = {_value(value, str(key))}\n"


def _key(key: object, where: str) -> str:
    if not isinstance(key, str):
        raise ScenarioError(f"{NAME}: {where}" if where else NAME, f"expected keys of text, received {key!r}")
    return key if _BARE.fullmatch(key) else _text(key)


def _value(value: object, where: str) -> str:
    if hasattr(value, "tolist"):  # numpy's arrays and scalars
        value = value.tolist()
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, str | Path):
        return _text(str(value))
    if isinstance(value, int):
        return str(value)
    if isinstance(value, float | Decimal | Fraction):
        return _number(value, where)
    if isinstance(value, Mapping):
        pairs = (f"{_key(k, where)} = {_value(v, f'{where}.{k}')}" for k, v in value.items())
        return "{" + ", ".join(pairs) + "}"
    if isinstance(value, Sequence):
        return "[" + ", ".join(_value(v, f"{where}[{i}]") for i, v in enumerate(value, start=1)) + "]"
    said = "leave the key out" if value is None else "expected a number, a text, a list or a mapping"
    raise ScenarioError(f"{NAME}: {where}", f"{said}, received {quote(repr(value))}")


def _number(value: float | Decimal | Fraction, where: str) -> str:
    if isinstance(value, Fraction):
        exact = Decimal(value.numerator) / Decimal(value.denominator)
        if Fraction(exact) != value:
            raise ScenarioError(f"{NAME}: {where}", f"{value} has no finite decimal: give one near it")
        value = exact
    if not math.isfinite(value):
        raise ScenarioError(f"{NAME}: {where}", f"expected a finite number, received {value}")
    shown = str(Decimal(repr(value)) if isinstance(value, float) else value)
    return shown if any(c in shown for c in ".E") else f"{shown}.0"


def _text(value: str) -> str:
    shown = (_ESCAPES.get(c) or (c if c.isprintable() else f"\\U{ord(c):08X}") for c in value)
    return '"' + "".join(shown) + '"'
