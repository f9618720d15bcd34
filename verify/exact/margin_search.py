"""The largest change that is still certified, by doubling and bisection over exact rationals.

A certificate that fails says nothing of the truth: what is found is a number up to which the
claim is certified, so a lower bound of the true margin. Each value is tried by the certificate
itself; monotony is only what guides the search.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from math import inf
from typing import final

from ..verdict import Quantity
from .bisection import bisected
from .rounding import rounded_down

Holds = Callable[[Fraction], bool]


@final
@dataclass(frozen=True)
class Margin:
    """A change that was certified, and the next one tried that was not.

    Attributes
    ----------
    certified : largest value at which the certificate was found
    refused : least value tried above it at which it was not; None if the search's limit was certified
    evaluations : certificates tried
    """

    certified: Fraction
    refused: Fraction | None
    evaluations: int

    def quantity(self, name: str, unit: str, label: str) -> Quantity:
        """As a lower bound: the claim is certified at least up to here."""
        return Quantity(name, rounded_down(self.certified), inf, unit, label, rigorous=True, side="lower")


def greatest_certified(holds: Holds, first: Fraction, *, limit: Fraction, steps: int = 5) -> Margin:
    """Largest value in [0, limit] at which `holds` was seen true; 0 is taken to hold.

    Parameters
    ----------
    holds : Holds
        Whether something is certified at a value; may be false where it is true.
    first : Fraction
        Value tried first; doubled while it holds.
    limit : Fraction
        Nothing beyond it is tried.
    steps : int
        Bisections between the last value that held and the first that did not.
    """
    if not 0 < first <= limit:
        raise ValueError("expected 0 < first <= limit")
    low, high, count = Fraction(0), first, 0
    while True:
        count += 1
        if not holds(high):
            break
        low = high
        if high == limit:
            return Margin(low, None, count)
        high = min(2 * high, limit)
    low, high = bisected(holds, low, high, steps=steps)
    return Margin(low, high, count + steps)


def most_certified(holds: Callable[[int], bool], limit: int) -> Margin:
    """Largest n in 0..limit such that 1..n all hold."""
    for n in range(1, limit + 1):
        if not holds(n):
            return Margin(Fraction(n - 1), Fraction(n), n)
    return Margin(Fraction(limit), None, limit)
