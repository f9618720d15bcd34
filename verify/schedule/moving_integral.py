"""F(t), the integral of g^2 over [t, t + T], as an exact piecewise polynomial of t.

F changes its polynomial where t or t + T crosses a knot. Between two such instants
F(t) = F(start) + width * integral of (g^2 of the upper piece - g^2 of the lower one), exact.
"""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from math import lcm
from typing import NamedTuple, final

from ...models.schedule import Clock, Schedule
from ...models.schedule import polynomial as poly
from ...models.schedule.polynomial import Coefficients

ShapeKey = tuple[int, int, int]
"""A part of a piece: index of its shape, its length and the offset into it, in ticks."""


class Segment(NamedTuple):
    """One polynomial piece of F on [start, start + width], in ticks.

    Attributes
    ----------
    lower, upper : pieces of g that act at t and at t + T, with the offsets at `start`
    lower_index, upper_index : their positions in the profile
    cycles : whole periods that T adds to the upper piece
    """

    start: int
    width: int
    lower: ShapeKey
    upper: ShapeKey
    lower_index: int
    upper_index: int
    cycles: int


@final
@dataclass(frozen=True)
class MovingIntegral:
    """The integral of g^2 over [t, t + length] for t in one period, or within a finite table.

    Attributes
    ----------
    schedule : Schedule
    length : Fraction
        T > 0, s. For a finite table t runs over [0, end - T] (0 alone if T exceeds the table).
    """

    schedule: Schedule
    length: Fraction

    @cached_property
    def clock(self) -> Clock:
        """Clock of which knots and T are whole numbers of ticks."""
        return Clock.for_instants(self.schedule.profile.knots, (self.length,))

    @cached_property
    def knots(self) -> list[int]:
        """Knots of g, in ticks."""
        return [self.clock.ticks(knot) for knot in self.schedule.profile.knots]

    @cached_property
    def shapes(self) -> tuple[list[Coefficients], list[int]]:
        """Distinct shapes of g, and for every piece the index of its own."""
        distinct: list[Coefficients] = []
        index: dict[int, int] = {}
        which: list[int] = []
        for shape in self.schedule.profile.shapes:
            known = index.get(id(shape))
            if known is None:
                known = index[id(shape)] = len(distinct)
                distinct.append(shape)
            which.append(known)
        return distinct, which

    @cached_property
    def squares(self) -> list[Coefficients]:
        """Square of every distinct shape."""
        return [poly.multiply(shape, shape) for shape in self.shapes[0]]

    @cached_property
    def square_primitives(self) -> list[Coefficients]:
        """Antiderivative of every square, from 0."""
        return [poly.antiderivative(square) for square in self.squares]

    @cached_property
    def wholes(self) -> list[Fraction]:
        """Integral of every square over [0, 1]."""
        return [poly.evaluate(primitive, Fraction(1)) for primitive in self.square_primitives]

    @cached_property
    def scale(self) -> int:
        """Common denominator of the integrals of g^2 up to the knots."""
        return self.clock.rate * lcm(*(whole.denominator for whole in self.wholes))

    @cached_property
    def prefix(self) -> list[int]:
        """Integral of g^2 from 0 to every knot, in units of 1/`scale` s, exact."""
        per_tick = [int(whole * (self.scale // self.clock.rate)) for whole in self.wholes]
        total, sums = 0, [0]
        for i, which in enumerate(self.shapes[1]):
            total += (self.knots[i + 1] - self.knots[i]) * per_tick[which]
            sums.append(total)
        return sums

    @property
    def domain(self) -> int:
        """Largest t considered, in ticks: the period, or end - T but not below 0."""
        end = self.knots[-1]
        return end if self.schedule.is_periodic else max(end - self.clock.ticks(self.length), 0)

    def segments(self) -> Iterator[Segment]:
        """Polynomial pieces of F in order of time; one of width 0 if t = 0 alone is considered."""
        knots, which, end = self.knots, self.shapes[1], self.knots[-1]
        window = min(self.clock.ticks(self.length), end) if not self.schedule.is_periodic else None
        length = self.clock.ticks(self.length) if window is None else window
        cycles, phase = divmod(length, end)
        if phase == 0 and cycles and not self.schedule.is_periodic:
            cycles, phase = 0, end
        i, j = 0, min(bisect_right(knots, phase), len(knots) - 1) - 1
        t, last = 0, self.domain
        while True:
            u = t + phase
            step = min(knots[i + 1] - t, knots[j + 1] - u, last - t)
            yield Segment(
                t,
                step,
                (which[i], knots[i + 1] - knots[i], t - knots[i]),
                (which[j], knots[j + 1] - knots[j], u - knots[j]),
                i,
                j,
                cycles,
            )
            t += step
            if t >= last:
                return
            if t == knots[i + 1]:
                i += 1
            if t + phase == knots[j + 1]:
                j += 1
                if j == len(which):
                    j, phase, cycles = 0, phase - end, cycles + 1

    def whole_pieces(self, segment: Segment) -> int:
        """F at the start of a segment but for the two partial pieces, in units of 1/`scale` s, exact."""
        prefix = self.prefix
        return segment.cycles * prefix[-1] + prefix[segment.upper_index] - prefix[segment.lower_index]

    def value(self, segment: Segment) -> Fraction:
        """F at the start of a segment, s, exact."""
        whole = Fraction(self.whole_pieces(segment), self.scale)
        return whole + self.partial(segment.upper) - self.partial(segment.lower)

    def partial(self, part: ShapeKey) -> Fraction:
        """Integral of g^2 from the start of a piece to an offset into it, s, exact."""
        which, length, offset = part
        if not offset or not self.squares[which]:
            return Fraction(0)
        share = Fraction(offset, length)
        return self.clock.time(length) * poly.evaluate(self.square_primitives[which], share)

    def increment(self, segment: Segment) -> Coefficients:
        """F(start + s width) - F(start) for s in [0, 1], as a polynomial of s, exact."""
        rate = poly.add(
            self._square_along(segment.upper, segment.width),
            poly.scale(self._square_along(segment.lower, segment.width), Fraction(-1)),
        )
        return poly.antiderivative(poly.scale(rate, self.clock.time(segment.width)))

    def _square_along(self, part: ShapeKey, width: int) -> Coefficients:
        which, length, offset = part
        return poly.compose_affine(self.squares[which], Fraction(offset, length), Fraction(width, length))
