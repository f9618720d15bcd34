"""Polynomials of the three coordinates of a chart: exact for statements, monomial tables for floats.

Tables order the exponents by total degree, so that index 0 is the constant, 1 to 3 are the
coordinates and everything from index 4 on is of second order or higher.
"""

from __future__ import annotations

from functools import cache, lru_cache
from itertools import product
from math import comb

import numpy as np

from ....models.types import Array
from ....verify.exact.polynomial import Polynomial, Ring

Exponent = tuple[int, int, int]

RING = Ring(("x1", "x2", "x3"))
X = tuple(RING.symbol(name) for name in RING.names)
"""The coordinates."""
SQUARED_LENGTH = X[0] * X[0] + X[1] * X[1] + X[2] * X[2]
AXES: tuple[Exponent, Exponent, Exponent] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


@cache
def exponents(degree: int) -> tuple[Exponent, ...]:
    """All exponents of total degree at most `degree`, by degree: constant first, then coordinates."""
    every = [(i, j, k) for i, j, k in product(range(degree + 1), repeat=3) if i + j + k <= degree]
    return tuple(sorted(every, key=lambda e: (sum(e), tuple(-x for x in e))))


def as_table(p: Polynomial, degree: int) -> Array:
    """Coefficients rounded to the nearest float in the order of `exponents(degree)`."""
    return np.array([float(p.coefficient(e)) for e in exponents(degree)])


@lru_cache(maxsize=8)
def halving_matrices(degree: int) -> Array:
    """Substitutions t_axis = -+1/2 + t_axis'/2, both halves side by side: shape (3 axes, n, 2 n).

    Row b, column a (or n + a): coefficient of t'^a in t^b. Every entry is a dyadic rational below
    2^53 units in its last place, hence exact, and each row's absolute sum, per half, is 1.
    """
    table = exponents(degree)
    index = {e: i for i, e in enumerate(table)}
    result = np.zeros((3, len(table), 2 * len(table)))
    for axis in range(3):
        for row, b in enumerate(table):
            for low in range(b[axis] + 1):
                a = (*b[:axis], low, *b[axis + 1 :])
                value = comb(b[axis], low) * 0.5 ** b[axis]
                column = index[(a[0], a[1], a[2])]
                result[axis, row, column] = value * (-1.0) ** (b[axis] - low)
                result[axis, row, len(table) + column] = value
    return result
