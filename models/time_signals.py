"""Functions of time that a law may use beside g: polynomials in each phase of the schedule."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from .schedule import Piece, Schedule
from .schedule.polynomial import Coefficients, polynomial


class TimeSignal(ABC):
    """A known function of time, polynomial on each piece of the schedule; its rate follows."""

    name: str

    @abstractmethod
    def on_piece(self, schedule: Schedule, piece: Piece) -> Coefficients:
        """Coefficients in tau = t - piece.start (s), lowest power first, exact."""


@final
@dataclass(frozen=True)
class WindowIndex(TimeSignal):
    """Number of the current window (of the next one between windows), counted from 0; -1 after the last."""

    name: str = "window_index"

    def on_piece(self, schedule: Schedule, piece: Piece) -> Coefficients:
        """Constant on the piece."""
        index = _next_window(schedule, piece)
        return polynomial(index if index is not None else -1)


@final
@dataclass(frozen=True)
class WindowClosing(TimeSignal):
    """Closing time of the current window (of the next one between windows), s; 0 after the last."""

    name: str = "window_closing"

    def on_piece(self, schedule: Schedule, piece: Piece) -> Coefficients:
        """Constant on the piece."""
        index = _next_window(schedule, piece)
        if index is None:
            return polynomial(0)
        count = len(schedule.windows)
        offset = Fraction(0) if schedule.period is None else (index // count) * schedule.period
        return polynomial(schedule.windows[index % count].off + offset)


def _next_window(schedule: Schedule, piece: Piece) -> int | None:
    """Number of the first window that has not closed at the middle of the piece."""
    middle = (piece.start + piece.end) / 2
    cycle = 0 if schedule.period is None else int(middle // schedule.period)
    local = middle - (cycle * schedule.period if schedule.period is not None else 0)
    count = len(schedule.windows)
    for i, window in enumerate(schedule.windows):
        if window.off > local:
            return cycle * count + i
    return (cycle + 1) * count if schedule.period is not None else None
