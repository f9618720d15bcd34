"""What the comparison systems on an unknown body share: setting, steps, and what they are asked."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from .bernstein import Form
from .comparison import Bounds, Conditions
from .exact_numbers import Vector, require, show
from .floor_bounds import root_above
from .floor_steps import FloorStep
from .robust_constants import CELLS, RobustConstants
from .schedules import Profile

LAST = CELLS - 1


@dataclass(frozen=True)
class Robust:
    """What every step of a bin is checked against; c >= 1/sqrt(8 Jmin), push bounds the disturbance."""

    profile: Profile
    constants: RobustConstants
    forcings: Vector
    c: Fraction
    push: Fraction

    def cell(self, number: int) -> tuple[Fraction, Fraction]:
        """2 B3 N and m for S up to the upper end of a cell."""
        high = cell_end(number)
        n = root_above(high * (2 - high)) if high < 1 else Fraction(1)
        return 2 * self.constants.gyroscopic * n, self.forcings[number]


def cell_end(number: int) -> Fraction:
    """Upper end of a cell of S."""
    return Fraction(2 * number + 2, CELLS)


def read_cell(word: str) -> int:
    """The number of a cell of S."""
    require(word.isdecimal() and int(word) <= LAST, "unknown bound of S")
    return int(word)


class RobustSystem(ABC):
    """One law's system.

    Attributes
    ----------
    sides, tail_sides : component -> -1 for a lower bound, +1 for an upper one; in a part that repeats too
    """

    sides: ClassVar[Mapping[str, int]]
    tail_sides: ClassVar[Mapping[str, int]]

    @abstractmethod
    def kappa(self) -> Fraction:
        """kappa(0), 1/s."""

    @abstractmethod
    def start(self, s: Vector, y: Fraction) -> Bounds:
        """What is known at t = 0."""

    @abstractmethod
    def conditions(
        self, d: Robust, G: Form, step: FloorStep, dx: dict[str, Form], *, tail: bool, scaled: bool
    ) -> Conditions:
        """Everything that must be >= 0 on a step; `scaled`: without terms that a scaling would break."""

    @abstractmethod
    def kept(self, step: FloorStep) -> frozenset[str]:
        """Bounds of angle and rate that a step keeps; what it gives up says nothing, and stays given up."""

    @abstractmethod
    def box(self, low: Bounds, high: Bounds, step: FloorStep) -> tuple[Fraction, Fraction, Fraction]:
        """S, y and kappa from above."""

    @abstractmethod
    def words(self) -> list[str]:
        """The law for people."""

    def repeats(self, steps: Sequence[FloorStep], before: Bounds, ratio: Fraction | None) -> Bounds:
        """Check what else a part that repeats needs; return where its components must begin."""
        del steps, ratio
        return before


def check_step(system: RobustSystem, d: Robust, step: FloorStep, *, tail: bool, scaled: bool) -> None:
    """Check every differential inequality on a step."""
    g = d.profile.gain(step.start, step.stop)
    per_second = 1 / (step.stop - step.start)
    dx = {name: p.derivative().times(per_second) for name, p in step.x.items()}
    for name, condition in system.conditions(d, g * g, step, dx, tail=tail, scaled=scaled):
        where = f"on [{show(step.start)}, {show(step.stop)}] s"
        require(condition.is_nonnegative(), f"{name} is not proved {where}")
