"""Algebra of attitude quaternions, scalar first, over any numbers: floats, rationals, balls."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import TypeVar

T = TypeVar("T", float, Fraction)


def quaternion_product(a: Sequence[T], b: Sequence[T]) -> tuple[T, T, T, T]:
    """Hamilton product, a after b."""
    return (
        a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
        a[0] * b[1] + b[0] * a[1] + a[2] * b[3] - a[3] * b[2],
        a[0] * b[2] + b[0] * a[2] + a[3] * b[1] - a[1] * b[3],
        a[0] * b[3] + b[0] * a[3] + a[1] * b[2] - a[2] * b[1],
    )


def conjugate(q: Sequence[T]) -> tuple[T, T, T, T]:
    """Quaternion of the inverse rotation."""
    return q[0], -q[1], -q[2], -q[3]
