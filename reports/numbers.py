"""How a number is written: never with more digits than are known.

A quantity is known to lie in [low, high].

- a rigorous enclosure: as many digits as every value in it rounds to; where that would hide
  digits (or is fewer than two), the interval itself, rounded outward;
- an ordinary figure: digits whose unit is at least half the width, so that the last is uncertain
  by one at most; the interval if fewer than two are left;
- a lower bound: low, rounded down; an upper bound (or [0, high]): high, rounded up;
- not available: a dash and the note.

All rounding is decimal and exact on the stored double.
"""

from __future__ import annotations

import math
import re
from dataclasses import dataclass
from decimal import ROUND_CEILING, ROUND_FLOOR, ROUND_HALF_EVEN, Context, Decimal
from typing import Any, final

from .record.claims import QuantityEntry

MAX_DIGITS = 7
"""Digits shown at most, however many are known."""
BOUND_DIGITS = 5
"""Digits of a one-sided bound: true at any length, and rounding it the safe way costs less than 1e-4."""
MINUS = "\u2212"
MISSING = "\u2013"
ROOT = re.compile(r"(?<![A-Za-z])([A-Za-z]+)\^1/2(?![0-9])")
"""A unit's square root, as records write it."""
_EXACT = Context(prec=400)


@final
@dataclass(frozen=True)
class Written:
    """A number in words a page can set: a relation, the digits (ASCII), an exponent and the unit.

    `relation` is "", ">=" or "<=". `low` and `high` are the digits of an interval if one
    number cannot say it, else `high` is empty.
    """

    relation: str
    low: str
    high: str
    exponent: int
    unit: str
    rigorous: bool
    note: str

    @property
    def missing(self) -> bool:
        """Whether there is no number."""
        return not self.low

    @property
    def ascii(self) -> str:
        """Plain ASCII: ">= 1.25e-3 N m"; what CSV and tests read."""
        if self.missing:
            return self.note or "-"
        power = f"e{self.exponent}" if self.exponent else ""
        body = f"[{self.low}{power}, {self.high}{power}]" if self.high else self.low + power
        return " ".join(p for p in (self.relation, body, self.unit) if p)

    @property
    def text(self) -> str:
        """Unicode text: "≥ 1.25×10⁻³ N m", with a true minus."""
        return " ".join(part for part in self.digits_and_unit if part)

    @property
    def digits_and_unit(self) -> tuple[str, str]:
        """The text in its two parts: a line may break between them, and nowhere else."""
        if self.missing:
            return (f"{MISSING} ({self.note})" if self.note else MISSING), ""
        power = f"×10{superscript(self.exponent)}" if self.exponent else ""
        low, high = (d.replace("-", MINUS) for d in (self.low, self.high))
        body = f"[{low}, {high}]{power}" if high else low + power
        relation = {"": "", ">=": "≥", "<=": "≤"}[self.relation]
        return " ".join(p for p in (relation, body) if p), unit_text(self.unit)


def write(quantity: QuantityEntry, *, most: int = MAX_DIGITS, unit: bool = True) -> Written:
    """Write a record's quantity with the digits it deserves."""
    low, high, side = quantity.low, quantity.high, quantity.side
    unit_name = quantity.unit if unit else ""
    rigorous, note = quantity.rigorous, quantity.note or ""
    if (low is None and side != "upper") or (high is None and side != "lower"):
        return Written("", "", "", 0, unit_name, rigorous, note)
    if side == "lower" and low is not None:
        return _one(">=", low, ROUND_FLOOR, min(most, BOUND_DIGITS), unit_name, rigorous, note)
    if side == "upper" and high is not None:
        return _one("<=", high, ROUND_CEILING, min(most, BOUND_DIGITS), unit_name, rigorous, note)
    if low is None or high is None:
        return Written("", "", "", 0, unit_name, rigorous, note)
    if low == 0 < high:
        return _one("<=", high, ROUND_CEILING, min(most, BOUND_DIGITS), unit_name, rigorous, note)
    return _between(low, high, most, unit_name, rigorous, note)


def number(value: float, digits: int = 6) -> str:
    """Write a plain number of the record to at most `digits`, trailing zeros dropped."""
    if not math.isfinite(value):
        return "inf" if value > 0 else "-inf"
    shown = _rounded(value, digits, ROUND_HALF_EVEN)
    mantissa, exponent = _layout(shown, shown)
    text = _plain(mantissa(shown))
    text = text.rstrip("0").rstrip(".") if "." in text else text
    return text + (f"e{exponent}" if exponent else "")


