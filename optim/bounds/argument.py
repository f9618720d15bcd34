"""A lower bound and the argument that it comes from: all that its certificate has to write down."""

from __future__ import annotations

from dataclasses import dataclass, field
from fractions import Fraction
from typing import final

from ...verify.exact.rounding import rounded_down
from .potential.path import PathBound
from .prepare import Measured
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
    measured : Measured
        Set whose gauge measures momentum, and the sizes of the transfer's ends.
    """

    measured: Measured

    @property
    def momenta(self) -> MomentumSet:
        """The set."""
        return self.measured.momenta


@final
@dataclass(frozen=True)
class AxisArgument:
    """A component of the momentum that free motion conserves has to be absorbed.

    Attributes
    ----------
    measured : Measured
        The transfer.
    axis : int
        0, 1 or 2: an axis about which the body is symmetric.
    """

    measured: Measured
    axis: int

    @property
    def momenta(self) -> MomentumSet:
        """The set in which the transfer is measured."""
        return self.measured.momenta


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
    measured : Measured
        Set whose gauge measures momentum, and the sizes of the transfer's ends.
    path : PathBound
        Travel to each quaternion of the target, from where the coast leads.
    departure : StartSet
        The coast, and how far torque can take the body from it.
    instant : Fraction
        Until when momentum is counted from the start, and after it from the end, s.
    """

    measured: Measured
    path: PathBound
    departure: StartSet
    instant: Fraction

    @property
    def momenta(self) -> MomentumSet:
        """The set."""
        return self.measured.momenta


@final
@dataclass(frozen=True)
class ComponentsArgument:
    """The same with each component of the momentum bounded by itself.

    Attributes
    ----------
    measured : Measured
        The invariant set, and the sizes of the transfer's ends.
    path : PathBound
        Travel in the gauge of its part within the box.
    box : three Fraction
        Half widths beta of that part.
    bounds : ComponentBounds
        Bounds of the components, valid up to the trial peak.
    coast : Coast
        From the start to where the transfer is split; at rest the start itself.
    end : Fraction
        Upper bound of the gauge and of each component of the momentum at the end.
    """

    measured: Measured
    path: PathBound
    box: Widths
    bounds: ComponentBounds
    coast: Coast
    end: Fraction

    @property
    def momenta(self) -> MomentumSet:
        """The set."""
        return self.measured.momenta


@final
@dataclass(frozen=True)
class BrakingArgument:
    """The way to the target is too long for what a smaller peak allows beside a coast that slows down.

    Attributes
    ----------
    measured : Measured
        Set whose gauge measures momentum, a ball, and the sizes of the transfer's ends.
    path : PathBound
        Travel to each quaternion of the target, from where the coast leads.
    coast : Coast
        From the start, for the integral of the shares.
    shares : tuple of Fraction
        Of the start's momentum, one for each cell.
    growth : Fraction
        mu, 1/s.
    slack : Fraction
        Upper bound of the travel between the coast's end and the attitude written down.
    """

    measured: Measured
    path: PathBound
    coast: Coast
    shares: tuple[Fraction, ...]
    growth: Fraction
    slack: Fraction

    @property
    def momenta(self) -> MomentumSet:
        """The ball."""
        return self.measured.momenta


Argument = MomentumArgument | AxisArgument | PathArgument | BrakingArgument | ComponentsArgument


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
