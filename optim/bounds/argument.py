"""Which argument a lower bound comes from: what its certificate has to write down."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from .components import ComponentBounds, Widths
from .momentum_sets import MomentumSet
from .path import PathBound


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
class PathArgument:
    """The way to the target takes more travel than a smaller peak allows.

    Attributes
    ----------
    momenta : MomentumSet
        Set whose gauge measures momentum.
    path : PathBound
        Travel to each quaternion of the target.
    """

    momenta: MomentumSet
    path: PathBound


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
