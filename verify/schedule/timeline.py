"""A schedule on one exact integer clock, and the sweeps that decide its facts in linear time."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import final

from ...models.schedule import Clock, Schedule, Window
from ...models.schedule import polynomial as poly
from ...models.schedule.polynomial import Coefficients

Span = tuple[int, int]
"""An interval in ticks."""


@final
@dataclass(frozen=True)
class Action:
    """g is not zero at `instant` within `interval`, where it should be zero throughout."""

    interval: Window
    instant: Fraction
    value: Fraction


@final
@dataclass(frozen=True)
class Jump:
    """`what` ("g" or "dg/dt") jumps by `size` at `instant`."""

    what: str
    instant: Fraction
    size: Fraction


@final
@dataclass(frozen=True)
class Timeline:
    """One table, or one period, of a schedule with every instant a whole number of ticks."""

    schedule: Schedule

    @cached_property
    def clock(self) -> Clock:
        """Clock of which knots, window edges and the thruster's times are whole numbers."""
        s = self.schedule
        edges = [w.on for w in s.windows], [w.off for w in s.windows]
        return Clock.for_instants(s.profile.knots, *edges, (s.thruster_rise, s.thruster_fall))

    @cached_property
    def knots(self) -> list[int]:
        """Knots of g, in ticks."""
        return [self.clock.ticks(knot) for knot in self.schedule.profile.knots]

    @cached_property
    def windows(self) -> list[Span]:
        """Thruster windows, in ticks."""
        ticks = self.clock.ticks
        return [(ticks(w.on), ticks(w.off)) for w in self.schedule.windows]

    @property
    def end(self) -> int:
        """End of the table, or the period, in ticks."""
        return self.knots[-1]

    def gaps(self) -> list[Span]:
        """Return the parts of [0, end] that no window covers."""
        found, reached = [], 0
        for on, off in sorted(self.windows):
            if on > reached:
                found.append((reached, on))
            reached = max(reached, off)
        if reached < self.end:
            found.append((reached, self.end))
        return found

    def uncertain(self) -> list[Span]:
        """Return the intervals in which the thrust is uncertain, cut to [0, end], wrapped if periodic."""
        rise = self.clock.ticks(self.schedule.thruster_rise)
        fall = self.clock.ticks(self.schedule.thruster_fall)
        spans = [(on - rise, on) for on, _ in self.windows if rise]
        spans += [(off, off + fall) for _, off in self.windows if fall]
        cut: list[Span] = []
        for on, off in spans:
            outside = self.schedule.is_periodic and (on < 0 or off > self.end)
            for shift in (-self.end, 0, self.end) if outside else (0,):
                start, stop = max(on + shift, 0), min(off + shift, self.end)
                if start < stop:
                    cut.append((start, stop))
        return sorted(cut)

    def actions(self, spans: list[Span]) -> list[Action]:
        """Every piece of g that acts within one of the sorted spans, with an instant at which it does."""
        knots, shapes = self.knots, self.schedule.profile.shapes
        found: list[Action] = []
        first = 0
        for on, off in spans:
            while first < len(shapes) and knots[first + 1] <= on:
                first += 1
            i = first
            while i < len(shapes) and knots[i] < off:
                if shapes[i]:
                    found.append(self._action(i, max(knots[i], on), min(knots[i + 1], off)))
                i += 1
        return found

    def _action(self, i: int, start: int, stop: int) -> Action:
        """Evaluate a piece that is not the zero polynomial where it is not 0: some of degree + 1 points."""
        shape, time = self.schedule.profile.shapes[i], self.clock.time
        overlap = Window(time(start), time(stop))
        begin, length = time(self.knots[i]), time(self.knots[i + 1] - self.knots[i])
        points = len(shape) + 1
        for k in (points // 2, *range(1, points)):
            instant = overlap.on + overlap.length * Fraction(k, points)
            value = poly.evaluate(shape, (instant - begin) / length)
            if value != 0:
                return Action(overlap, instant, value)
        raise AssertionError("a polynomial that is not zero has fewer zeros than degree + 1")

    def first_jump(self) -> Jump | None:
        """Return the first knot at which g or its slope jumps, or None.

        After the end the period begins anew, or g = 0.
        """
        shapes, knots = self.schedule.profile.shapes, self.knots
        ends: dict[int, tuple[Fraction, Fraction, Fraction, Fraction]] = {}
        for i in range(1, len(shapes) + 1):
            last = i == len(shapes)
            after = shapes[i] if not last else shapes[0] if self.schedule.is_periodic else poly.ZERO
            _, value, _, slope = _ends(ends, shapes[i - 1])
            next_value, _, next_slope, _ = _ends(ends, after)
            if value != next_value:
                return Jump("g", self.clock.time(knots[i]), next_value - value)
            if not slope and not next_slope:
                continue
            j = i if not last else 0
            rate = next_slope / self.clock.time(knots[j + 1] - knots[j])
            rate -= slope / self.clock.time(knots[i] - knots[i - 1])
            if rate:
                return Jump("dg/dt", self.clock.time(knots[i]), rate)
        return None

    def inner_margins(self) -> Span | None:
        """Return by how much every `on` may come later and every `off` earlier before g acts outside.

        None if g acts outside a window already, or nowhere.
        """
        knots, shapes = self.knots, self.schedule.profile.shapes
        opening: list[int] = []
        closing: list[int] = []
        i = 0
        for on, off in sorted(self.windows):
            while i < len(shapes) and (knots[i + 1] <= on or (not shapes[i] and knots[i + 1] <= off)):
                if shapes[i]:
                    return None
                i += 1
            if i == len(shapes) or knots[i] >= off or not shapes[i]:
                continue
            opening.append(knots[i] - on)
            while i < len(shapes) and knots[i] < off:
                if shapes[i]:
                    acted = knots[i + 1]
                i += 1
            closing.append(off - acted)
        if not opening or min(opening) < 0 or min(closing) < 0:
            return None
        return min(opening), min(closing)


def _ends(
    known: dict[int, tuple[Fraction, Fraction, Fraction, Fraction]], shape: Coefficients
) -> tuple[Fraction, Fraction, Fraction, Fraction]:
    """Values at 0 and 1, slopes at 0 and 1; computed once for each shape object."""
    found = known.get(id(shape))
    if found is None:
        slope, zero, one = poly.derivative(shape), Fraction(0), Fraction(1)
        found = (
            poly.evaluate(shape, zero),
            poly.evaluate(shape, one),
            poly.evaluate(slope, zero),
            poly.evaluate(slope, one),
        )
        known[id(shape)] = found
    return found
