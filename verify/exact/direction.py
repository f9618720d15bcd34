"""Rational points of circles and spheres, near given ones: directions and attitudes without rounding."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction


def sphere_point(plane: Sequence[Fraction]) -> tuple[Fraction, ...]:
    """Return the point of the unit sphere that the pole (-1, 0, ..) projects to a point of the plane.

    From one number, the tangent of half an angle, it is the angle's cosine and sine; from the
    modified Rodrigues vector, the quaternion.
    """
    square = sum((x * x for x in plane), Fraction(0))
    return ((1 - square) / (1 + square), *(2 * x / (1 + square) for x in plane))


def rational_direction(vector: Sequence[float], *, denominator: int | None = None) -> tuple[Fraction, ...]:
    """Rational vector of length exactly 1 near a given unit vector.

    Parameters
    ----------
    vector : Sequence[float]
        (n,), of length 1 up to rounding.
    denominator : int or None
        Bound of the denominators of its projection (see `near`), for short numbers; None takes the floats as
        they are, for a direction within rounding of the given one.
    """
    values = [float(x) for x in vector]
    pole = max(range(len(values)), key=lambda i: abs(values[i]))  # projected from the far pole
    others = [i for i in range(len(values)) if i != pole]
    plane = [values[i] / (1 + abs(values[pole])) for i in others]
    first, *rest = sphere_point([Fraction(x) if denominator is None else near(x, denominator) for x in plane])
    result = dict(zip(others, rest, strict=True)) | {pole: first if values[pole] >= 0 else -first}
    return tuple(result[i] for i in range(len(values)))


def rational_quaternion(quaternion: Sequence[float], *, denominator: int = 10**6) -> tuple[Fraction, ...]:
    """Rational unit quaternion (4,), scalar first, near a given one, with rational |bv|.

    (b0, |bv|) is a rational point of the circle, the direction of bv one of the sphere.
    """
    b0, vector = quaternion[0], list(quaternion[1:])
    length = math.sqrt(sum(x * x for x in vector))
    if length == 0:
        return (Fraction(1 if b0 >= 0 else -1), Fraction(0), Fraction(0), Fraction(0))
    direction = rational_direction([x / length for x in vector], denominator=denominator)
    tangent = math.tan(math.atan2(length, b0) / 2)
    cosine, sine = sphere_point([near(tangent, denominator) if abs(tangent) < 1e8 else Fraction(10**8)])
    return (cosine, *(sine * x for x in direction))


def near(x: float, denominator: int) -> Fraction:
    """Return a rational near x, as fine relative to x as the denominator allows for numbers near 1."""
    scale = 10 ** max(0, -math.floor(math.log10(abs(x)))) if x else 1
    return Fraction(x * scale).limit_denominator(denominator) / scale
