"""Exact numbers, and the word for a certificate that proves nothing."""

from __future__ import annotations

import re
from fractions import Fraction

Vector = list[Fraction]
Matrix = list[list[Fraction]]
HALF = Fraction(1, 2)


class Invalid(Exception):  # noqa: N818 (it is the word printed)
    """A certificate that proves nothing, with the reason."""


_NUMBER = re.compile(r"[+-]?[0-9]+(?:/0*[1-9][0-9]*|(?:\.[0-9]+)?(?:[eE]([+-]?[0-9]{1,4}))?)")
MAX_DIGITS = 4000
"""Of a number in the file. Longer ones are refused: a short file could otherwise be checked for ever."""


def exact(text: object) -> Fraction:
    """Return the rational number that a string or an integer of the file stands for."""
    if isinstance(text, int) and not isinstance(text, bool):
        return Fraction(text)
    if isinstance(text, str) and len(text) > MAX_DIGITS:
        raise Invalid(f"a number of {len(text)} characters: at most {MAX_DIGITS} digits are read")
    found = _NUMBER.fullmatch(text) if isinstance(text, str) else None
    if not isinstance(text, str) or found is None:
        raise Invalid(f"expected an exact number as a string, received {str(text)[:40]!r}")
    if abs(int(found[1] or 0)) + len(text) > MAX_DIGITS:
        raise Invalid(f"the number {text[:40]} has more than {MAX_DIGITS} digits")
    return Fraction(text)


def show(value: Fraction) -> str:
    """Return the number for people: exact if short, else to 12 digits with a sign of rounding."""
    if value.numerator.bit_length() + value.denominator.bit_length() < 60 and len(str(value)) <= 14:
        denominator = value.denominator
        while denominator % 2 == 0:
            denominator //= 2
        while denominator % 5 == 0:
            denominator //= 5
        return f"{float(value):.12g}" if denominator == 1 else str(value)
    return f"~{float(value):.12g}"


def require(condition: bool, reason: str) -> None:
    """Raise Invalid with the reason unless the condition holds."""
    if not condition:
        raise Invalid(reason)


MAX_EXPONENT = 4096
MAX_COUNT = 64
"""Of a polynomial's power of 2, and of its coefficients: beyond, checking would take for ever."""
