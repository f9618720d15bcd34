"""Piecewise polynomials of time with exact knots.

Each piece is kept in the normalised variable s = (t - start) / (end - start), so that a
schedule of 1e5 windows shares a handful of shapes and its integrals cost one product a piece.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cache, cached_property
from typing import final

from . import polynomial as poly
from .polynomial import Coefficients


@final
@dataclass(frozen=True)
class Piece:
    """One polynomial piece: value(t) = shape((t - start)/(end - start)) on [start, end], in s."""

    start: Fraction
    end: Fraction
    shape: Coefficients

    @property
    def length(self) -> Fraction:
        """Duration, s."""
        return self.end - self.start

    def local_coefficients(self) -> Coefficients:
        """Coefficients in tau = t - start (s), lowest power first, exact."""
        return poly.compose_affine(self.shape, Fraction(0), 1 / self.length)


@final
@dataclass(frozen=True)
class PiecewisePolynomial:
    """A function of time on [knots[0], knots[-1]], exact.

    Attributes
    ----------
    knots : tuple of Fraction, shape (n + 1,)
        Strictly increasing instants, s.
    shapes : tuple of coefficient tuples, shape (n,)
        Piece i is shapes[i]((t - knots[i]) / (knots[i+1] - knots[i])), lowest power first.
    """

    knots: tuple[Fraction, ...]
    shapes: tuple[Coefficients, ...]

    def __post_init__(self) -> None:
        if len(self.knots) != len(self.shapes) + 1:
            raise ValueError(f"expected {len(self.shapes) + 1} knots, received {len(self.knots)}")
        if any(b <= a for a, b in zip(self.knots, self.knots[1:], strict=False)):
            raise ValueError("knots must be strictly increasing")

    @property
    def pieces(self) -> Iterator[Piece]:
        """The pieces in order of time."""
        for a, b, shape in zip(self.knots, self.knots[1:], self.shapes, strict=False):
            yield Piece(a, b, shape)

    @cached_property
    def square_integrals(self) -> tuple[Fraction, ...]:
        """Exact integrals of the square over each piece, shape (n,)."""
        return tuple(piece.length * _square_integral(piece.shape) for piece in self.pieces)


@cache
def _square_integral(shape: Coefficients) -> Fraction:
    """Integral of shape(s)^2 over [0, 1]."""
    return poly.evaluate(poly.antiderivative(poly.multiply(shape, shape)), Fraction(1))
