"""Numbers as the user wrote them: decimals become fractions, never floats."""

from __future__ import annotations

import re
from decimal import Decimal
from fractions import Fraction
from typing import Annotated, Any

from pydantic import PlainValidator

from .errors import quote

MAX_EXPONENT = 30
"""Numbers are 0 or lie between 1e-30 and 1e30 in magnitude."""
MAX_NUMBER = 60
"""Significant digits kept."""

_DECIMAL = re.compile(r"[+-]?(\d+\.?\d*|\.\d+)([eE][+-]?\d{1,4})?", re.ASCII)


def exact(value: object) -> Fraction:
    """Return the exact fraction of an integer or decimal from a TOML file.

    Raises
    ------
    ValueError
        If it is not a number, not finite, or beyond the documented range.
    """
    if isinstance(value, Fraction):
        return value
    if isinstance(value, bool) or not isinstance(value, (int, Decimal)):
        raise ValueError(f"expected a number, received {quote(value)}")  # noqa: TRY004  pydantic collects it
    number = Decimal(value) if isinstance(value, int) else value
    if not number.is_finite():
        raise ValueError(f"expected a finite number, received {quote(value)}")
    digits = len(number.as_tuple().digits)
    if number and (abs(number.adjusted()) > MAX_EXPONENT or digits > MAX_NUMBER):
        raise ValueError(
            f"expected 0 or a number between 1e-{MAX_EXPONENT} and 1e{MAX_EXPONENT} "
            f"with at most {MAX_NUMBER} digits, received {number:.3g}"
        )
    return Fraction(number)


def exact_from_text(text: str) -> Fraction:
    """Return the exact fraction of a decimal written as text (a CSV cell)."""
    cell = text.strip()
    if not _DECIMAL.fullmatch(cell):
        if cell.lower().lstrip("+-") in {"nan", "inf", "infinity"}:
            raise ValueError(f"expected a finite number, received {quote(cell)}")
        raise ValueError(f"expected a number, received {quote(cell)}")
    return exact(Decimal(cell))


def _positive(value: object) -> Fraction:
    number = exact(value)
    if number <= 0:
        raise ValueError(f"must be > 0, received {float(number):g}")
    return number


def _not_negative(value: object) -> Fraction:
    number = exact(value)
    if number < 0:
        raise ValueError(f"must be >= 0, received {float(number):g}")
    return number


def _sine(value: object) -> Fraction:
    number = _not_negative(value)
    if number >= 1:
        raise ValueError(f"must be < 1 (|bv| is the sine of half the angle), received {float(number):g}")
    return number


def _positive_sine(value: object) -> Fraction:
    return _sine(_positive(value))


def _text(value: object) -> str:
    if not isinstance(value, str):
        raise ValueError(f"expected a text in quotes, received {quote(value)}")  # noqa: TRY004  pydantic collects it
    return value


def _count(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or value < 1:
        raise ValueError(f"expected a whole number >= 1, received {quote(value)}")
    return value


def _seed(value: object) -> int:
    if isinstance(value, bool) or not isinstance(value, int) or not 0 <= value < 2**63:
        raise ValueError(f"expected a whole number between 0 and 2^63 - 1, received {quote(value)}")
    return value


Exact = Annotated[Fraction, PlainValidator(exact)]
Positive = Annotated[Fraction, PlainValidator(_positive)]
Sine = Annotated[Fraction, PlainValidator(_sine)]
PositiveSine = Annotated[Fraction, PlainValidator(_positive_sine)]
NotNegative = Annotated[Fraction, PlainValidator(_not_negative)]
Text = Annotated[str, PlainValidator(_text)]
Count = Annotated[int, PlainValidator(_count)]
Seed = Annotated[int, PlainValidator(_seed)]
Vector = tuple[Exact, Exact, Exact]
Matrix = tuple[Vector, Vector, Vector]


def decimal_text(value: Any) -> str:
    """Return a fraction as a canonical text: numerator/denominator in lowest terms."""
    fraction = Fraction(value)
    return f"{fraction.numerator}/{fraction.denominator}"
