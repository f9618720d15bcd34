"""Functions of time that a law may use beside g: polynomials in each phase of the schedule."""

from __future__ import annotations

from abc import ABC, abstractmethod

from .schedule import Piece, Schedule
from .schedule.polynomial import Coefficients


class TimeSignal(ABC):
    """A known function of time, polynomial on each piece of the schedule; its rate follows."""

    name: str

    @abstractmethod
    def on_piece(self, schedule: Schedule, piece: Piece) -> Coefficients:
        """Coefficients in tau = t - piece.start (s), lowest power first, exact."""
