"""What a comparison system on an unknown body is to the search: inequalities, and what may repeat."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Callable, Iterator, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ..filter.flowpipe import LawComparison
from ..filter.tail import PeriodicSystem, Tail
from ..flow.inequalities import StatedSystem


def _always(tail: Tail) -> bool:
    del tail
    return True


@final
@dataclass(frozen=True)
class Repetition:
    """A system to try over a period that repeats.

    Attributes
    ----------
    system, state : the system, and its components where the period begins
    accepts : whether what was proved is enough
    """

    system: PeriodicSystem
    state: tuple[float, ...]
    accepts: Callable[[Tail], bool] = _always


class RobustSystem(StatedSystem, LawComparison):
    """The comparison system of one law on every body of a bin.

    Attributes
    ----------
    push : bound of the disturbance in the metric of the rate, 0 without one
    is_binned : whether splitting the initial set in the error angle makes the bounds sharper
    """

    push: Fraction
    is_binned: bool = False

    @abstractmethod
    def repetitions(self, last: Mapping[str, float], first: Mapping[str, float]) -> Iterator[Repetition]:
        """What may repeat from here on, best first; `first` and `last` are the ends of the period before."""