def _between(low: float, high: float, most: int, unit: str, rigorous: bool, note: str) -> Written:
    if not (math.isfinite(low) and math.isfinite(high)):
        return _unbounded(low, high, unit, rigorous, note)
    if low == high:
        exact = _rounded(low, most, ROUND_HALF_EVEN)
        if exact == Decimal(low) or Decimal(repr(low)) == exact:
            mantissa, exponent = _layout(exact, exact)
            return Written("", _trim(_plain(mantissa(exact))), "", exponent, unit, rigorous, note)
    shared = _shared(low, high, most) if rigorous else _central(low, high, most)
    if shared is not None:
        mantissa, exponent = _layout(shared, shared)
        if len(shared.as_tuple().digits) <= shared.adjusted() and not _is_tight(low, high):
            # "1.0e2", for the last zero of "100" would be taken for a digit that is known
            mantissa, exponent = _power(shared)
        return Written("", _plain(mantissa(shared)), "", exponent, unit, rigorous, note)
    largest = max(abs(low), abs(high))
    digits = min(most, 2 + max(0, math.floor(math.log10(largest)) - math.floor(math.log10(high - low))))
    step = Decimal(1).scaleb(Decimal(largest).adjusted() - digits + 1)
    a = Decimal(low).quantize(step, ROUND_FLOOR, _EXACT)
    b = Decimal(high).quantize(step, ROUND_CEILING, _EXACT)
    mantissa, exponent = _layout(a, b)
    return Written("", _plain(mantissa(a)), _plain(mantissa(b)), exponent, unit, rigorous, note)


def _shared(low: float, high: float, most: int) -> Decimal | None:
    """Find the digits every value of the interval rounds to, unless they say much less than the interval."""
    useful = _useful(low, high)
    for digits in range(most, 1, -1):
        a, b = (_rounded(x, digits, ROUND_HALF_EVEN) for x in (low, high))
        if a == b and a != 0 and digits >= min(useful, most) - 1:
            return a.normalize() if _is_tight(low, high) else a
    return None


def _is_tight(low: float, high: float) -> bool:
    """Whether the interval is a number that only rounding has widened."""
    return high - low <= 8 * math.ulp(high)


def _central(low: float, high: float, most: int) -> Decimal | None:
    """Round the middle so that its last digit is uncertain by one at most."""
    digits = min(_useful(low, high), most)
    return _rounded(low + (high - low) / 2, digits, ROUND_HALF_EVEN) if digits >= 2 else None


def _useful(low: float, high: float) -> int:
    """Count the digits of the middle whose unit is at least half the width."""
    width, middle = Decimal(high) - Decimal(low), abs(Decimal(low) + Decimal(high)) / 2
    if middle == 0 or width >= middle:
        return 0
    if width == 0:
        return 17
    half = width / 2
    unit = half.adjusted() + (0 if half == Decimal(1).scaleb(half.adjusted()) else 1)
    return middle.adjusted() - unit + 1


def _unbounded(low: float, high: float, unit: str, rigorous: bool, note: str) -> Written:
    if math.isfinite(low):
        return _one(">=", low, ROUND_FLOOR, BOUND_DIGITS, unit, rigorous, note)
    if math.isfinite(high):
        return _one("<=", high, ROUND_CEILING, BOUND_DIGITS, unit, rigorous, note)
    return Written("", "", "", 0, unit, rigorous, note or "unbounded")


def _one(
    relation: str, value: float, rounding: str, digits: int, unit: str, rigorous: bool, note: str
) -> Written:
    if not math.isfinite(value):
        return Written("", "", "", 0, unit, rigorous, note or "no bound")
    shown = _rounded(value, digits, rounding)
    mantissa, exponent = _layout(shown, shown)
    return Written(relation, _trim(_plain(mantissa(shown))), "", exponent, unit, rigorous, note)


def _rounded(value: float, digits: int, rounding: str) -> Decimal:
    exact = Decimal(value)
    if exact == 0:
        return Decimal(0)
    return exact.quantize(Decimal(1).scaleb(exact.adjusted() - digits + 1), rounding, _EXACT)


def _layout(low: Decimal, high: Decimal) -> tuple[Any, int]:
    """Choose fixed point between 1e-4 and 1e6, else a common power of ten."""
    largest = max(abs(low), abs(high))
    size = largest.adjusted() if largest else 0
    return _power(largest) if not -4 <= size < 6 else ((lambda d: d), 0)


def _power(value: Decimal) -> tuple[Any, int]:
    """Choose a power of ten."""
    exponent = value.adjusted() if value else 0
    return (lambda d: d.scaleb(-exponent, _EXACT)), exponent


def _plain(value: Decimal) -> str:
    text = f"{value:f}"
    return "0" if not value else text


def _trim(text: str) -> str:
    return text.rstrip("0").rstrip(".") if "." in text else text


def superscript(value: int) -> str:
    """Write an integer in superscript characters."""
    return str(value).translate(str.maketrans("-0123456789", "⁻⁰¹²³⁴⁵⁶⁷⁸⁹"))


def unit_text(unit: str) -> str:
    """Write a unit with a middle dot, true exponents and roots, no caret: "kg^1/2 m^2" is "√kg·m²"."""
    out, i = "", 0
    unit = ROOT.sub("√\\1", unit)
    while i < len(unit):
        if unit[i] == "^":
            j = i + 1
            while j < len(unit) and (unit[j].isdigit() or unit[j] == "-"):
                j += 1
            out += superscript(int(unit[i + 1 : j])) if unit[i + 1 : j].lstrip("-").isdigit() else unit[i:j]
            i = j
            continue
        out += "·" if unit[i] == " " else unit[i]
        i += 1
    return out
