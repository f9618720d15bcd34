"""Polynomials on [0, 1] in scaled Bernstein form, and in powers."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from itertools import pairwise
from math import comb, lcm

from .exact_numbers import Vector


class Form:
    """p(x) = sum_j a_j x^j (1 - x)^(n - j) / scale, a_j integers, scale > 0: exact, products convolve."""

    __slots__ = ("a", "scale")

    def __init__(self, a: list[int], scale: int = 1) -> None:
        self.a, self.scale = a, scale

    @classmethod
    def of(cls, controls: Sequence[Fraction]) -> Form:
        """Return the polynomial with these Bernstein coefficients."""
        scale, n = lcm(*(c.denominator for c in controls)), len(controls) - 1
        return cls([comb(n, j) * int(c * scale) for j, c in enumerate(controls)], scale)

    @classmethod
    def constant(cls, value: Fraction | int) -> Form:
        """Return a constant."""
        return cls.of([Fraction(value)])

    def elevated(self, degree: int) -> list[int]:
        """Scaled coefficients of the same polynomial with a formal degree."""
        extra = degree + 1 - len(self.a)
        return self.a if extra == 0 else _convolve(self.a, [comb(extra, j) for j in range(extra + 1)])

    def __add__(self, other: Form) -> Form:
        n = max(len(self.a), len(other.a)) - 1
        if self.scale == other.scale:
            return Form([x + y for x, y in zip(self.elevated(n), other.elevated(n), strict=True)], self.scale)
        p, q = other.scale, self.scale
        pairs = zip(self.elevated(n), other.elevated(n), strict=True)
        return Form([x * p + y * q for x, y in pairs], self.scale * other.scale)

    def __neg__(self) -> Form:
        return Form([-x for x in self.a], self.scale)

    def __sub__(self, other: Form) -> Form:
        return self + (-other)

    def __mul__(self, other: Form) -> Form:
        return Form(_convolve(self.a, other.a), self.scale * other.scale)

    def times(self, factor: Fraction | int) -> Form:
        """Return a multiple."""
        factor = Fraction(factor)
        return Form([x * factor.numerator for x in self.a], self.scale * factor.denominator)

    def derivative(self) -> Form:
        """Return dp/dx."""
        n = len(self.a) - 1
        if n == 0:
            return Form([0])
        return Form([(j + 1) * self.a[j + 1] - (n - j) * self.a[j] for j in range(n)], self.scale)

    def plain(self) -> tuple[list[int], int]:
        """Bernstein coefficients as integers over one positive denominator."""
        n = len(self.a) - 1
        common = lcm(*(comb(n, j) for j in range(n + 1)))
        return [x * (common // comb(n, j)) for j, x in enumerate(self.a)], self.scale * common

    def is_nonnegative(self, depth: int = 6) -> bool:
        """Whether p >= 0 on [0, 1] follows from Bernstein coefficients after some halvings."""
        return min(self.a) >= 0 or _nonnegative(self.plain()[0], depth)

    def is_at_least(self, value: Fraction, depth: int = 6) -> bool:
        """Whether p >= value on [0, 1] follows likewise."""
        return (self - Form.constant(value)).is_nonnegative(depth)


def _convolve(p: list[int], q: list[int]) -> list[int]:
    result = [0] * (len(p) + len(q) - 1)
    for i, x in enumerate(p):
        if x:
            for j, y in enumerate(q):
                result[i + j] += x * y
    return result


def _nonnegative(controls: list[int], depth: int) -> bool:
    if min(controls) >= 0:
        return True
    if depth == 0 or controls[0] < 0 or controls[-1] < 0:
        return False
    return all(_nonnegative(half, depth - 1) for half in halves(controls))


def halves(controls: list[int]) -> tuple[list[int], list[int]]:
    """Bernstein coefficients of both halves, by de Casteljau, times 2^degree."""
    row, left, right = controls, [], []
    for power in range(len(controls) - 1, -1, -1):
        left.append(row[0] << power)
        right.append(row[-1] << power)
        row = [x + y for x, y in pairwise(row)]
    return left, right[::-1]


def from_powers(p: Vector) -> Form:
    """Return the polynomial on [0, 1] with these power coefficients, lowest first."""
    n = len(p) - 1
    terms = [[Fraction(comb(i, j), comb(n, j)) * p[j] for j in range(i + 1)] for i in range(n + 1)]
    return Form.of([sum(row, Fraction(0)) for row in terms])


def times_affine(p: Vector, shift: Fraction, slope: Fraction) -> Vector:
    """Return (shift + slope x) p."""
    result = [Fraction(0)] * (len(p) + 1)
    for j, c in enumerate(p):
        result[j] += c * shift
        result[j + 1] += c * slope
    return result


def bernstein(p: Form) -> Vector:
    """Return the Bernstein coefficients."""
    controls, scale = p.plain()
    return [Fraction(c, scale) for c in controls]


def eighths(p: Form) -> list[tuple[Fraction, Fraction]]:
    """Bounds of a polynomial on the eight equal parts of [0, 1]."""
    controls, scale = p.plain()
    parts = [controls]
    for _ in range(3):
        parts = [half for part in parts for half in halves(part)]
    unit = scale << 3 * (len(controls) - 1)
    return [(Fraction(min(part), unit), Fraction(max(part), unit)) for part in parts]


def power_product(p: Vector, q: Vector) -> Vector:
    """Return the product of two polynomials in powers."""
    result = [Fraction(0)] * max(len(p) + len(q) - 1, 0)
    for i, a in enumerate(p):
        for j, b in enumerate(q):
            result[i + j] += a * b
    return result


def power_primitive(p: Vector) -> Vector:
    """Return the integral from 0."""
    return [Fraction(0), *(c / (i + 1) for i, c in enumerate(p))]


def power_compose(p: Vector, shift: Fraction, slope: Fraction) -> Vector:
    """Return u -> p(shift + slope u), highest powers last."""
    result: Vector = [Fraction(0)]
    for c in reversed(p):
        result = times_affine(result, shift, slope)
        result[0] += c
    return result


def power_coefficients(p: Form) -> Vector:
    """Return power coefficients of a polynomial on [0, 1], lowest first."""
    n = len(p.a) - 1
    result = [0] * (n + 1)
    for j, a in enumerate(p.a):
        for i in range(n - j + 1):
            result[j + i] += a * comb(n - j, i) * (-1) ** i
    return [Fraction(c, p.scale) for c in result]
