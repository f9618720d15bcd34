"""Outward-rounded scalars: rationals and floats that bound irrational numbers, by ball arithmetic.

Everything here returns a bound on a stated side; the bounds are exact rationals or floats, so
that later algebra with them needs no rounding.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from fractions import Fraction
from math import inf, nextafter
from typing import Any

from flint import arb, ctx, fmpq

PRECISION_BITS = 128


def ball(value: Fraction | float | int) -> Any:
    """Return the ball that holds exactly this number (or its enclosure at `PRECISION_BITS`)."""
    ctx.prec = PRECISION_BITS
    numerator, denominator = value.as_integer_ratio()
    return arb(fmpq(numerator, denominator))


def exact_above(value: Any) -> Fraction:
    """Return the upper end of a ball, exactly."""
    mantissa, exponent = value.upper().man_exp()
    return int(mantissa) * Fraction(2) ** int(exponent)


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


def fraction_below(value: Fraction) -> float:
    """Return a float <= the rational."""
    nearest = float(value)
    return nearest if Fraction(nearest) <= value else nextafter(nearest, -inf)


def fraction_above(value: Fraction) -> float:
    """Return a float >= the rational."""
    return 0.0 - fraction_below(-value)  # 0, not -0


def sqrt_above(value: Fraction) -> float:
    """Return a float r >= sqrt(value), so that r^2 >= value holds in rationals."""
    return enclose(lambda x: x.sqrt(), value)[1] if value > 0 else 0.0


def sqrt_below(value: Fraction) -> float:
    """Return a float 0 <= r <= sqrt(value)."""
    return max(0.0, enclose(lambda x: x.sqrt(), value)[0]) if value > 0 else 0.0


def is_positive_semidefinite(matrix: Sequence[Sequence[Fraction]]) -> bool:
    """Whether a symmetric 3 by 3 rational matrix is >= 0, by its principal minors, exactly."""
    m = matrix
    pairs = ((0, 1), (0, 2), (1, 2))
    determinant = (
        m[0][0] * (m[1][1] * m[2][2] - m[1][2] ** 2)
        - m[0][1] * (m[0][1] * m[2][2] - m[1][2] * m[0][2])
        + m[0][2] * (m[0][1] * m[1][2] - m[1][1] * m[0][2])
    )
    return (
        all(m[i][i] >= 0 for i in range(3))
        and all(m[i][i] * m[j][j] - m[i][j] ** 2 >= 0 for i, j in pairs)
        and determinant >= 0
    )


def least_eigenvalue_below(matrix: Sequence[Sequence[Fraction]]) -> Fraction:
    """Return a rational <= the least eigenvalue of a symmetric 3 by 3 matrix, within about 1e-12 of it."""
    import numpy as np

    guess = float(np.linalg.eigvalsh(np.array([[float(x) for x in row] for row in matrix]))[0])
    scale = max(abs(float(x)) for row in matrix for x in row)
    step = 1e-14 * scale
    while True:
        bound = Fraction(guess - step)
        shifted = [[x - (bound if i == j else 0) for j, x in enumerate(row)] for i, row in enumerate(matrix)]
        if is_positive_semidefinite(shifted):
            return bound
        step *= 4


def greatest_eigenvalue_above(matrix: Sequence[Sequence[Fraction]]) -> Fraction:
    """Return a rational >= the greatest eigenvalue of a symmetric 3 by 3 matrix."""
    return -least_eigenvalue_below([[-x for x in row] for row in matrix])
