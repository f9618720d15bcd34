"""Exact univariate polynomials over the rationals: tuples of `Fraction`, lowest power first."""

from __future__ import annotations

from fractions import Fraction
from functools import cache
from itertools import zip_longest

Coefficients = tuple[Fraction, ...]

ZERO: Coefficients = ()


def polynomial(*coefficients: Fraction | int) -> Coefficients:
    """Coefficients, lowest power first, without trailing zeros (the zero polynomial is empty)."""
    exact = [Fraction(c) for c in coefficients]
    while exact and exact[-1] == 0:
        exact.pop()
    return tuple(exact)


def evaluate(p: Coefficients, x: Fraction) -> Fraction:
    """Return p(x), exactly."""
    value = Fraction(0)
    for c in reversed(p):
        value = value * x + c
    return value


def add(p: Coefficients, q: Coefficients) -> Coefficients:
    """Return p + q."""
    return polynomial(*(a + b for a, b in zip_longest(p, q, fillvalue=Fraction(0))))


def multiply(p: Coefficients, q: Coefficients) -> Coefficients:
    """Return p q."""
    if not p or not q:
        return ZERO
    product = [Fraction(0)] * (len(p) + len(q) - 1)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            product[i + j] += a * b
    return polynomial(*product)


def scale(p: Coefficients, factor: Fraction) -> Coefficients:
    """Return factor * p."""
    return polynomial(*(factor * c for c in p))


def derivative(p: Coefficients) -> Coefficients:
    """Return dp/dx."""
    return polynomial(*(i * c for i, c in enumerate(p) if i > 0))


def antiderivative(p: Coefficients) -> Coefficients:
    """Return the integral of p from 0 to x."""
    return polynomial(0, *(c / (i + 1) for i, c in enumerate(p)))


def compose_affine(p: Coefficients, shift: Fraction, slope: Fraction) -> Coefficients:
    """Return x -> p(shift + slope x)."""
    result: Coefficients = ZERO
    inner = polynomial(shift, slope)
    for c in reversed(p):
        result = add(multiply(result, inner), polynomial(c))
    return result


def bernstein(p: Coefficients, degree: int | None = None) -> Coefficients:
    """Bernstein coefficients of p on [0, 1].

    The range of p on [0, 1] lies between the least and the greatest of them, so that all
    being >= 0 proves p >= 0 there. `degree` may raise the degree, never lower it.
    """
    n = max(len(p) - 1, 0) if degree is None else degree
    if n < len(p) - 1:
        raise ValueError(f"Bernstein degree {n} is below the polynomial's degree {len(p) - 1}")
    padded = list(p) + [Fraction(0)] * (n + 1 - len(p))
    return tuple(
        sum((Fraction(_binomial(i, j), _binomial(n, j)) * padded[j] for j in range(i + 1)), Fraction(0))
        for i in range(n + 1)
    )


@cache
def _binomial(n: int, k: int) -> int:
    from math import comb

    return comb(n, k)
