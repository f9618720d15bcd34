"""The parameters a search may change, and the unit cube it searches."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, fields, is_dataclass, replace
from decimal import Decimal
from fractions import Fraction
from typing import Any, cast, final

import numpy as np

from ...models.laws import Law
from ...models.types import Array

SPREAD = 30
"""A parameter without a stated range is searched within this factor of its given value."""
DIGITS = 6
"""Candidates are rounded to so many significant digits, so that a reported one is exact."""


@final
@dataclass(frozen=True)
class SearchSpace:
    """Logarithmic box of parameters of one law.

    Attributes
    ----------
    law : the law whose other parameters stay as they are
    ranges : (name, low, high), 0 < low < high, in the parameters' own units
    """

    law: Law
    ranges: tuple[tuple[str, float, float], ...]

    def __post_init__(self) -> None:
        known = self.law.parameters
        for name, low, high in self.ranges:
            if name not in known:
                raise ValueError(f"law {self.law.name} has no parameter {name!r} (it has {', '.join(known)})")
            if not 0 < low < high < math.inf:
                raise ValueError(f"{name}: expected 0 < low < high, received [{low:g}, {high:g}]")
        if not self.ranges:
            raise ValueError(f"law {self.law.name} has no parameter to search")

    @classmethod
    def around(cls, law: Law, ranges: Mapping[str, tuple[Fraction, Fraction]] | None = None) -> SearchSpace:
        """Stated ranges, and a factor of 30 either way of every other positive parameter.

        A parameter that is zero, or whose stated range is a point, stays as it is.
        """
        stated = dict(ranges or {})
        for name in stated:
            if name not in law.parameters:
                raise ValueError(f"law {law.name} has no parameter {name!r}")
        boxes = []
        for name, value in law.parameters.items():
            default = (value / SPREAD, value * SPREAD)
            low, high = (float(x) for x in stated.get(name, default))
            if high > low:
                boxes.append((name, max(low, high * 1e-6), high))
        return cls(law, tuple(boxes))

    @property
    def names(self) -> tuple[str, ...]:
        """Names of the searched parameters."""
        return tuple(name for name, _, _ in self.ranges)

    def decode(self, point: Array) -> dict[str, Fraction]:
        """Parameters at a point of the unit cube, (n,), rounded to six digits and exact."""
        values = {}
        for x, (name, low, high) in zip(point, self.ranges, strict=True):
            value = low * (high / low) ** min(max(float(x), 0.0), 1.0)
            values[name] = Fraction(Decimal(f"{value:.{DIGITS - 1}e}"))
        return values

    def encode(self, values: Mapping[str, Fraction]) -> Array:
        """Point of the unit cube, (n,), nearest to given parameters."""
        point = [
            math.log(min(max(float(values[name]), low), high) / low) / math.log(high / low)
            for name, low, high in self.ranges
        ]
        return np.array(point)


def with_parameters(law: Law, values: Mapping[str, Fraction]) -> Law:
    """The same law with some parameters replaced, by the names of `Law.parameters`.

    Raises
    ------
    ValueError
        If the law has no such parameter.
    """
    subject: Any = law
    if not is_dataclass(subject) or isinstance(subject, type):
        raise TypeError(f"law {law.name} must be a dataclass instance: its fields are its parameters")
    by_name = {f.name.rstrip("_"): f.name for f in fields(subject)}
    unknown = set(values) - set(by_name)
    if unknown:
        raise ValueError(f"law {law.name} has no parameter {sorted(unknown)[0]!r}")
    changed: Any = replace(subject, **{by_name[name]: value for name, value in values.items()})
    return cast("Law", changed)
