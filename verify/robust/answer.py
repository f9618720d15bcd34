"""The robust question of a scenario: a flowpipe for each bin of bodies, and what follows from all of them."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import final

from ...models.laws import Law
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ...models.uncertainty import Uncertainty
from ..exact.ball import sqrt_above
from ..filter.certify import FloorOptions
from ..filter.comparison import BodyBounds
from ..filter.flowpipe import Flowpipe
from ..filter.recognise import ComparedLaw, NoComparisonError, compared_law, law_words
from ..filter.sets import InitialSet
from .bodies import BodyBin, body_bins
from .certify import OPTIONS, robust_flowpipe
from .constants import root_above
from .persistence import RobustPersistenceSystem

SCALE_BINS = (1, 2, 4)
"""Numbers of bins of the common factor that are tried in turn."""


@final
@dataclass(frozen=True, kw_only=True)
class RobustQuestion:
    """What is asked: a law that believes in `body`, on every body of the uncertainty, from every start.

    Attributes
    ----------
    law, body, schedule : the loop as the controller knows it
    uncertainty : what it does not know
    max_angle_deg : bound of 2 acos(b0), deg, of the initial set
    max_rate : bound of |w(0)|, rad/s, or None
    max_weighted_rate : bound of |Omega(0)| in the believed inertia, sqrt(kg m^2) rad/s; both None is at rest
    attitude, rate : tolerances of |bv| and |w| (rad/s) for the settling time
    horizon : end of the time asked about, s, of a finite table; None is the table's end
    """

    law: Law
    body: RigidBody
    schedule: Schedule
    uncertainty: Uncertainty
    max_angle_deg: Fraction
    max_rate: Fraction | None = None
    max_weighted_rate: Fraction | None = None
    attitude: Fraction = Fraction(1, 100)
    rate: Fraction = Fraction(1, 100)
    horizon: Fraction | None = None
    options: FloorOptions = OPTIONS

    def initial(self, part: BodyBin, gain_term: Fraction) -> InitialSet:
        """The initial set in the variables of a bin: s and y = |x(0)|_J.

        x = Omega + Phi zeta, with zeta = 2 g^2 kappa bv at the start (`gain_term` is g^2 kappa there).
        """
        believed = InitialSet.from_bounds(
            BodyBounds.of(self.body),
            max_angle_deg=self.max_angle_deg,
            max_rate=self.max_rate,
            max_weighted_rate=self.max_weighted_rate,
            gain_term=gain_term,
        )
        c = part.constants
        zeta = 2 * gain_term * min(Fraction(1), Fraction(believed.s_high) * Fraction(3, 2))
        reach = Fraction(believed.y_high) + root_above(c.inertia.hi) * c.mismatch * zeta
        y = sqrt_above(reach * reach * c.inertia.widening)
        return InitialSet(0.0, believed.s_high, 0.0, y, believed.description)


@final
@dataclass(frozen=True)
class RobustFloor:
    """Flowpipes that together cover every body and every start.

    Attributes
    ----------
    question : what was asked
    parts : a bin of bodies with its flowpipe, each
    horizon : end of the time covered, s, or None for all time
    """

    question: RobustQuestion
    known: ComparedLaw
    parts: tuple[tuple[BodyBin, Flowpipe], ...]
    horizon: Fraction | None

    @cached_property
    def value(self) -> float:
        """R >= value, s, over the time covered."""
        return min(pipe.floor for _, pipe in self.parts)

    @property
    def failed_at(self) -> Fraction | None:
        """Earliest instant from which nothing could be proved, s, or None."""
        return min((p.failed_at for _, p in self.parts if p.failed_at is not None), default=None)

    @property
    def repeats(self) -> bool:
        """Whether the bounds stand for all time."""
        return all(pipe.tail is not None for _, pipe in self.parts)


def certify_robust_floor(question: RobustQuestion) -> RobustFloor:
    """Certify R from below on every body of the uncertainty, with the fewest bins that reach all time.

    Raises
    ------
    NoComparisonError
        If the law's equations are not those of the family.
    ValueError
        If the uncertainty reaches a singular inertia.
    """
    q = question
    known = compared_law(q.law)
    if known.adaptive:
        raise NoComparisonError(
            f"{law_words(q.law)} learns its gain: for an unknown body only kappa = 1/R has its inequalities"
        )
    piece = next(q.schedule.profile.pieces)
    g = piece.shape[0] if piece.shape else Fraction(0)
    gain_term = g * g / known.initial_filter
    found: RobustFloor | None = None
    for count in SCALE_BINS:
        parts = []
        for part in body_bins(q.body, q.uncertainty, count):
            system = RobustPersistenceSystem(
                decay=known.decay,
                initial_filter=known.initial_filter,
                constants=part.constants,
                push=part.push,
            )
            initial = q.initial(part, gain_term)
            parts.append(
                (part, robust_flowpipe(system, q.schedule, initial, horizon=q.horizon, options=q.options))
            )
        ends = [p.failed_at if p.failed_at is not None else p.end for _, p in parts if p.tail is None]
        found = RobustFloor(q, known, tuple(parts), min(ends, default=None))
        if found.failed_at is None or len(parts) < count:
            break
    assert found is not None
    return found
