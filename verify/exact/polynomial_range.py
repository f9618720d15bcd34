"""The least value of many polynomials on [0, 1], enclosed by Bernstein coefficients in exact rationals."""

from __future__ import annotations

import heapq
from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import final

from ...models.schedule import polynomial as poly
from ...models.schedule.polynomial import Coefficients


@final
@dataclass(frozen=True)
class Minimum:
    """low <= least value <= high; `high` is attained by polynomial `index` at `argument`, exactly.

    Attributes
    ----------
    splits : int
        Bisections that were needed.
    """

    low: Fraction
    high: Fraction
    index: int
    argument: Fraction
    splits: int


def least_value(polynomials: Iterable[Coefficients], tolerance: Fraction) -> Minimum:
    """Enclose the least value that any of the polynomials takes on [0, 1].

    Branch and bound: the least Bernstein coefficient bounds a polynomial from below, its end values
    from above; the box with the least bound is halved until the bounds meet to `tolerance`.

    Parameters
    ----------
    polynomials : iterable of coefficient tuples, lowest power first; at least one
    tolerance : Fraction
        Largest high - low, > 0.
    """
    heap: list[tuple[Fraction, int, int, Fraction, Fraction, Coefficients]] = []
    best: tuple[Fraction, int, Fraction] | None = None
    serial = splits = 0

    def push(index: int, start: Fraction, width: Fraction, coefficients: Coefficients) -> None:
        nonlocal best, serial
        for value, argument in ((coefficients[0], start), (coefficients[-1], start + width)):
            if best is None or value < best[0]:
                best = value, index, argument
        serial += 1
        heapq.heappush(heap, (min(coefficients), serial, index, start, width, coefficients))

    for index, polynomial in enumerate(polynomials):
        push(index, Fraction(0), Fraction(1), poly.bernstein(polynomial))
    if best is None:
        raise ValueError("expected at least one polynomial")
    while best[0] - heap[0][0] > tolerance:
        _, _, index, start, width, coefficients = heapq.heappop(heap)
        left, right = halves(coefficients)
        half = width / 2
        splits += 1
        push(index, start, half, left)
        push(index, start + half, half, right)
    return Minimum(min(heap[0][0], best[0]), best[0], best[1], best[2], splits)


def halves(coefficients: Coefficients) -> tuple[Coefficients, Coefficients]:
    """Bernstein coefficients on the two halves of the interval (de Casteljau), exact."""
    row = list(coefficients)
    left, right = [row[0]], [row[-1]]
    while len(row) > 1:
        row = [(a + b) / 2 for a, b in pairwise(row)]
        left.append(row[0])
        right.append(row[-1])
    return tuple(left), tuple(reversed(right))
