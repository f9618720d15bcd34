"""Exact rationals as reported quantities: floats rounded outward, so that the interval holds them."""

from __future__ import annotations

from fractions import Fraction
from math import inf, nextafter

from ..verdict import Quantity


def rounded_down(value: Fraction) -> float:
    """Return a float <= value."""
    nearest = float(value)
    return nearest if Fraction(nearest) <= value else nextafter(nearest, -inf)


def rounded_up(value: Fraction) -> float:
    """Return a float >= value."""
    return 0.0 - rounded_down(-value)


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
    import flint

    with flint.ctx.workprec(128):
        ball = flint.arb(flint.fmpq(exponent.numerator, exponent.denominator)).exp()
        low, high = float(ball.lower()), float(ball.upper())
    if exponent == 0:
        return Quantity(name, 1.0, 1.0, label=label, rigorous=True)
    return Quantity(name, nextafter(low, -inf), nextafter(high, inf), label=label, rigorous=True)
