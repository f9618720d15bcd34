"""Outward-rounded scalars: rationals and floats that bound irrational numbers, by ball arithmetic.

Everything here returns a bound on a stated side; the bounds are exact rationals or floats, so
that later algebra with them needs no rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Sequence
from fractions import Fraction
from math import inf, isqrt, nextafter
from typing import Any

from flint import arb, ctx

from .rational import rational

PRECISION_BITS = 128
ROOT_BITS = 96


def ball(value: Fraction | float | int) -> Any:
    """Return the ball that holds exactly this number (or its enclosure at `PRECISION_BITS`)."""
    ctx.prec = PRECISION_BITS
    return arb(rational(value))


def exact_above(value: Any) -> Fraction:
    """Return the upper end of a ball, exactly."""
    mantissa, exponent = value.upper().man_exp()
    return int(mantissa) * Fraction(2) ** int(exponent)


def exact_below(value: Any) -> Fraction:
    """Return the lower end of a ball, exactly."""
    return -exact_above(-value)


def float_below(value: Any) -> float:
    """Return a float that is <= every point of the ball."""
    mid = float(value.lower())
    while not arb(mid) <= value:
        mid = nextafter(mid, -inf)
    return mid


def float_above(value: Any) -> float:
    """Return a float that is >= every point of the ball."""
    return -float_below(-value)


def enclose(function: Callable[..., Any], *arguments: Fraction | float) -> tuple[float, float]:
    """Floats (low, high) around function(arguments), `function` acting on balls.

    Raises
    ------
    ArithmeticError
        If the ball has no finite bounds (a pole, or the square root of a negative number).
    """
    value = function(*(ball(a) for a in arguments))
    if not value.is_finite():
        raise ArithmeticError(f"{getattr(function, '__name__', 'function')} has no finite enclosure here")
    return float_below(value), float_above(value)


def sqrt_above(value: Fraction) -> float:
    """Return a float r >= sqrt(value), so that r^2 >= value holds in rationals."""
    return enclose(lambda x: x.sqrt(), value)[1] if value > 0 else 0.0


def sqrt_below(value: Fraction) -> float:
    """Return a float 0 <= r <= sqrt(value)."""
    return max(0.0, enclose(lambda x: x.sqrt(), value)[0]) if value > 0 else 0.0


def horner(coefficients: Sequence[Any], x: Any) -> Any:
    """Value at x of a polynomial, lowest power first, all of them balls or series of balls."""
    value = x * 0
    for c in reversed(coefficients):
        value = value * x + c
    return value


def square_root(value: Fraction) -> tuple[Fraction, Fraction]:
    """Enclose sqrt(value) between two multiples of 2^-96, neighbours: exact, whatever the size.

    Raises
    ------
    ValueError
        If the value is negative.
    """
    if value < 0:
        raise ValueError(f"square root of {float(value):g}")
    root = isqrt((value.numerator << 2 * ROOT_BITS) // value.denominator)
    return Fraction(root, 2**ROOT_BITS), Fraction(root + 1, 2**ROOT_BITS)


def length(values: Iterable[Fraction]) -> tuple[Fraction, Fraction]:
    """Enclose a Euclidean length between two multiples of 2^-96."""
    return square_root(sum((x * x for x in values), Fraction(0)))


def exponential_above(value: Fraction) -> Fraction:
    """Return a rational >= exp(value)."""
    return exact_above(ball(value).exp())


def arctangent_below(value: Fraction) -> Fraction:
    """Return a rational <= atan(value)."""
    return exact_below(ball(value).atan())


def arc_below(vector: Iterable[Fraction], scalar: Fraction) -> Fraction:
    """Return a rational <= atan2(|vector|, scalar), an angle in [0, pi]."""
    length = ball(sum((x * x for x in vector), Fraction(0))).sqrt()
    return max(exact_below(arb.atan2(length, ball(scalar))), Fraction(0))
