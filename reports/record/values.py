"""From Python values to plain JSON values and their read-only view."""

from __future__ import annotations

import math
from collections.abc import Mapping
from decimal import Decimal
from enum import Enum
from fractions import Fraction
from types import MappingProxyType
from typing import Any

import numpy as np

from .base import Part, well_formed


def plain(value: Any, where: str = "record") -> Any:
    """Turn a value into what JSON can say, without losing anything silently.

    Fractions and decimals become exact text ("3/8", "0.525"); infinities become "inf" and "-inf";
    enums their value; numpy scalars and arrays numbers and lists; lone surrogates a question mark. Keys are
    sorted, so that a record made and the same record read back are alike in every order.

    Raises
    ------
    ValueError
        For NaN (write None for "not available") and for types JSON has no word for.
    """
    if value is None or isinstance(value, bool):
        return value
    if isinstance(value, Part):
        return {name: plain(item, f"{where}.{name}") for name, item in value.given().items()}
    if isinstance(value, Enum):
        return plain(value.value, where)
    if isinstance(value, str):
        return str(well_formed(value))
    if isinstance(value, (int, np.integer)):
        return int(value)
    if isinstance(value, (float, np.floating)):
        return _number(float(value), where)
    if isinstance(value, np.bool_):
        return bool(value)
    if isinstance(value, (Fraction, Decimal)):
        return str(value)
    if isinstance(value, np.ndarray):
        return plain(value.tolist(), where)
    if isinstance(value, Mapping):
        entries = {str(plain(str(k), where)): plain(v, f"{where}.{k}") for k, v in value.items()}
        return dict(sorted(entries.items()))
    if isinstance(value, (list, tuple)):
        return [plain(v, f"{where}[{i}]") for i, v in enumerate(value)]
    if isinstance(value, (set, frozenset)):
        return sorted((plain(v, where) for v in value), key=str)
    raise ValueError(
        f"{where}: a record cannot hold a {type(value).__name__}; use numbers, text, lists or mappings"
    )


def _number(value: float, where: str) -> float | str:
    if math.isnan(value):
        raise ValueError(f"{where}: received NaN; write None for a figure that is not available")
    if math.isinf(value):
        return "inf" if value > 0 else "-inf"
    return value


def freeze(value: Any) -> Any:
    """Read-only view of plain JSON values: mappings become proxies, lists tuples."""
    if isinstance(value, dict):
        return MappingProxyType({k: freeze(v) for k, v in value.items()})
    if isinstance(value, list):
        return tuple(freeze(v) for v in value)
    return value
