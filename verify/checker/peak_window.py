"""The window profile of a transfer, and its exact integrals."""

from __future__ import annotations

from bisect import bisect_right
from fractions import Fraction
from itertools import pairwise

from .bernstein import from_powers, power_compose, power_primitive, power_product
from .exact_numbers import Vector, require
from .peak_numbers import require_short
from .reading import Node


class PeakWindow:
    """Exact integrals of w >= 0 on [0, horizon], piece by piece: up = int w, int up and int up^2."""

    def __init__(self, knots: Vector, shapes: list[Vector]) -> None:
        self.knots, self.shapes = knots, shapes
        self.first, self.second, self.squares = [Fraction(0)], [Fraction(0)], [Fraction(0)]
        self.rises: list[tuple[Vector, Vector, Vector]] = []
        for (a, b), shape in zip(pairwise(knots), shapes, strict=True):
            one = [self.first[-1]] + [c * (b - a) / (i + 1) for i, c in enumerate(shape)]
            two = [self.second[-1]] + [c * (b - a) / (i + 1) for i, c in enumerate(one)]
            three = [self.squares[-1]] + [c * (b - a) for c in power_primitive(power_product(one, one))[1:]]
            self.rises.append((one, two, three))
            self.first.append(sum(one, Fraction(0)))
            self.second.append(sum(two, Fraction(0)))
            self.squares.append(sum(three, Fraction(0)))

    @classmethod
    def read(cls, place: Node) -> PeakWindow:
        """Read and check the profile."""
        knots, shapes = place["knots"].vector(), [shape.vector() for shape in place["shapes"].items()]
        require_short([*knots, *(c for shape in shapes for c in shape)], "window")
        fits = len(knots) == len(shapes) + 1 >= 2 and knots[0] == 0
        require(fits, "window: knots and shapes disagree")
        require(all(a < b for a, b in pairwise(knots)), "window: knots must increase")
        for shape in shapes:
            sure = from_powers(shape or [Fraction(0)]).is_nonnegative(20)
            require(sure, "window: the profile is not proved >= 0")
        return cls(knots, shapes)

    def mirrored(self) -> PeakWindow:
        """Return the profile with time running backwards."""
        horizon, one = self.knots[-1], Fraction(1)
        shapes = [power_compose(shape, one, -one) for shape in reversed(self.shapes)]
        return PeakWindow([horizon - k for k in reversed(self.knots)], shapes)

    def _at(self, t: Fraction, order: int) -> Fraction:
        require(0 <= t <= self.knots[-1], "the instant must lie within the transfer")
        i = min(bisect_right(self.knots, t), len(self.rises)) - 1
        x = (t - self.knots[i]) / (self.knots[i + 1] - self.knots[i])
        value = Fraction(0)
        for c in reversed(self.rises[i][order]):
            value = value * x + c
        return value

    def area(self, s: Fraction) -> Fraction:
        """int_0^s up + int_s^tf (total - up)."""
        inner = self._at(s, 1)
        return inner + self.first[-1] * (self.knots[-1] - s) - (self.second[-1] - inner)

    def up(self, s: Fraction) -> Fraction:
        """int_0^s w."""
        return self._at(s, 0)

    def opened(self, s: Fraction) -> Fraction:
        """int_0^s up."""
        return self._at(s, 1)

    def squared(self, s: Fraction) -> Fraction:
        """int_0^s up^2."""
        return self._at(s, 2)

    def moment(self, a: Fraction, b: Fraction, about: Fraction) -> Fraction:
        """int_a^b w(t) (about - t) dt, by parts."""
        ends = self._at(b, 0) * (about - b) - self._at(a, 0) * (about - a)
        return ends + self._at(b, 1) - self._at(a, 1)
