"""Polynomials on [0, 1] in exact scaled Bernstein form.

p(x) = sum_j a_j x^j (1 - x)^(n - j) with a_j = binomial(n, j) c_j, c_j the Bernstein
coefficients. In this form the product of two polynomials is a convolution, and all a_j >= 0
proves p >= 0 on [0, 1]. Coefficients are rationals (python-flint), so nothing is rounded.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cache
from itertools import pairwise
from math import comb, lcm
from typing import Any, final

from flint import fmpq, fmpq_poly

from ...models.schedule import polynomial as poly
from .bisection import best_first
from .rational import fraction, rational

Number = fmpq | Fraction | int | float
_NUMBERS = (fmpq, Fraction, int, float)
"""Numbers that polynomials are combined with: exact, a float at its binary value."""


def _over_one(values: Sequence[Fraction | float]) -> tuple[list[int], int]:
    """Exact values as integers over one denominator."""
    ratios = [value.as_integer_ratio() for value in values]
    common = lcm(*[denominator for _, denominator in ratios])
    return [numerator * (common // denominator) for numerator, denominator in ratios], common


@cache
def _binomials(degree: int) -> tuple[int, ...]:
    return tuple(comb(degree, j) for j in range(degree + 1))


@cache
def _one_plus_x(power: int) -> fmpq_poly:
    return fmpq_poly([1, 1]) ** power


@final
class Bernstein:
    """A polynomial of formal degree `degree` on [0, 1]; immutable.

    Attributes
    ----------
    form : fmpq_poly
        Generating polynomial of the scaled coefficients a_0 .. a_degree.
    degree : int
    """

    __slots__ = ("degree", "form")

    def __init__(self, form: fmpq_poly, degree: int) -> None:
        self.form = form
        self.degree = degree

    @classmethod
    def from_controls(cls, controls: Sequence[Fraction | float]) -> Bernstein:
        """Build from plain Bernstein coefficients c_0 .. c_n, floats at their exact value."""
        integers, denominator = _over_one(controls)
        n = len(integers) - 1
        return cls(fmpq_poly([b * c for b, c in zip(_binomials(n), integers, strict=True)], denominator), n)

    @classmethod
    def with_derivative(
        cls, controls: Sequence[Fraction | float], length: Fraction
    ) -> tuple[Bernstein, Bernstein]:
        """Return the polynomial of these coefficients, and its derivative in time over a step of `length`."""
        integers, denominator = _over_one(controls)
        n = len(integers) - 1
        value = cls(fmpq_poly([b * c for b, c in zip(_binomials(n), integers, strict=True)], denominator), n)
        if n == 0:
            return value, cls(fmpq_poly([]), 0)
        factor = n * length.denominator
        slopes = [
            b * (d - c) * factor
            for b, c, d in zip(_binomials(n - 1), integers[:-1], integers[1:], strict=True)
        ]
        return value, cls(fmpq_poly(slopes, denominator * length.numerator), n - 1)

    @classmethod
    def constant(cls, value: Number) -> Bernstein:
        """Build a constant."""
        return cls(fmpq_poly([_exact(value)]), 0)

    @classmethod
    def from_powers(cls, coefficients: poly.Coefficients) -> Bernstein:
        """Build from power coefficients in x on [0, 1], lowest first."""
        return cls.from_controls(poly.bernstein(coefficients))

    def elevated(self, degree: int) -> Bernstein:
        """Return the same polynomial with formal degree `degree`."""
        if degree == self.degree:
            return self
        return Bernstein(self.form * _one_plus_x(degree - self.degree), degree)

    def __add__(self, other: Bernstein | Number) -> Bernstein:
        if not isinstance(other, Bernstein):
            if not isinstance(other, _NUMBERS):
                return NotImplemented
            other = Bernstein.constant(other)
        n = max(self.degree, other.degree)
        return Bernstein(self.elevated(n).form + other.elevated(n).form, n)

    __radd__ = __add__

    def __sub__(self, other: Bernstein | Number) -> Bernstein:
        if not isinstance(other, Bernstein):
            if not isinstance(other, _NUMBERS):
                return NotImplemented
            other = Bernstein.constant(other)
        n = max(self.degree, other.degree)
        return Bernstein(self.elevated(n).form - other.elevated(n).form, n)

    def __rsub__(self, other: Number) -> Bernstein:
        return -self + other

    def __neg__(self) -> Bernstein:
        return Bernstein(-self.form, self.degree)

    def __mul__(self, other: Bernstein | Number) -> Bernstein:
        if isinstance(other, Bernstein):
            return Bernstein(self.form * other.form, self.degree + other.degree)
        if not isinstance(other, _NUMBERS):
            return NotImplemented
        return Bernstein(self.form * _exact(other), self.degree)

    __rmul__ = __mul__

    def __truediv__(self, other: Bernstein | Number) -> Any:
        if isinstance(other, Bernstein):
            return self * (1 / other.form[0]) if other.degree == 0 else Quotient(self, other)
        if not isinstance(other, _NUMBERS):
            return NotImplemented
        return self * (1 / _exact(other))

    def controls(self) -> list[Fraction]:
        """Plain Bernstein coefficients; p lies between the least and the greatest on [0, 1]."""
        n = self.degree
        return [fraction(self.form[j]) / comb(n, j) for j in range(n + 1)]

    def _integers(self) -> list[int]:
        """Bernstein coefficients times a common positive factor."""
        numerators = [int(c) for c in self.form.numer().coeffs()]
        numerators += [0] * (self.degree + 1 - len(numerators))
        return [w * a for w, a in zip(_unscaling(self.degree), numerators, strict=True)]

    def is_nonnegative(self, depth: int = 4) -> bool:
        """Whether p >= 0 on [0, 1] is proved with at most `depth` halvings; False proves nothing."""
        if min(self.form.numer().coeffs(), default=0) >= 0:
            return True
        return _is_nonnegative(self._integers(), depth)


def _exact(value: Number) -> fmpq | int:
    return rational(value) if isinstance(value, (Fraction, float)) else value


@final
class Quotient:
    """numerator / denominator of two polynomials; the denominator must be > 0."""

    __slots__ = ("denominator", "numerator")

    def __init__(self, numerator: Bernstein, denominator: Bernstein) -> None:
        self.numerator, self.denominator = numerator, denominator

    def __add__(self, other: Any) -> Quotient:
        if isinstance(other, Quotient):
            raise TypeError("one quotient a slope: bring them to one denominator")
        return Quotient(self.numerator + other * self.denominator, self.denominator)

    __radd__ = __add__

    def __neg__(self) -> Quotient:
        return Quotient(-self.numerator, self.denominator)

    def __sub__(self, other: Any) -> Quotient:
        return self.__add__(-other)

    def __rsub__(self, other: Any) -> Quotient:
        return (-self).__add__(other)

    def __mul__(self, other: Any) -> Quotient:
        return Quotient(self.numerator * other, self.denominator)

    __rmul__ = __mul__


@cache
def _unscaling(degree: int) -> tuple[int, ...]:
    """Positive integers proportional to 1 / binomial(degree, j)."""
    common = lcm(*(comb(degree, j) for j in range(degree + 1)))
    return tuple(common // comb(degree, j) for j in range(degree + 1))


def _is_nonnegative(controls: list[int], depth: int) -> bool:
    if min(controls) >= 0:
        return True
    if depth == 0 or controls[0] < 0 or controls[-1] < 0:
        return False
    return all(_is_nonnegative(half, depth - 1) for half in split(controls))


def split(controls: Sequence[int]) -> tuple[list[int], list[int]]:
    """De Casteljau at 1/2, scaled by 2^n: Bernstein coefficients of the two halves, n the degree."""
    row, left, right = list(controls), [], []
    for power in range(len(controls) - 1, -1, -1):
        left.append(row[0] << power)
        right.append(row[-1] << power)
        row = [a + b for a, b in pairwise(row)]
    return left, right[::-1]


def lower_bound(controls: Sequence[Fraction | float], depth: int) -> Fraction:
    """Return a proved lower bound of a polynomial on [0, 1] from its Bernstein coefficients.

    Tighter with each of `depth` halvings.
    """
    exact = [Fraction(c) for c in controls]
    common = lcm(*(c.denominator for c in exact))
    least, power = _least([int(c * common) for c in exact], depth)
    return Fraction(least, common << power)


def _least(controls: list[int], depth: int) -> tuple[int, int]:
    """Lower bound as (integer, power): integer / 2^power."""
    least = min(controls)
    if depth == 0 or least in (controls[0], controls[-1]):
        return least, 0
    halves = [_least(half, depth - 1) for half in split(controls)]
    n = len(controls) - 1
    shared = max(power for _, power in halves)
    return min(value << (shared - power) for value, power in halves), shared + n


@final
@dataclass(frozen=True)
class Minimum:
    """low <= least value <= high; `high` is attained by polynomial `index` at `argument`, exactly.

    Attributes
    ----------
    splits : int
        Bisections that were needed.
    """

    low: Fraction
    high: Fraction
    index: int
    argument: Fraction
    splits: int


Part = tuple[Fraction, int, Fraction, Fraction, list[int], int]
"""Lower bound, number of the polynomial, start, width, coefficients times a factor, the factor."""


def least_value(polynomials: Iterable[poly.Coefficients], tolerance: Fraction) -> Minimum:
    """Enclose the least value that any of the polynomials takes on [0, 1].

    Branch and bound: the least Bernstein coefficient bounds a polynomial from below, its end values
    from above; the part with the least bound is halved until the bounds meet to `tolerance`.

    Parameters
    ----------
    polynomials : Iterable[poly.Coefficients]
        Coefficient tuples, lowest power first; at least one.
    tolerance : Fraction
        Largest high - low, > 0.
    """
    best: tuple[Fraction, int, Fraction] | None = None
    splits = -1

    def part(index: int, start: Fraction, width: Fraction, controls: list[int], factor: int) -> Part:
        nonlocal best
        for control, argument in ((controls[0], start), (controls[-1], start + width)):
            value = Fraction(control, factor)
            if best is None or value < best[0]:
                best = value, index, argument
        return Fraction(min(controls), factor), index, start, width, controls, factor

    def halves(whole: Part) -> Iterator[Part]:
        _, index, start, width, controls, factor = whole
        factor <<= len(controls) - 1
        for side, half in enumerate(split(controls)):
            yield part(index, start + side * width / 2, width / 2, half, factor)

    def enough(least: Part) -> bool:
        nonlocal splits
        splits += 1
        assert best is not None
        return best[0] - least[0] <= tolerance

    roots = [
        part(index, Fraction(0), Fraction(1), *_over_one(poly.bernstein(p)))
        for index, p in enumerate(polynomials)
    ]
    if best is None:
        raise ValueError("expected at least one polynomial")
    parts = best_first(roots, halves, enough)
    return Minimum(min(parts[0][0], best[0]), best[0], best[1], best[2], splits)
