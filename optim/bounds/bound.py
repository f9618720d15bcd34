"""The door: a certified lower bound of the peak torque of a transfer, with its name.

Every number is a theorem about every controller whatever: no torque history within p w(t) with a
smaller p takes the start to the target. Several bounds are valid at once; the largest is printed.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ..problem import TransferProblem
from .argument import ComponentsArgument, NamedBound
from .potential.path import PathOptions
from .prepare import Measured, Prepared
from .proof import by_momentum, by_path, path_of
from .sets.gauge import GaugeSet, invariant_set, longest_vertex
from .sets.momentum_sets import UnitBall
from .windows.components import TransferSides, Widths, component_bounds, peak_from_components
from .windows.travel import WindowTravel

TRIALS = (1.0, 1.03, 1.07, 1.12, 1.18, 1.25, 1.35, 1.5, 1.75)
"""Trial peaks of the bound by components over the best other bound: any are valid, the best is kept."""


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
    component from rest to exact rest, components.
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
