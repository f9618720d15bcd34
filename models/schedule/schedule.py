"""The thruster schedule: windows, the gain profile g(t), and how both go on after the table ends."""

from __future__ import annotations

from bisect import bisect_right
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property, lru_cache
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from ..types import Array
from .piecewise import Piece, PiecewisePolynomial
from .polynomial import ZERO


@final
@dataclass(frozen=True)
class Window:
    """One thruster window [on, off], s: full thrust is certain inside it."""

    on: Fraction
    off: Fraction

    @property
    def length(self) -> Fraction:
        """Duration, s."""
        return self.off - self.on


@final
@dataclass(frozen=True)
class Schedule:
    """A gain profile g(t) >= 0 through thruster windows, exact.

    Attributes
    ----------
    windows : tuple of Window
        Thruster windows of the table (of one period, if periodic), in order of time.
    profile : PiecewisePolynomial
        g on [0, end], dimensionless; pieces are contiguous and gaps are explicit zero pieces.
        For a periodic schedule `end` is the period.
    period : Fraction or None
        Repetition period, s; None for a finite table (g = 0 after it).
    thruster_rise, thruster_fall : Fraction
        Time before `on` and after `off` in which the thrust is uncertain, s.

    Notes
    -----
    Floats are a view: `gain` and `gain_rate` evaluate the exact data rounded once.
    """

    windows: tuple[Window, ...]
    profile: PiecewisePolynomial
    period: Fraction | None = None
    thruster_rise: Fraction = Fraction(0)
    thruster_fall: Fraction = Fraction(0)

    def __post_init__(self) -> None:
        if self.profile.knots[0] != 0:
            raise ValueError(f"the profile must start at 0 s, received {float(self.profile.knots[0])} s")
        if self.period is not None and self.profile.knots[-1] != self.period:
            raise ValueError(
                f"a periodic profile must end at its period {float(self.period)} s, "
                f"received {float(self.profile.knots[-1])} s"
            )

    @property
    def is_periodic(self) -> bool:
        """Whether the windows repeat for ever."""
        return self.period is not None

    @property
    def end(self) -> Fraction:
        """End of the table, or the period, s."""
        return self.profile.knots[-1]

    @property
    def idle_lead(self) -> Fraction:
        """Time before anything acts, s, where it is longer than the rest of a finite table; else 0."""
        if self.period is not None:
            return Fraction(0)
        pieces = zip(self.profile.shapes, self.profile.knots, strict=False)
        first = min([self.windows[0].on, *[knot for shape, knot in pieces if any(shape)][:1]])
        return first if first > self.end - first else Fraction(0)

    def pieces_between(self, start: Fraction, stop: Fraction) -> Iterator[Piece]:
        """Pieces of g that meet (start, stop), whole, in absolute time; after a table, zero."""
        if self.period is None:
            yield from self._table_pieces(start, stop, Fraction(0))
            if stop > self.end:
                yield Piece(self.end, stop, ZERO)
            return
        cycle = start // self.period
        while cycle * self.period < stop:
            yield from self._table_pieces(start, stop, cycle * self.period)
            cycle += 1

    def _table_pieces(self, start: Fraction, stop: Fraction, offset: Fraction) -> Iterator[Piece]:
        knots, shapes = self.profile.knots, self.profile.shapes
        first = max(bisect_right(knots, start - offset) - 1, 0)
        for i in range(first, len(shapes)):
            if knots[i] + offset >= stop:
                return
            yield Piece(knots[i] + offset, knots[i + 1] + offset, shapes[i])

    def windows_before(self, stop: Fraction) -> int:
        """Return how many windows open before `stop`, counted without listing them."""
        if self.period is None:
            return sum(window.on < stop for window in self.windows)
        cycles = max(stop // self.period, 0)
        rest = stop - cycles * self.period
        return cycles * len(self.windows) + sum(window.on < rest for window in self.windows)

    def windows_between(self, start: Fraction, stop: Fraction) -> Iterator[Window]:
        """Thruster windows that meet (start, stop), whole, in absolute time."""
        cycle = Fraction(0) if self.period is None else start // self.period - 1
        while True:
            offset = Fraction(0) if self.period is None else cycle * self.period
            for window in self.windows:
                if window.on + offset < stop and window.off + offset > start:
                    yield Window(window.on + offset, window.off + offset)
            cycle += 1
            if self.period is None or cycle * self.period >= stop:
                return

    def support_between(self, start: Fraction, stop: Fraction) -> Iterator[Window]:
        """Maximal intervals on which g is not identically zero and that meet (start, stop)."""
        current: Window | None = None
        for piece in self.pieces_between(start, stop):
            if piece.shape == ZERO:
                continue
            if current is not None and current.off == piece.start:
                current = Window(current.on, piece.end)
                continue
            if current is not None:
                yield current
            current = Window(piece.start, piece.end)
        if current is not None:
            yield current

    @cached_property
    def _float_table(self) -> tuple[Array, Array]:
        """Knots (n + 1,) and local coefficients (4 or more, n), lowest power first."""
        return _float_table(self.profile)

    def gain(self, t: ArrayLike) -> Array:
        """g(t), dimensionless, for t in s of any shape."""
        return self._evaluate(t, 0)

    def gain_rate(self, t: ArrayLike) -> Array:
        """dg/dt, 1/s, for t in s of any shape; at a knot the right-hand derivative."""
        return self._evaluate(t, 1)

    def _evaluate(self, t: ArrayLike, order: int) -> Array:
        knots, coefficients = self._float_table
        times = np.asarray(t, dtype=float)
        local = np.mod(times, float(self.period)) if self.period is not None else times
        index = np.clip(np.searchsorted(knots, local, side="right") - 1, 0, coefficients.shape[1] - 1)
        tau = local - knots[index]
        powers = (
            coefficients if order == 0 else coefficients[1:] * np.arange(1, coefficients.shape[0])[:, None]
        )
        value = np.zeros_like(tau)
        for row in powers[::-1]:
            value = value * tau + row[index]
        outside = (local < knots[0]) | (local > knots[-1])
        return np.where(outside, 0.0, value)

    def square_integral(self, start: Fraction, stop: Fraction) -> Fraction:
        """Exact integral of g^2 over [start, stop], s."""
        return self._primitive(stop) - self._primitive(start)

    @cached_property
    def _square_prefix(self) -> tuple[Fraction, ...]:
        total, sums = Fraction(0), [Fraction(0)]
        for value in self.profile.square_integrals:
            total += value
            sums.append(total)
        return tuple(sums)

    def _primitive(self, t: Fraction) -> Fraction:
        """Integral of g^2 over [0, t]."""
        from . import polynomial as poly

        cycles = Fraction(0)
        if self.period is not None:
            count = t // self.period
            cycles, t = count * self._square_prefix[-1], t - count * self.period
        if t >= self.end:
            return cycles + self._square_prefix[-1]
        i = bisect_right(self.profile.knots, t) - 1
        length = self.profile.knots[i + 1] - self.profile.knots[i]
        shape = self.profile.shapes[i]
        partial = poly.antiderivative(poly.multiply(shape, shape))
        inside = length * poly.evaluate(partial, (t - self.profile.knots[i]) / length)
        return cycles + self._square_prefix[i] + inside


@lru_cache(maxsize=32)
def _float_table(profile: PiecewisePolynomial) -> tuple[Array, Array]:
    degree = max((len(shape) for shape in profile.shapes), default=1)
    coefficients = np.zeros((max(degree, 1), len(profile.shapes)))
    knots = np.array([float(k) for k in profile.knots])
    lengths = np.array([float(b - a) for a, b in zip(profile.knots, profile.knots[1:], strict=False)])
    for i, shape in enumerate(profile.shapes):
        for j, c in enumerate(shape):
            coefficients[j, i] = float(c)
    scale = lengths[None, :] ** np.arange(coefficients.shape[0])[:, None]
    return knots, coefficients / scale
