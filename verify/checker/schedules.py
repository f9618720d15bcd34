"""The gain g(t) of the data, piece by piece."""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise

from .bernstein import Form, from_powers, times_affine
from .exact_numbers import MAX_COUNT, Vector, require, show
from .reading import Node


@dataclass(frozen=True)
class Profile:
    """g on [0, end]: piece i is the polynomial shapes[i] of (t - knots[i])/(knots[i+1] - knots[i])."""

    knots: Vector
    shapes: list[Vector]
    period: Fraction | None

    def gain(self, start: Fraction, stop: Fraction) -> Form:
        """Return g on [start, stop], which must lie within one piece; zero beyond a finite table."""
        offset = Fraction(0)
        if self.period is not None:
            offset = start // self.period * self.period
        elif start >= self.knots[-1]:
            return Form([0])
        a, b = start - offset, stop - offset
        i = bisect_right(self.knots, a) - 1
        require(i + 1 < len(self.knots) and b <= self.knots[i + 1], "a step crosses a knot of the schedule")
        if not any(self.shapes[i]):
            return Form([0])
        length = self.knots[i + 1] - self.knots[i]
        shift, slope = (a - self.knots[i]) / length, (b - a) / length
        local: Vector = []
        for c in reversed(self.shapes[i]):
            local = times_affine(local, shift, slope)
            local[0] += c
        return from_powers(local)

    def side(self, t: Fraction, *, after: bool) -> tuple[Fraction, Fraction]:
        """Return g and its slope just after, or just before, an instant of [0, end]; 0 before a table."""
        end, still = self.knots[-1], (Fraction(0), Fraction(0))
        if after and t == end:
            if self.period is None:
                return still
            t = Fraction(0)
        if not after and t == 0:
            if self.period is None:
                return still
            t = end
        i = bisect_right(self.knots, t) - 1
        i -= 1 if not after and self.knots[i] == t else 0
        length = self.knots[i + 1] - self.knots[i]
        x, value, slope = (t - self.knots[i]) / length, Fraction(0), Fraction(0)
        for c in reversed(self.shapes[i]):
            slope = slope * x + value
            value = value * x + c
        return value, slope / length


def read_profile(data: Node) -> Profile:
    """Read the schedule of the data."""
    node = data["schedule"]
    knots = node["knots"].vector()
    table = [row.vector() for row in node["shapes"].items()]
    places = node["pieces"].vector(len(knots) - 1)
    require(all(x.denominator == 1 for x in places), "a piece must name a shape by its number")
    use = [int(x) for x in places]
    require(all(0 <= i < len(table) for i in use), "a piece names a shape that is not there")
    require(knots[0] == 0 and all(a < b for a, b in pairwise(knots)), "knots must increase from 0")
    require(bool(table), "there are no shapes")
    require(all(len(row) <= MAX_COUNT for row in table), "a shape has too many coefficients")
    require(
        all(from_powers(row or [Fraction(0)]).is_nonnegative() for row in table),
        "the gain is not proved >= 0",
    )
    period = node["period"].number() if node.has("period") else None
    require(period is None or period == knots[-1], "a periodic profile must end at its period")
    return Profile(knots, [table[i] for i in use], period)


def describe_profile(profile: Profile) -> str:
    """Return the schedule for people."""
    end = show(profile.knots[-1])
    kind_of = f"repeating every {end} s" if profile.period is not None else f"on [0, {end}] s, then 0"
    return f"the gain g(t) of the data, {len(profile.shapes)} polynomial pieces, {kind_of}"


def require_smooth(profile: Profile) -> None:
    """Raise Invalid unless value and slope of g agree at every knot (and from zero to zero at the ends)."""
    zero = (Fraction(0), Fraction(0))
    first, last = [], []
    for shape, (a, b) in zip(profile.shapes, pairwise(profile.knots), strict=True):
        slope = [i * c / (b - a) for i, c in enumerate(shape)][1:]
        first.append((shape[0] if shape else Fraction(0), slope[0] if slope else Fraction(0)))
        last.append((sum(shape, Fraction(0)), sum(slope, Fraction(0))))
    wrap = first[0] if profile.period is not None else zero
    for left, right in zip(last, [*first[1:], wrap], strict=True):
        require(left == right, "g is not C1 at a knot")


def require_continuous(profile: Profile) -> None:
    """Check that g does not jump: the laws use g', and Omega would jump with g."""
    starts = [shape[0] if shape else Fraction(0) for shape in profile.shapes]
    ends = [sum(shape, Fraction(0)) for shape in profile.shapes]
    following = [*starts[1:], Fraction(0) if profile.period is None else starts[0]]
    require(ends == following, "the gain jumps at a knot")
