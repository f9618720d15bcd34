"""Bounds that a set of momenta gives: from momentum that must be absorbed, from the way that must be gone."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ...verify.exact.ball import length
from ..problem import TransferProblem
from .argument import AxisArgument, MomentumArgument, NamedBound, PathArgument, StartSet
from .potential.cache import remembered
from .potential.path import PathBound, PathOptions, path_bound
from .potential.separation import Target
from .prepare import Measured
from .sets.chart import Quaternion, arc_to_identity
from .sets.momentum_sets import MomentumSet
from .windows.coast import Coast
from .windows.components import gyroscopic_form
from .windows.deviation import deviation_above, growth_of_deviations
from .windows.travel import least_peak, momentum_peak


def by_momentum(measured: Measured, name: str) -> NamedBound:
    """Bound from the momentum that the windows must absorb."""
    peak = momentum_peak(measured.prepared.windows, measured.start[0], measured.end)
    return NamedBound(name, peak / measured.radius[1], MomentumArgument(measured))


def by_axes(measured: Measured) -> list[NamedBound]:
    """Bounds from components of the momentum that free motion conserves: about axes of symmetry."""
    prepared, found = measured.prepared, []
    problem, total = prepared.problem, prepared.windows.total
    for axis in range(3):
        most = max(abs(t[axis]) for t in problem.norm.corners())
        if total and most and not any(any(row) for row in gyroscopic_form(problem.body, axis)):
            end = problem.terminal.rate * length(problem.body.exact_inertia[axis])[1]
            peak = max(abs(prepared.momentum[axis]) - end, Fraction(0)) / (most * total)
            found.append(NamedBound("momentum about an axis", peak, AxisArgument(measured, axis)))
    return found


def by_path(measured: Measured, options: PathOptions, name: str) -> NamedBound:
    """Bound from the way to the target, from the start or from where a coast leads."""
    departure = best_departure(measured)
    coast, problem = departure.coast, measured.prepared.problem
    path = path_of(problem, coast.attitude, measured.momenta, options)
    found = least_peak(
        measured.prepared.windows,
        path.travel - departure.slack,
        measured.start[1],
        measured.end,
        after=coast.until,
        deviation=departure.deviation,
    )
    argument = PathArgument(measured, path, departure, found.instant)
    name = f"{name} after a coast" if coast.until else name
    return NamedBound(name, found.value / measured.radius[1], argument)


def best_departure(measured: Measured) -> StartSet:
    """Choose the coast after which straight ways, a guess of the shortest, ask for the largest peak."""
    prepared, momenta = measured.prepared, measured.momenta
    growth = growth_of_deviations(momenta, prepared.momentum)

    def promise(coast: Coast) -> Fraction:
        travel = Fraction(_straight(momenta, coast, prepared.problem.signs))
        deviation = deviation_above(prepared.windows, coast.until, growth, cells=4)
        return least_peak(
            prepared.windows, travel, measured.start[1], measured.end, after=coast.until, deviation=deviation
        ).value

    best = max((coast for coast in prepared.coasts if growth.allows(coast.until)), key=promise)
    deviation = deviation_above(prepared.windows, best.until, growth)
    return StartSet(best, growth, deviation, momenta.size_of_rate(best.turn))


def _straight(momenta: MomentumSet, coast: Coast, signs: tuple[int, ...]) -> float:
    """Travel of the shorter rotation about a fixed axis."""
    unit = np.array([float(c) for c in coast.attitude])
    unit /= np.linalg.norm(unit)
    axis = unit[1:] if unit[1:].any() else np.array([1.0, 0.0, 0.0])
    return min(momenta.straight_travel(axis, 2 * arc_to_identity(sign * unit)) for sign in signs)


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
