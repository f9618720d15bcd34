"""Numbers in messages that compare them: with as many digits as it takes to see that they differ."""

from __future__ import annotations

from decimal import Context, Decimal
from fractions import Fraction

DIGITS = (*range(3, 18), 25, 40, 60)
"""Significant digits that are tried in turn; numbers of a scenario have at most 60."""


def apart(*values: Fraction | float | int, digits: int = 6) -> tuple[str, ...]:
    """Write numbers with at least so many significant digits, and so that those that differ look it.

    0.3 and 0.30000000000000004 are written in full; 8 and 8 stay "8".
    """
    exact = [
        Fraction(repr(float(value))) if isinstance(value, float) else Fraction(value) for value in values
    ]
    texts: list[str] = []
    for count in (n for n in DIGITS if n >= digits):
        texts = [_written(value, count) for value in exact]
        if len(set(texts)) == len(set(exact)):
            break
    return tuple(texts)


def _written(value: Fraction, digits: int) -> str:
    if digits <= 15:  # beyond, a double has digits that nobody wrote
        return f"{float(value):.{digits}g}"
    number = Context(prec=digits).divide(Decimal(value.numerator), Decimal(value.denominator))
    return f"{number.normalize():g}"
