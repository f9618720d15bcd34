"""Which argument a lower bound comes from: what its certificate has to write down."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from .potential.path import PathBound
from .sets.momentum_sets import MomentumSet
from .windows.coast import Coast
from .windows.components import ComponentBounds, Widths
from .windows.deviation import Growth


@final
@dataclass(frozen=True)
class MomentumArgument:
    """The momentum has to be absorbed.

    Attributes
    ----------
    momenta : MomentumSet
        Set whose gauge measures momentum.
    """

    momenta: MomentumSet


@final
@dataclass(frozen=True)
class StartSet:
    """Where a path is counted from.

    Attributes
    ----------
    coast : Coast
        Free motion from the start; of no length: the start itself.
    growth : Growth
        What makes a deviation from it grow.
    deviation : Fraction
        Upper bound of the travel from where the coast leads to the attitude, per unit of the peak, s^2.
    slack : Fraction
        Upper bound of the travel between the attitude reached by the coast and the one written down.
    """

    coast: Coast
    growth: Growth
    deviation: Fraction
    slack: Fraction


@final
@dataclass(frozen=True)
class PathArgument:
    """The way to the target takes more travel than a smaller peak allows.

    Attributes
    ----------
    momenta : MomentumSet
        Set whose gauge measures momentum.
    path : PathBound
        Travel to each quaternion of the target, from where the coast leads.
    departure : Departure
        The coast, and how far torque can take the body from it.
    """

    momenta: MomentumSet
    path: PathBound
    departure: StartSet


@final
@dataclass(frozen=True)
class ComponentsArgument:
    """The same with each component of the momentum bounded by itself.

    Attributes
    ----------
    momenta : MomentumSet
        The invariant set.
    path : PathBound
        Travel in the gauge of its part within the box.
    box : three Fraction
        Half widths beta of that part.
    bounds : ComponentBounds
        Bounds of the components, valid up to the trial peak.
    instant : Fraction
        Where the transfer is split, s.
    """

    momenta: MomentumSet
    path: PathBound
    box: Widths
    bounds: ComponentBounds
    instant: Fraction


Argument = MomentumArgument | PathArgument | ComponentsArgument
