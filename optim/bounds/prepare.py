"""A transfer made ready for bounds: what every set of momenta and every argument asks of it, once."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import final

from ..problem import TransferProblem
from .sets.chart import Vector
from .sets.momentum_sets import MomentumSet
from .windows.coast import Coast, coasts
from .windows.travel import WindowTravel

ONE = (Fraction(1), Fraction(1))


def start_momentum(problem: TransferProblem) -> Vector:
    """J w at the start, exactly, N m s."""
    rows = problem.body.exact_inertia
    H = [sum((row[k] * problem.rate[k] for k in range(3)), Fraction(0)) for row in rows]
    return H[0], H[1], H[2]


@final
@dataclass(frozen=True)
class Prepared:
    """A transfer, with the integrals of its windows, its momentum at the start and its coasts."""

    problem: TransferProblem

    @cached_property
    def windows(self) -> WindowTravel:
        """What the windows allow."""
        return WindowTravel(self.problem.window)

    @cached_property
    def momentum(self) -> Vector:
        """J w at the start, exactly, N m s."""
        return start_momentum(self.problem)

    @cached_property
    def coasts(self) -> tuple[Coast, ...]:
        """Free motion from the start, the one of no length first."""
        return coasts(self.problem)

    def measured(self, momenta: MomentumSet, radius: tuple[Fraction, Fraction] = ONE) -> Measured:
        """Measure both ends of the transfer in a set of momenta."""
        start, end = self.momentum, momenta.size_of_rate(self.problem.terminal.rate)
        return Measured(self, momenta, (momenta.size_below(start), momenta.size_above(start)), end, radius)


@final
@dataclass(frozen=True)
class Measured:
    """A set of momenta and the sizes that a transfer has in it.

    Attributes
    ----------
    prepared : Prepared
        The transfer.
    momenta : MomentumSet
        Set whose gauge measures momentum.
    start : two Fraction
        Gauge of the momentum at the start, enclosed.
    end : Fraction
        Upper bound of the gauge over the rates allowed at the end.
    radius : two Fraction
        The torques of unit peak lie in so many times the set, enclosed: 1, or, of the unit ball, the
        length of the longest of them.
    """

    prepared: Prepared
    momenta: MomentumSet
    start: tuple[Fraction, Fraction]
    end: Fraction
    radius: tuple[Fraction, Fraction]
