"""What windows allow: exact integrals of what a torque within p w(t) can do, and the peak they ask for.

With up(t) the integral of w over [0, t] and total = up(tf), a size N of momentum that grows at
most p w (and shrinks at most p w) satisfies N(t) <= min(N0 + p up(t), Nf + p (total - up(t))).
For any instant s the integral of that is at most

    N0 s + Nf (tf - s) + p A(s),    A(s) = int_0^s up + int_s^tf (total - up),

so a motion whose travel must be at least D needs p >= (D - N0 s - Nf (tf - s)) / A(s): linear in
p, exact in rationals, valid for every s; the best s is only searched for. If only the travel after an
instant c counts, and it may be less than D by p E (the deviation from a coast until c), then N0 counts
from c on, and A(s) loses int_0^c up and gains E.
"""

from __future__ import annotations

from bisect import bisect_right
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import final

from ....models.schedule import PiecewisePolynomial
from ....models.schedule import polynomial as poly
from ....verify.exact.bisection import bisected
from ....verify.exact.rounding import grid_near


@final
@dataclass(frozen=True)
class WindowTravel:
    """Integrals of a window profile w(t) >= 0 on [0, horizon], exact."""

    window: PiecewisePolynomial

    @property
    def horizon(self) -> Fraction:
        """Transfer time, s."""
        return self.window.knots[-1]

    @cached_property
    def _shapes(self) -> tuple[tuple[poly.Coefficients, poly.Coefficients], ...]:
        """First and second antiderivatives of each piece, in the piece's own variable."""
        result = []
        for piece in self.window.pieces:
            first = poly.scale(poly.antiderivative(piece.shape), piece.length)
            result.append((first, poly.scale(poly.antiderivative(first), piece.length)))
        return tuple(result)

    @cached_property
    def _prefix(self) -> tuple[tuple[Fraction, ...], tuple[Fraction, ...]]:
        """Values of up and of its integral at the knots."""
        first, second = [Fraction(0)], [Fraction(0)]
        for piece, (one, two) in zip(self.window.pieces, self._shapes, strict=True):
            second.append(second[-1] + first[-1] * piece.length + poly.evaluate(two, Fraction(1)))
            first.append(first[-1] + poly.evaluate(one, Fraction(1)))
        return tuple(first), tuple(second)

    @property
    def total(self) -> Fraction:
        """Open time weighted by w: the integral of w, s."""
        return self._prefix[0][-1]

    def up(self, t: Fraction) -> Fraction:
        """Integral of w over [0, t], s."""
        return self._at(t)[0]

    def _at(self, t: Fraction) -> tuple[Fraction, Fraction]:
        knots = self.window.knots
        i = min(max(bisect_right(knots, t) - 1, 0), len(knots) - 2)
        x = (t - knots[i]) / (knots[i + 1] - knots[i])
        one, two = self._shapes[i]
        first, second = self._prefix[0][i], self._prefix[1][i]
        return first + poly.evaluate(one, x), second + first * (t - knots[i]) + poly.evaluate(two, x)

    def opened_area(self, t: Fraction) -> Fraction:
        """Integral of up over [0, t], s^2."""
        return self._at(t)[1]

    @cached_property
    def _squares(self) -> tuple[Fraction, ...]:
        """Integral of up^2 at the knots."""
        values = [Fraction(0)]
        for i, piece in enumerate(self.window.pieces):
            values.append(values[-1] + self._square_part(i, Fraction(1)) * piece.length)
        return tuple(values)

    def _square_part(self, i: int, x: Fraction) -> Fraction:
        rise = poly.add(poly.polynomial(self._prefix[0][i]), self._shapes[i][0])
        return poly.evaluate(poly.antiderivative(poly.multiply(rise, rise)), x)

    def opened_square(self, t: Fraction) -> Fraction:
        """Integral of up^2 over [0, t], s^3."""
        knots = self.window.knots
        i = min(max(bisect_right(knots, t) - 1, 0), len(knots) - 2)
        length = knots[i + 1] - knots[i]
        return self._squares[i] + self._square_part(i, (t - knots[i]) / length) * length

    def area(self, s: Fraction) -> Fraction:
        """A(s), s^2."""
        inner = self._at(s)[1]
        return inner + self.total * (self.horizon - s) - (self._prefix[1][-1] - inner)

    def moment(self, a: Fraction, b: Fraction, about: Fraction) -> Fraction:
        """Integral of w(t) (about - t) over [a, b], s^2."""
        ends = self.up(b) * (about - b) - self.up(a) * (about - a)
        return ends + self.opened_area(b) - self.opened_area(a)

    def instant(self, opened: Fraction) -> Fraction:
        """Some t at which up(t) is near `opened`, a short binary fraction (clamped to [0, horizon])."""
        if opened <= 0:
            return Fraction(0)
        if opened >= self.total:
            return self.horizon
        knots = self.window.knots
        i = min(bisect_right(self._prefix[0], opened) - 1, len(knots) - 2)
        found = bisected(lambda t: self.up(t) <= opened, knots[i], knots[i + 1], steps=40)
        return grid_near(found[0], 40)


@final
@dataclass(frozen=True)
class PeakFromTravel:
    """A peak below which the travel is impossible: p >= value, by the instant s."""

    value: Fraction
    instant: Fraction


def least_peak(
    windows: WindowTravel,
    travel: Fraction,
    start: Fraction,
    end: Fraction,
    *,
    after: Fraction = Fraction(0),
    deviation: Fraction = Fraction(0),
) -> PeakFromTravel:
    """Lower bound of p from a travel, with upper bounds of the size of momentum at start and end.

    The travel is that after the instant `after`, less p times `deviation` (s^2).
    """
    best = PeakFromTravel(Fraction(0), after)
    if windows.total == 0:
        return best
    s = max(windows.instant(windows.total / 2), after)
    for _ in range(12):
        value = peak_at(windows, s, travel, start, end, after=after, deviation=deviation)
        if value <= best.value * (1 + Fraction(1, 10**12)):
            break
        best = PeakFromTravel(value, s)
        near = Fraction(float(value))
        if not near:
            break  # too small for a float
        crossing = (windows.total + (end - start) / near) / 2
        s = max(min(windows.instant(crossing), windows.horizon), after)
    return best


def peak_at(
    windows: WindowTravel,
    instant: Fraction,
    travel: Fraction,
    start: Fraction,
    end: Fraction,
    *,
    after: Fraction,
    deviation: Fraction,
) -> Fraction:
    """Lower bound of p with momentum counted from the start until an instant, then from the end."""
    area = windows.area(instant) - windows.opened_area(after) + deviation
    free = start * (instant - after) + end * (windows.horizon - instant)
    return (travel - free) / area if area > 0 else Fraction(0)


def momentum_peak(windows: WindowTravel, start: Fraction, end: Fraction) -> Fraction:
    """Lower bound of p from momentum alone: a lower bound at the start, an upper bound at the end."""
    if windows.total == 0:
        return Fraction(0)
    return max((start - end) / windows.total, Fraction(0))
