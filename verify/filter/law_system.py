"""A law's comparison system as one file states it: inequalities once, and what follows from the bounds."""

from __future__ import annotations

from abc import abstractmethod
from collections.abc import Mapping, Sequence

import numpy as np

from ...models.closed_loop import ClosedLoop
from ...models.laws import Expression
from ...models.types import Array
from ..checker import Part
from ..flow.inequalities import StatedSystem
from .boxes import BoxColumns, Interval, summed
from .flowpipe import LawComparison
from .sets import InitialSet
from .tail import PeriodicSystem


class LawSystem(StatedSystem, LawComparison):
    """The comparison system of one law with Omega = w + 2 g^2 kappa bv.

    A subclass states `names`, `signs` and `decaying`; the inequalities (`slopes`, `signs_of`); where they
    start (`start`), what repeats (`tail`), and what is read off them (`measures`, `bounds`, `torque_terms`).

    Attributes
    ----------
    is_binned : whether splitting the initial set makes the bounds sharper
    why_it_converges : the argument behind a decay, in one sentence, for the claim
    system_name : what the stand-alone checker calls the system; empty for its own, which it finds by itself
    part : the checker's part that proves the system's certificates, for a system from outside
    coupling : c >= 1/sqrt(8 Jmin), as `BodyBounds.coupling`
    """

    is_binned: bool = False
    why_it_converges: str = ""
    system_name: str = ""
    part: Part | None = None
    coupling: float

    @abstractmethod
    def tail(self, state: Sequence[float]) -> tuple[PeriodicSystem, tuple[float, ...]]:
        """Return the system and the starting values to try for a periodic tail from this state."""

    @abstractmethod
    def measures(self, loop: ClosedLoop) -> Mapping[str, Expression]:
        """What each component bounds, as an expression in the loop's state, g and signals."""

    @abstractmethod
    def torque_terms(self, c: BoxColumns) -> tuple[list[Interval], Array]:
        """Return intervals that add up to -2 g kappa' + 2 g^3 kappa^2 b0, and a bound of d >= 0.

        d stands before J Omega in the law: u = ... - d J Omega (see `torque_bound`).
        """

    def coefficient(self, c: BoxColumns) -> Interval:
        """Bounds of q = -4 g' kappa - 2 g kappa' + 2 g^3 kappa^2 b0, which stands before J bv in the law.

        Term by term; a system whose terms cancel may know better.
        """
        terms, _ = self.torque_terms(c)
        slope = [-4 * s * k for s in (c.slope_low, c.slope_high) for k in (c.low, c.high)]
        return summed([(np.minimum.reduce(slope), np.maximum.reduce(slope)), *terms])

    def why_stuck(self, initial: InitialSet) -> tuple[str, str] | None:
        """Reason and remedy where the law itself tells why nothing was proved for all time."""
        del initial
        return None
