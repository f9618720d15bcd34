"""The door: a certified lower bound of the peak torque of a transfer, with its name.

Every number is a theorem about every controller whatever: no torque history within p w(t) with a
smaller p takes the start to the target. Several bounds are valid at once; the largest is printed.
"""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import final

import numpy as np

from ...verify.exact.rounding import rounded_down
from ..problem import TransferProblem
from .argument import Argument, ComponentsArgument, MomentumArgument, PathArgument, StartSet
from .potential.cache import remembered
from .potential.path import PathBound, PathOptions, path_bound
from .potential.separation import Target
from .sets.chart import Quaternion, arc_to_identity
from .sets.gauge import GaugeSet, invariant_set, longest_vertex
from .sets.momentum_sets import MomentumSet, UnitBall
from .windows.coast import Coast, coasts
from .windows.components import TransferSides, Widths, component_bounds, peak_from_components
from .windows.deviation import deviation_above, growth_of_deviations
from .windows.travel import WindowTravel, least_peak, momentum_peak

TRIALS = (1.0, 1.03, 1.07, 1.12, 1.18, 1.25, 1.35, 1.5, 1.75)
"""Trial peaks of the bound by components over the best other bound: any are valid, the best is kept."""


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
    argument : Argument
        Its proof, for a certificate.
    """

    name: str
    exact: Fraction
    argument: Argument = field(repr=False)

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
    """Bound the least peak torque of a transfer from below, proved.

    Notes
    -----
    Euclidean norm: momentum, and shortest path in the metric |J w|, from the start or, if it
    tumbles, from where a coast leads. Largest component and thrusters: the Euclidean bounds divided by
    the longest torque of unit peak, the invariant set (momentum and path) and, for the largest
    component from rest to exact rest, components.
    """
    options = options or PathOptions()
    if problem.norm.is_ball:
        bounds = _euclidean(problem, options)
    else:
        # The invariant set lies in the ball of the longest torque: little is lost by a coarse potential here.
        bounds = _euclidean(problem, options.coarse())
        longest = longest_vertex(problem.norm)
        bounds = [replace(b, name=f"Euclidean {b.name}", exact=b.exact / longest) for b in bounds]
        bounds += _by_invariant_set(problem, options)
    ordered = tuple(sorted(bounds, key=lambda bound: -bound.exact))
    return LowerBound(ordered[0], ordered, problem.norm.unit)


def _euclidean(problem: TransferProblem, options: PathOptions) -> list[NamedBound]:
    """Bounds for |torque| <= p w."""
    return _momentum_and_path(problem, UnitBall(problem.body), options, ("momentum", "shortest path"))


def _by_invariant_set(problem: TransferProblem, options: PathOptions) -> list[NamedBound]:
    """Bounds through the set that contains the torques and is invariant under free motion."""
    momenta = invariant_set(problem.body, problem.norm)
    names = ("momentum in the invariant set", "invariant set")
    result = _momentum_and_path(problem, momenta, options, names)
    at_rest = problem.starts_at_rest and not problem.terminal.rate
    if problem.norm.is_cube and at_rest and options.components:
        result += _by_components(problem, momenta, options, max(bound.exact for bound in result))
    return result


def _by_components(
    problem: TransferProblem, momenta: GaugeSet, options: PathOptions, known: Fraction
) -> list[NamedBound]:
    """Bound from components, at a trial peak a little above the bound known."""
    windows = WindowTravel(problem.window)
    if windows.total == 0 or known <= 0:
        return []
    sides = TransferSides(problem.window, windows.instant(windows.total / 2))
    first = component_bounds(momenta, sides, Fraction(float(known) * options.trial))
    share = Fraction(options.share)
    # Steps of 1/50 are fine enough, and let sweeps over windows share their potentials.
    near = [max(Fraction(round((1 + share * (B - 1)) * 50), 50), Fraction(1)) for B in first.B]
    if all(b >= r for b, r in zip(near, first.widths, strict=True)):
        return []
    beta: Widths = (near[0], near[1], near[2])
    path = path_of(problem, problem.attitude, momenta.with_box(beta), options)
    trials = (Fraction(float(known) * factor) for factor in TRIALS)
    found = [component_bounds(momenta, sides, trial) for trial in trials]
    peaks = [peak_from_components(sides, bounds, beta, path.travel) for bounds in found]
    peak, bounds = max(zip(peaks, found, strict=True), key=lambda pair: pair[0])
    return [NamedBound("components", peak, ComponentsArgument(momenta, path, beta, bounds, sides.instant))]


def _momentum_and_path(
    problem: TransferProblem, momenta: MomentumSet, options: PathOptions, names: tuple[str, str]
) -> list[NamedBound]:
    """Both bounds that a set of momenta gives."""
    windows = WindowTravel(problem.window)
    H0 = start_momentum(problem)
    end = momenta.size_of_rate(problem.terminal.rate)
    absorbed = momentum_peak(windows, momenta.size_below(H0), end)
    departure = best_departure(problem, momenta, windows)
    coast = departure.coast
    path = path_of(problem, coast.attitude, momenta, options)
    peak = least_peak(
        windows,
        path.travel - departure.slack,
        momenta.size_above(H0),
        end,
        after=coast.until,
        deviation=departure.deviation,
    )
    name = f"{names[1]} after a coast" if coast.until else names[1]
    return [
        NamedBound(names[0], absorbed, MomentumArgument(momenta)),
        NamedBound(name, peak.value, PathArgument(momenta, path, departure)),
    ]


def best_departure(problem: TransferProblem, momenta: MomentumSet, windows: WindowTravel) -> StartSet:
    """Choose the coast after which straight ways, a guess of the shortest, ask for the largest peak."""
    H0 = start_momentum(problem)
    start, end = momenta.size_above(H0), momenta.size_of_rate(problem.terminal.rate)
    growth = growth_of_deviations(momenta, H0)

    def promise(coast: Coast) -> Fraction:
        travel = Fraction(_straight(momenta, coast, problem.signs))
        deviation = deviation_above(windows, coast.until, growth, cells=4)
        return least_peak(windows, travel, start, end, after=coast.until, deviation=deviation).value

    best = max((coast for coast in coasts(problem) if growth.allows(coast.until)), key=promise)
    deviation = deviation_above(windows, best.until, growth)
    return StartSet(best, growth, deviation, momenta.size_of_rate(best.turn))


def _straight(momenta: MomentumSet, coast: Coast, signs: tuple[int, ...]) -> float:
    """Travel of the shorter rotation about a fixed axis."""
    unit = np.array([float(c) for c in coast.attitude])
    unit /= np.linalg.norm(unit)
    axis = unit[1:] if unit[1:].any() else np.array([1.0, 0.0, 0.0])
    return min(momenta.straight_travel(axis, 2 * arc_to_identity(sign * unit)) for sign in signs)


def start_momentum(problem: TransferProblem) -> tuple[Fraction, Fraction, Fraction]:
    """J w at the start, exactly."""
    rows = problem.body.exact_inertia
    H = [sum((row[k] * problem.rate[k] for k in range(3)), Fraction(0)) for row in rows]
    return H[0], H[1], H[2]


def path_of(
    problem: TransferProblem, attitude: Quaternion, momenta: MomentumSet, options: PathOptions
) -> PathBound:
    """Path bound from an attitude to the problem's target, remembered."""
    target = Target(problem.terminal.attitude)
    key = (momenta.key(), attitude, target, problem.signs, options)

    def compute() -> PathBound:
        signs = problem.signs
        return path_bound(problem.body, attitude, target, momenta, signs=signs, options=options)

    return remembered(key, compute)
