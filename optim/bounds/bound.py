"""The door: a certified lower bound of the peak torque of a transfer, with its name.

Every number is a theorem about every controller whatever: no torque history within p w(t) with a
smaller p takes the start to the target. Several bounds are valid at once; the largest is printed.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from ..problem import TransferProblem
from .argument import NamedBound
from .by_braking import by_braking
from .by_components import by_components
from .potential.path import PathOptions
from .prepare import Measured, Prepared
from .proof import by_axes, by_momentum, by_path
from .sets.gauge import invariant_set, longest_vertex
from .sets.momentum_sets import UnitBall


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
        bounds = _in_ball(
            prepared.measured(ball), options, ("momentum", "shortest path", "path and momentum")
        )
    else:
        # The invariant set lies in the ball of the longest torque: little is lost by a coarse potential here.
        within = prepared.measured(ball, longest_vertex(problem.norm))
        names = ("Euclidean momentum", "Euclidean shortest path", "Euclidean path and momentum")
        bounds = _in_ball(within, options.coarse(), names)
        bounds += _by_invariant_set(prepared, options)
    ordered = tuple(sorted(bounds, key=lambda bound: -bound.exact))
    return LowerBound(ordered[0], ordered, problem.norm.unit)


def _in_ball(measured: Measured, options: PathOptions, names: tuple[str, str, str]) -> list[NamedBound]:
    """Bounds that the ball gives, each by itself and together."""
    bounds = _momentum_and_path(measured, options, names[:2])
    both = by_braking(measured, options, max(bound.exact for bound in bounds), names[2])
    return bounds if both is None else [*bounds, both]


def _momentum_and_path(measured: Measured, options: PathOptions, names: tuple[str, str]) -> list[NamedBound]:
    """Both bounds that a set of momenta gives."""
    return [by_momentum(measured, names[0]), by_path(measured, options, names[1])]


def _by_invariant_set(prepared: Prepared, options: PathOptions) -> list[NamedBound]:
    """Bounds through the set that contains the torques and is invariant under free motion."""
    norm = prepared.problem.norm
    measured = prepared.measured(invariant_set(prepared.problem.body, norm))
    names = ("momentum in the invariant set", "invariant set")
    result = [*_momentum_and_path(measured, options, names), *by_axes(measured)]
    if norm.is_cube and options.components:
        found = by_components(measured, options, max(bound.exact for bound in result))
        result += [] if found is None else [found]
    return result
