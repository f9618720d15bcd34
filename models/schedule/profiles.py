"""Shapes of the gain g inside a window, and schedules built from them.

A shape turns one thruster window into contiguous pieces; everything between windows is zero.
"""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ..apart import apart
from .piecewise import Piece, PiecewisePolynomial
from .polynomial import ZERO, Coefficients, polynomial
from .schedule import Schedule, Window

RISE: Coefficients = polynomial(0, 0, 3, -2)
"""Cubic Hermite from 0 to 1 with zero slope at both ends: 3 s^2 - 2 s^3."""
FALL: Coefficients = polynomial(1, 0, -3, 2)
"""Cubic Hermite from 1 to 0 with zero slope at both ends."""
FULL: Coefficients = polynomial(1)


class Shape(ABC):
    """How g behaves inside one thruster window."""

    @abstractmethod
    def pieces(self, window: Window) -> tuple[Piece, ...]:
        """Contiguous pieces of g for one window."""


@final
@dataclass(frozen=True)
class Hermite(Shape):
    """The paper's profile: up over the first quarter, 1 for half the on-time, down over the rest.

    Attributes
    ----------
    overrun : Fraction
        Time after `off` at which g reaches zero, s. The paper prints g(2 t_r + t_on) = 0 for a
        window [t_r, t_r + t_on], an overrun of t_r = 0.01 s; 0 keeps g inside the window.
    """

    overrun: Fraction = Fraction(0)

    def pieces(self, window: Window) -> tuple[Piece, ...]:
        """Rise, plateau, fall."""
        quarter = window.length / 4
        first, last = window.on + quarter, window.on + 3 * quarter
        return (
            Piece(window.on, first, RISE),
            Piece(first, last, FULL),
            Piece(last, window.off + self.overrun, FALL),
        )


@final
@dataclass(frozen=True)
class Ramps(Shape):
    """Smooth ramps of given durations at both ends of the window, 1 between them.

    Attributes
    ----------
    up, down : Fraction
        Durations of the ramps, s, > 0 (g must be C1).
    """

    up: Fraction
    down: Fraction

    def pieces(self, window: Window) -> tuple[Piece, ...]:
        """Rise, plateau (if any time is left for it), fall."""
        if self.up + self.down > window.length:
            raise ValueError(
                f"ramp_up + ramp_down = {float(self.up + self.down):g} s does not fit in the window "
                f"[{float(window.on):g}, {float(window.off):g}] s"
            )
        first, last = window.on + self.up, window.off - self.down
        plateau = (Piece(first, last, FULL),) if last > first else ()
        return (Piece(window.on, first, RISE), *plateau, Piece(last, window.off, FALL))


def build_schedule(
    windows: Sequence[Window],
    shape: Shape,
    *,
    period: Fraction | None = None,
    thruster_rise: Fraction = Fraction(0),
    thruster_fall: Fraction = Fraction(0),
) -> Schedule:
    """Schedule whose g follows `shape` in each window and is zero elsewhere.

    Raises
    ------
    ValueError
        If windows are empty, disordered, overlapping, or reach beyond the period.
    """
    check_windows(windows, period)
    pieces = [piece for window in windows for piece in shape.pieces(window)]
    return Schedule(
        windows=tuple(windows),
        profile=contiguous(pieces, period),
        period=period,
        thruster_rise=thruster_rise,
        thruster_fall=thruster_fall,
    )


def check_windows(windows: Sequence[Window], period: Fraction | None) -> None:
    """Refuse windows that are empty, disordered or overlapping, naming the first offender."""
    if not windows:
        raise ValueError("the schedule has no window: give at least one on/off pair")
    previous: Window | None = None
    for number, window in enumerate(windows, start=1):
        if window.on < 0:
            raise ValueError(f"schedule window {number} opens at {float(window.on):g} s: times start at 0 s")
        if window.off <= window.on:
            off, on = apart(window.off, window.on)
            order = f"closes ({off} s) before it opens ({on} s)"
            if window.off == window.on:
                order = f"is empty: it opens and closes at {on} s"
            raise ValueError(f"schedule window {number} {order}")
        if previous is not None and window.on < previous.off:
            off, on = apart(previous.off, window.on)
            raise ValueError(
                f"schedule window {number - 1} ends ({off} s) after window {number} begins ({on} s): "
                "windows must not overlap"
            )
        previous = window
    if period is not None and windows[-1].off > period:
        off, end = apart(windows[-1].off, period)
        raise ValueError(f"schedule window {len(windows)} ends ({off} s) after the period ({end} s)")


def contiguous(pieces: Sequence[Piece], period: Fraction | None) -> PiecewisePolynomial:
    """Fill the gaps between pieces with zero, from 0 to the last piece or the period."""
    knots: list[Fraction] = [Fraction(0)]
    shapes: list[Coefficients] = []
    for piece in pieces:
        if piece.start < knots[-1]:
            start, until = apart(piece.start, knots[-1])
            raise ValueError(
                f"g of one window still acts at {start} s when the next begins: windows must leave room "
                f"for it (until {until} s)"
            )
        if piece.start > knots[-1]:
            knots.append(piece.start)
            shapes.append(ZERO)
        knots.append(piece.end)
        shapes.append(piece.shape)
    if period is not None:
        if knots[-1] > period:
            last, end = apart(knots[-1], period)
            raise ValueError(f"g reaches zero at {last} s, after the period {end} s")
        if knots[-1] < period:
            knots.append(period)
            shapes.append(ZERO)
    return PiecewisePolynomial(tuple(knots), tuple(shapes))
