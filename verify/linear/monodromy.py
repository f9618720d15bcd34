"""The matrix that takes x(0) to x(T) for x' = (A - g(t) F) x, in balls, by Taylor series.

With x in [0, 1] the time within a step and M_j h times the coefficients of A - g F in x, the terms of
X' = sum_j M_j x^j X are (k + 1) X_{k+1} = sum_j M_j X_{k-j}. For m_j >= |M_j| the terms of
exp(sum m_j x^(j+1)/(j+1)) dominate them, and that series at x = 16 bounds the tail left out.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from functools import cache
from math import ceil
from typing import Any

from flint import arb, arb_mat

from ...models.schedule import PiecewisePolynomial
from ...models.schedule.polynomial import Coefficients, compose_affine
from ..exact.ball import ball, exact_above
from ..exact.matrix import Matrix, Rows

Enclosed = tuple[Matrix, Fraction]
"""A centre (n, n), and a bound of the largest row sum of the error."""
TERMS = 30
MAX_SIZE = Fraction(1, 2)
"""Norm of h (A - g F), |g| <= 1, in a step."""
RATIO = 16
"""How many times its length a step's majorant is looked at."""
MAX_REACH = 12
MAX_HALVINGS = 12


def norm(A: Rows) -> Fraction:
    """Largest row sum of absolute values."""
    return max(sum((abs(x) for x in row), Fraction(0)) for row in A)


def monodromy(A: Rows, F: Rows, profile: PiecewisePolynomial) -> Enclosed:
    """Enclose the monodromy matrix over the profile of g."""
    speed = norm(A) + norm(F)

    @cache
    def across(shape: Coefficients, length: Fraction) -> Any:
        """Transition matrix of one piece of g, cut until the series of every part converges fast."""
        count = max(1, ceil(length * speed / MAX_SIZE))
        if len(shape) <= 1 or not norm(F):
            doublings = (count - 1).bit_length()
            total = _transition(_field(A, F, shape[:1], length / 2**doublings))
            for _ in range(doublings):
                total = total * total
            return total
        for _ in range(MAX_HALVINGS):
            cuts = [compose_affine(shape, Fraction(j, count), Fraction(1, count)) for j in range(count)]
            fields = [_field(A, F, gain, length / count) for gain in cuts]
            if all(_reach(field) <= MAX_REACH for field in fields):
                break
            count *= 2
        return _product([_transition(field) for field in fields])

    total = _product([across(piece.shape, piece.length) for piece in profile.pieces])
    entries = [[total[i, j] for j in range(len(A))] for i in range(len(A))]
    centre = tuple(tuple(exact_above(x.mid()) for x in row) for row in entries)
    return centre, max(sum((exact_above(x.rad()) for x in row), Fraction(0)) for row in entries)


def _product(parts: Sequence[Any]) -> Any:
    """Product of matrices in order of time, by halves: the error grows with the partial products alone."""
    if len(parts) == 1:
        return parts[0]
    middle = len(parts) // 2
    return _product(parts[middle:]) * _product(parts[:middle])


def _identity(n: int) -> Any:
    return arb_mat([[arb(int(i == j)) for j in range(n)] for i in range(n)])


def _field(A: Rows, F: Rows, gain: Sequence[Fraction], h: Fraction) -> list[Matrix]:
    """Coefficients M_j of h (A - g F) in the time of a step of length h, in which g has these."""
    return [
        tuple(
            tuple(h * ((a if j == 0 else 0) - g * f) for a, f in zip(*rows, strict=True))
            for rows in zip(A, F, strict=True)
        )
        for j, g in enumerate(gain or (Fraction(0),))
    ]


def _reach(field: Sequence[Rows]) -> Fraction:
    """Logarithm of the majorant at `RATIO` times the step."""
    return sum((norm(M) * Fraction(RATIO) ** (j + 1) / (j + 1) for j, M in enumerate(field)), Fraction(0))


def _transition(field: Sequence[Rows]) -> Any:
    """Transition matrix of one step."""
    n = len(field[0])
    M = [arb_mat([[ball(x) for x in row] for row in rows]) for rows in field]
    term = total = _identity(n)
    terms = [term]
    for k in range(TERMS):
        term = M[0] * terms[k]
        for j in range(1, min(k, len(M) - 1) + 1):
            term += M[j] * terms[k - j]
        term *= arb(1) / (k + 1)
        terms.append(term)
        total += term
    tail = arb(0, 1) * (ball(_reach(field)).exp() / arb(RATIO) ** (TERMS + 1))
    return total + arb_mat([[tail] * n for _ in range(n)])
