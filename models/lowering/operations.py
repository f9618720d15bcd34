"""Operations by name for number types with Python's own operators.

`RING` needs +, -, *; `FIELD` also /. Exact rationals, polynomials, balls and intervals can start
from these and add what they have (`FIELD | {"sqrt": ...}`).
"""

from __future__ import annotations

import operator
from collections.abc import Callable, Mapping
from typing import Any


def square(x: Any) -> Any:
    """Return x x, as one product."""
    return x * x


def twice(x: Any) -> Any:
    """Return x + x."""
    return x + x


def inverse(x: Any) -> Any:
    """Return 1 / x."""
    return 1 / x


def same(x: Any) -> Any:
    """Return x itself."""
    return x


RING: Mapping[str, Callable[..., Any]] = {
    "assign": same,
    "add": operator.add,
    "sub": operator.sub,
    "mul": operator.mul,
    "neg": operator.neg,
    "sq": square,
    "twice": twice,
}

FIELD: Mapping[str, Callable[..., Any]] = {**RING, "div": operator.truediv, "inv": inverse}
