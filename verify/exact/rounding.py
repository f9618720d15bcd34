"""Exact rationals rounded to a stated side: to floats, to binary fractions, to decimal digits."""

from __future__ import annotations

from decimal import ROUND_CEILING, ROUND_FLOOR, Context, Decimal
from fractions import Fraction
from math import ceil, floor, inf, nextafter


def rounded_down(value: Fraction) -> float:
    """Return the largest float <= value."""
    nearest = float(value)
    return nearest if Fraction(nearest) <= value else nextafter(nearest, -inf)


def rounded_up(value: Fraction) -> float:
    """Return the least float >= value."""
    return 0.0 - rounded_down(-value)  # 0, not -0


def grid_below(value: Fraction, bits: int) -> Fraction:
    """Return the largest multiple of 2^-bits that is <= value."""
    return Fraction(floor(value * 2**bits), 2**bits)


def grid_above(value: Fraction, bits: int) -> Fraction:
    """Return the least multiple of 2^-bits that is >= value."""
    return Fraction(ceil(value * 2**bits), 2**bits)


def grid_near(value: Fraction, bits: int) -> Fraction:
    """Return the multiple of 2^-bits nearest to value."""
    return Fraction(round(value * 2**bits), 2**bits)


def significant_above(value: Fraction, bits: int) -> Fraction:
    """Return a number of so many significant bits, or one more, that is >= value >= 0: whatever its unit."""
    if not value:
        return value
    unit = Fraction(2) ** (value.numerator.bit_length() - value.denominator.bit_length() - bits)
    return ceil(value / unit) * unit


def digits_below(value: float, digits: int) -> Decimal:
    """Return the largest number of so many significant digits that is <= value."""
    return Context(prec=digits, rounding=ROUND_FLOOR).create_decimal(Decimal(value))


def digits_above(value: float, digits: int) -> Decimal:
    """Return the least number of so many significant digits that is >= value."""
    return Context(prec=digits, rounding=ROUND_CEILING).create_decimal(Decimal(value))
