"""Bounds on a stretch of time, and what follows from them for the torque."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from fractions import Fraction
from math import isqrt


def root_above(value: Fraction) -> Fraction:
    """Return a rational >= sqrt(value), within a part in 2^60 of it."""
    if value <= 0:
        return Fraction(0)
    shift = max(0, 120 - value.numerator.bit_length() + value.denominator.bit_length())
    shift += shift % 2
    return Fraction(isqrt((value.numerator << shift) // value.denominator + 1) + 1, 1 << shift // 2)


@dataclass(frozen=True)
class Box:
    """Bounds that hold throughout an eighth of a step.

    `S` = 1 - b0 and `y` = |Omega|_J from above; kappa in [low, high]; `g_low` <= g, |g| <= `g`; g' in
    `slope`; `more` is what the law's own system reads besides.
    """

    stop: Fraction
    S: Fraction
    y: Fraction
    low: Fraction
    high: Fraction
    g: Fraction
    slope: tuple[Fraction, Fraction]
    g_low: Fraction = Fraction(0)
    more: Mapping[str, Fraction] = field(default_factory=dict)

    @property
    def bv(self) -> Fraction:
        """Bound of |bv| = sqrt(S' (2 - S')) over S' <= S."""
        inside = min(self.S, Fraction(1))
        return root_above(inside * (2 - inside))


def sliding_command(
    box: Box,
    q: tuple[Fraction, Fraction],
    damping: Fraction,
    *,
    least: Fraction,
    greatest: Fraction,
) -> Fraction:
    """Return a bound of |u|, Euclidean, for Omega = w + 2 g^2 kappa bv and least <= J <= greatest, where

    u = q J bv - 2 g kappa bv x J Omega + 4 g^3 kappa^2 bv x J bv
        - g kappa J (b0 Omega + bv x Omega) - d J Omega.

    Each term by |bv|, |Omega| <= y/sqrt(least), |J Omega| <= sqrt(greatest) y,
    |b0 Omega + bv x Omega| <= |Omega|, |bv x J bv| <= |bv|^2 (greatest - least)/2; q lies in the interval
    given, |d| <= damping.
    """
    g, high, n, root = box.g, box.high, box.bv, root_above(greatest)
    return (
        max(abs(x) for x in q) * greatest * n
        + 2 * g * high * n * root * box.y
        + 2 * g**3 * high**2 * (greatest - least) * n**2
        + g * high * greatest * root_above(box.y**2 / least)
        + damping * root * box.y
    )
