"""Charts of attitudes and polynomials of three variables on them."""

from __future__ import annotations

from fractions import Fraction
from math import comb

from .exact_numbers import Matrix, Vector, require
from .peak_numbers import Cubic, length_interval, quaternion_times
from .reading import Node


def cubic_sum(*terms: Cubic) -> Cubic:
    """Sum of polynomials in three variables."""
    result: Cubic = {}
    for term in terms:
        for e, c in term.items():
            result[e] = result.get(e, Fraction(0)) + c
    return result


def cubic_times(p: Cubic, q: Cubic) -> Cubic:
    """Product."""
    result: Cubic = {}
    for a, x in p.items():
        for b, y in q.items():
            e = (a[0] + b[0], a[1] + b[1], a[2] + b[2])
            result[e] = result.get(e, Fraction(0)) + x * y
    return result


def cubic_scale(p: Cubic, factor: Fraction) -> Cubic:
    """Multiple."""
    return {e: factor * c for e, c in p.items()}


def cubic_at(p: Cubic, centre: Vector) -> Cubic:
    """Taylor coefficients at a point."""
    result: Cubic = {}
    for (a, b, c), value in p.items():
        for i in range(a + 1):
            for j in range(b + 1):
                for k in range(c + 1):
                    factor = comb(a, i) * comb(b, j) * comb(c, k)
                    moved = centre[0] ** (a - i) * centre[1] ** (b - j) * centre[2] ** (c - k)
                    result[(i, j, k)] = result.get((i, j, k), Fraction(0)) + value * factor * moved
    return result


class PeakChart:
    """Coordinates x / outer about a middle attitude m, and the region of short paths in them."""

    def __init__(self, place: Node) -> None:
        self.middle, self.direction = place["middle"].vector(3), place["direction"].vector(3)
        self.inner, self.outer = place["inner"].number(), place["outer"].number()
        require(sum(c * c for c in self.direction) == 1, "the direction must be of length 1")
        require(0 <= self.inner <= self.outer < 1 and self.outer > 0, "expected 0 <= inner <= outer < 1")
        square = sum((c * c for c in self.middle), Fraction(0))
        self.quaternion = [(1 - square) / (1 + square)] + [2 * c / (1 + square) for c in self.middle]

    def region(self) -> list[Cubic]:
        """F and 1 - |x / outer|^2: both >= 0 wherever the path can be."""
        t, h = self.outer, self.inner
        one: Cubic = {(0, 0, 0): Fraction(1)}
        unit: Cubic = {(2, 0, 0): Fraction(1), (0, 2, 0): Fraction(1), (0, 0, 2): Fraction(1)}
        along = {(1, 0, 0): self.direction[0], (0, 1, 0): self.direction[1], (0, 0, 1): self.direction[2]}
        less = cubic_sum(one, cubic_scale(unit, -(t**2)))
        more = cubic_sum(one, cubic_scale(unit, t**2))
        cosines = ((1 - h**2) / (1 + h**2) * (1 + t**2) / (1 - t**2)) ** 2
        sines = (h / (1 + h**2) * (1 + t**2) / t) ** 2
        first = cubic_scale(cubic_times(less, less), cosines)
        second = cubic_scale(cubic_times(along, along), 4 * t**2 * sines)
        ellipse = cubic_sum(first, second, cubic_scale(cubic_times(more, more), Fraction(-1)))
        return [ellipse, cubic_sum(one, cubic_scale(unit, Fraction(-1)))]

    def locate(self, q: Vector) -> tuple[Vector, Fraction]:
        """Modified Rodrigues vector of m^-1 q/|q| and a bound of the error of each component."""
        m = self.quaternion
        r = quaternion_times([m[0], -m[1], -m[2], -m[3]], q)
        low, high = length_interval(q)
        require(r[0] + low > 0, "the start is opposite to the middle of the chart")
        x = [c / (r[0] + high) for c in r[1:]]
        error = max(abs(c) for c in r[1:]) * (high - low) / (r[0] + low) ** 2
        rounded = [Fraction(round(c * 2**96), 2**96) for c in x]
        return rounded, error + Fraction(1, 2**96)

    def arc_to_model(self, x: Vector, side: int) -> Fraction:
        """Upper bound of the arc from x to a model end point: the metric is at most 2 |dx|."""
        return (
            2
            * length_interval([c - side * self.inner * n for c, n in zip(x, self.direction, strict=True)])[1]
        )


def largest_near(p: Cubic, centre: Vector, radius: Fraction) -> Fraction:
    """Upper bound of a polynomial within a distance of a point."""
    local = cubic_at(p, centre)
    value = local.pop((0, 0, 0), Fraction(0))
    slopes = [local.pop(e, Fraction(0)) for e in ((1, 0, 0), (0, 1, 0), (0, 0, 1))]
    value += length_interval(slopes)[1] * radius
    return value + sum((abs(c) * radius ** sum(e) for e, c in local.items()), Fraction(0))


def rate_polynomials(phi: Cubic, inverse: Matrix, t: Fraction) -> list[Cubic]:
    """1/4 J^-1 [(1 - |x|^2) g - 2 x cross g + 2 (x.g) x] for g = grad phi, in scaled coordinates x / t."""
    g: list[Cubic] = []
    x: list[Cubic] = []
    for axis in range(3):
        unit = tuple(int(i == axis) for i in range(3))
        x.append({(unit[0], unit[1], unit[2]): Fraction(1)})
        slope: Cubic = {}
        for e, c in phi.items():
            if e[axis]:
                slope[(e[0] - unit[0], e[1] - unit[1], e[2] - unit[2])] = e[axis] * c
        g.append(slope)
    square = cubic_sum(*(cubic_times(a, a) for a in x))
    dot = cubic_sum(*(cubic_times(a, b) for a, b in zip(x, g, strict=True)))
    body = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        swirl = cubic_sum(cubic_times(x[j], g[k]), cubic_scale(cubic_times(x[k], g[j]), Fraction(-1)))
        straight = cubic_sum(cubic_scale(g[i], 1 / t), cubic_scale(cubic_times(square, g[i]), -t))
        bent = cubic_scale(cubic_times(x[i], dot), 2 * t)
        body.append(cubic_sum(straight, cubic_scale(swirl, Fraction(-2)), bent))
    return [cubic_sum(*(cubic_scale(body[j], inverse[i][j] / 4) for j in range(3))) for i in range(3)]
