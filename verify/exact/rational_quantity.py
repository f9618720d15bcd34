"""Exact rationals as reported quantities: floats rounded outward, so that the interval holds them."""

from __future__ import annotations

from fractions import Fraction

from ..verdict import Quantity
from .rounding import rounded_down, rounded_up


def rational_quantity(
    name: str, low: Fraction, high: Fraction | None = None, unit: str = "", label: str = ""
) -> Quantity:
    """Quantity that encloses an exact rational, or everything between two of them."""
    upper = low if high is None else high
    return Quantity(name, rounded_down(low), rounded_up(upper), unit, label, rigorous=True)


def seconds(value: Fraction) -> str:
    """Return an instant or duration as text with its unit, to nine digits."""
    return f"{float(value):.9g} s"


def exponential_quantity(name: str, exponent: Fraction, label: str = "") -> Quantity:
    """Quantity that encloses exp of an exact rational <= 700, by ball arithmetic."""
    from .ball import enclose

    low, high = enclose(lambda x: x.exp(), exponent)
    return Quantity(name, low, high, label=label, rigorous=True)
