"""The door: a certified lower bound of the peak torque of a transfer, with its name.

Every number is a theorem about every controller whatever: no torque history within p w(t) with a
smaller p takes the start to the target. Several bounds are valid at once; the largest is printed.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...verify.exact.rounding import rounded_down
from ..problem import TransferProblem
from .argument import ComponentsArgument, NamedBound
from .potential.path import PathOptions
from .prepare import Measured, Prepared
from .proof import by_momentum, by_path, path_of
from .sets.gauge import GaugeSet, invariant_set, longest_vertex
from .sets.momentum_sets import UnitBall
from .windows.components import ComponentBounds, Widths, component_bounds, peak_from_components
from .windows.drift import box_for
from .windows.split import Split, Splits
from .windows.travel import WindowTravel


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

    Claims, of each bound: no torque history within p w(t), p smaller than the bound, takes the body
    from the start to the target within the terminal tolerances at the transfer time, by whatever
    controller. The inertia is taken as stated; its tolerance is not covered.

    Parameters
    ----------
    problem : TransferProblem
        Inertia (kg m^2), window profile, start, target, norm and tolerances, all exact.
    options : PathOptions or None
        Effort of the potentials; whatever it is, the bounds are valid.

    Returns
    -------
    LowerBound
        The largest bound and all others, in the norm's unit (N m, or N for thrusters), each with the
        argument from which `certificate.peak_certificate` writes its certificate.

    Raises
    ------
    ValueError
        If the terminal tolerance is too large for a chart of attitudes, or a norm has more thrusters
        than corners can be listed of.

    References
    ----------
    docs/lower-bounds.md has the theorems with their proofs: momentum and travel through windows, the
    invariant set of a torque set, potentials on charts of short paths, components.

    Notes
    -----
    Euclidean norm: momentum, and shortest path in the metric |J w|, from the start or, if it
    tumbles, from where a coast leads. Largest component and thrusters: the Euclidean bounds divided by
    the longest torque of unit peak, the invariant set (momentum and path) and, for the largest
    component, each component by itself.
    """
    options = options or PathOptions()
    prepared, ball = Prepared(problem), UnitBall(problem.body)
    if problem.norm.is_ball:
        bounds = _momentum_and_path(prepared.measured(ball), options, ("momentum", "shortest path"))
    else:
        # The invariant set lies in the ball of the longest torque: little is lost by a coarse potential here.
        within = prepared.measured(ball, longest_vertex(problem.norm))
        names = ("Euclidean momentum", "Euclidean shortest path")
        bounds = _momentum_and_path(within, options.coarse(), names)
        bounds += _by_invariant_set(prepared, options)
    ordered = tuple(sorted(bounds, key=lambda bound: -bound.exact))
    return LowerBound(ordered[0], ordered, problem.norm.unit)


def _momentum_and_path(measured: Measured, options: PathOptions, names: tuple[str, str]) -> list[NamedBound]:
    """Both bounds that a set of momenta gives."""
    return [by_momentum(measured, names[0]), by_path(measured, options, names[1])]


def _by_invariant_set(prepared: Prepared, options: PathOptions) -> list[NamedBound]:
    """Bounds through the set that contains the torques and is invariant under free motion."""
    problem = prepared.problem
    momenta = invariant_set(problem.body, problem.norm)
    names = ("momentum in the invariant set", "invariant set")
    result = _momentum_and_path(prepared.measured(momenta), options, names)
    if problem.norm.is_cube and options.components:
        result += _by_components(problem, momenta, options, max(bound.exact for bound in result))
    return result


def _by_components(
    problem: TransferProblem, momenta: GaugeSet, options: PathOptions, known: Fraction
) -> list[NamedBound]:
    """Bound from components, at a trial peak a little above the bound known."""
    windows = WindowTravel(problem.window)
    if windows.total == 0 or known <= 0:
        return []
    splits, trial = Splits(problem, momenta), float(known) * options.trial
    split = splits.at_rest(windows.instant(windows.total / 2))
    bounds = component_bounds(momenta, split.sides, trial)
    if not problem.starts_at_rest:
        moving = splits.promising(bounds, options.share, float(known))
        if moving is None:
            return []
        split, bounds = moving, component_bounds(momenta, moving.sides, trial)
    beta = box_for(split.sides.components(bounds.rates, trial), options.share)
    if problem.starts_at_rest and all(b >= r for b, r in zip(beta, bounds.widths, strict=True)):
        return []
    path = path_of(problem, split.coast.attitude, momenta.with_box(beta), options)
    peak, bounds = _largest_peak(momenta, split, beta, rounded_down(path.travel - split.slack), bounds)
    name = "components" if problem.starts_at_rest else "components after a coast"
    argument = ComponentsArgument(momenta, path, beta, bounds, split.coast, splits.end)
    return [NamedBound(name, Fraction(peak), argument)]


def _largest_peak(
    momenta: GaugeSet, split: Split, beta: Widths, travel: float, bounds: ComponentBounds
) -> tuple[float, ComponentBounds]:
    """Largest peak found for a travel: any trial at or above it is valid, the nearest is the sharpest."""
    best, box = (0.0, bounds), np.array([float(b) for b in beta])
    for _ in range(6):
        peak = peak_from_components(split.sides, bounds, beta, travel)
        if peak > best[0]:
            best = peak, bounds
        allowed = split.sides.allowed(bounds.trial, bounds.rates, box)
        near = bounds.trial * travel / allowed if allowed else 0.0  # were all in proportion
        if near <= 0 or best[0] < bounds.trial < best[0] * 1.002:
            break
        bounds = component_bounds(momenta, split.sides, near * 1.001)
    return best
