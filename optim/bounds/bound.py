"""The door: a certified lower bound of the peak torque of a transfer, with its name.

Every number is a theorem about every controller whatever: no torque history within p w(t) with a
smaller p takes the start to the target. Several bounds are valid at once; the largest is printed.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ..norms import Euclidean
from ..problem import TransferProblem
from .cache import remembered
from .fit import ConeConstraint
from .momentum_sets import UnitBall
from .path import PathBound, PathOptions, path_bound
from .separation import Target
from .travel import WindowTravel, least_peak, momentum_peak, rounded_down


@final
@dataclass(frozen=True)
class NamedBound:
    """One valid lower bound.

    Attributes
    ----------
    name : str
        Which argument it comes from.
    exact : Fraction
        The bound; `value` is it rounded down.
    """

    name: str
    exact: Fraction

    @property
    def value(self) -> float:
        """The bound as a float, rounded down."""
        return rounded_down(self.exact)


@final
@dataclass(frozen=True)
class LowerBound:
    """The largest of the valid bounds, and all of them.

    Attributes
    ----------
    best : NamedBound
        Largest.
    all : tuple of NamedBound
        Every bound computed, largest first.
    unit : str
        Unit of the peak.
    """

    best: NamedBound
    all: tuple[NamedBound, ...]
    unit: str

    @property
    def value(self) -> float:
        """No torque history with a smaller peak makes the transfer; rounded down."""
        return self.best.value

    @property
    def name(self) -> str:
        """Name of the largest bound."""
        return self.best.name


def certified_lower_bound(problem: TransferProblem, *, options: PathOptions | None = None) -> LowerBound:
    """Bound the least peak torque of a transfer from below, proved."""
    if not isinstance(problem.norm, Euclidean):
        raise NotImplementedError(problem.norm.name)
    bounds = euclidean_bounds(problem, options or PathOptions())
    ordered = tuple(sorted(bounds, key=lambda bound: -bound.exact))
    return LowerBound(ordered[0], ordered, problem.norm.unit)


def euclidean_bounds(problem: TransferProblem, options: PathOptions) -> list[NamedBound]:
    """Bounds for |torque| <= p w: momentum alone, and shortest path in the metric |J w|."""
    windows = WindowTravel(problem.window)
    ball = UnitBall(problem.body)
    momentum = tuple(
        sum((row[k] * problem.rate[k] for k in range(3)), Fraction(0)) for row in problem.body.exact_inertia
    )
    H0 = (momentum[0], momentum[1], momentum[2])
    end = ball.size_of_rate(problem.terminal.rate)
    result = [NamedBound("momentum", momentum_peak(windows, ball.size_below(H0), end))]
    target = Target(problem.terminal.attitude)
    key = (ball.key(), problem.attitude, target, problem.signs, options)

    def compute() -> PathBound:
        body, attitude = problem.body, problem.attitude
        return path_bound(
            body, attitude, target, ball, ConeConstraint(), signs=problem.signs, options=options
        )

    path = remembered(key, compute)
    peak = least_peak(windows, path.travel, ball.size_above(H0), end)
    result.append(NamedBound("shortest path", peak.value))
    return result
