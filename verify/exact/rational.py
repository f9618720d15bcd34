"""Exact numbers on the way to python-flint and back."""

from __future__ import annotations

from fractions import Fraction

from flint import fmpq


def rational(value: Fraction | float | int) -> fmpq:
    """Return the exact value as a flint rational; a float is taken at its binary value."""
    numerator, denominator = value.as_integer_ratio()
    return fmpq(numerator, denominator)


def fraction(value: fmpq) -> Fraction:
    """Return a flint rational as a `Fraction`."""
    return Fraction(int(value.p), int(value.q))
