"""Polynomials in three variables: exact (Fraction) for statements, monomial tables for floats.

An exact polynomial is a mapping from exponents (i, j, k) to its coefficient; zero entries are
dropped. Tables order the exponents by total degree, so that index 0 is the constant, 1 to 3 are
the coordinates and everything from index 4 on is of second order or higher.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from fractions import Fraction
from functools import cache, lru_cache
from itertools import product
from math import comb

import numpy as np

from ....models.types import Array

Exponent = tuple[int, int, int]
Polynomial = dict[Exponent, Fraction]

CONSTANT: Exponent = (0, 0, 0)
AXES: tuple[Exponent, Exponent, Exponent] = ((1, 0, 0), (0, 1, 0), (0, 0, 1))


@cache
def exponents(degree: int) -> tuple[Exponent, ...]:
    """All exponents of total degree at most `degree`, by degree: constant first, then coordinates."""
    every = [(i, j, k) for i, j, k in product(range(degree + 1), repeat=3) if i + j + k <= degree]
    return tuple(sorted(every, key=lambda e: (sum(e), tuple(-x for x in e))))


def constant(value: Fraction | int) -> Polynomial:
    """Return the constant polynomial."""
    return {CONSTANT: Fraction(value)} if value else {}


def coordinate(axis: int, slope: Fraction | int = 1) -> Polynomial:
    """Return slope times the coordinate of that axis."""
    return {AXES[axis]: Fraction(slope)}


def total(*terms: Polynomial) -> Polynomial:
    """Return the sum."""
    result: Polynomial = {}
    for term in terms:
        for e, c in term.items():
            result[e] = result.get(e, Fraction(0)) + c
    return {e: c for e, c in result.items() if c}


def scaled(p: Polynomial, factor: Fraction | int) -> Polynomial:
    """Return factor * p."""
    return {e: factor * c for e, c in p.items()} if factor else {}


def multiplied(p: Polynomial, q: Polynomial) -> Polynomial:
    """Return p q."""
    result: Polynomial = {}
    for (a, b, c), x in p.items():
        for (d, e, f), y in q.items():
            key = (a + d, b + e, c + f)
            result[key] = result.get(key, Fraction(0)) + x * y
    return {e: c for e, c in result.items() if c}


def partial(p: Polynomial, axis: int) -> Polynomial:
    """Return the derivative along one coordinate."""
    result: Polynomial = {}
    for e, c in p.items():
        if e[axis]:
            lowered = list(e)
            lowered[axis] -= 1
            result[(lowered[0], lowered[1], lowered[2])] = e[axis] * c
    return result


def shifted(p: Polynomial, x: Sequence[Fraction]) -> Polynomial:
    """Return t -> p(x + t): the Taylor coefficients at x."""
    result: Polynomial = {}
    for e, c in p.items():
        for low in product(*(range(n + 1) for n in e)):
            factor = c
            for axis in range(3):
                factor *= comb(e[axis], low[axis]) * x[axis] ** (e[axis] - low[axis])
            key = (low[0], low[1], low[2])
            result[key] = result.get(key, Fraction(0)) + factor
    return {e: c for e, c in result.items() if c}


def as_table(p: Mapping[Exponent, Fraction], degree: int) -> Array:
    """Coefficients rounded to the nearest float in the order of `exponents(degree)`."""
    return np.array([float(p.get(e, Fraction(0))) for e in exponents(degree)])


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
