"""Exact instants as whole ticks of a common denominator: sweeps over 1e5 windows then compare integers."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from math import lcm
from typing import final


@final
@dataclass(frozen=True)
class Clock:
    """A tick of 1/`rate` s, of which every given instant is a whole number."""

    rate: int

    @classmethod
    def for_instants(cls, *groups: Iterable[Fraction]) -> Clock:
        """Coarsest clock on which all these instants are whole numbers of ticks."""
        denominators = {instant.denominator for group in groups for instant in group}
        return cls(lcm(*denominators) if denominators else 1)

    def ticks(self, instant: Fraction) -> int:
        """Whole number of ticks; `instant` must be one of those the clock was made for (or their sums)."""
        return instant.numerator * (self.rate // instant.denominator)

    def time(self, ticks: int) -> Fraction:
        """Instant of a tick, s, exact."""
        return Fraction(ticks, self.rate)
