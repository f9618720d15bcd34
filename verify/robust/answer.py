"""The robust question of a scenario: a flowpipe for each bin of bodies, and what follows from all of them."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property
from typing import final

from ...models.laws import Law
from ...models.mission import Mission
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
    """What is asked: a law on every body of the mission's uncertainty, from every start of its set.

    Attributes
    ----------
    law, mission : the loop as the controller knows it, and what it does not know
    horizon : end of the time asked about, s, of a finite table; None is the table's end
    options : how hard to certify
    """

    law: Law
    mission: Mission
    horizon: Fraction | None = None
    options: FloorOptions = OPTIONS

    def about(self, uncertainty: Uncertainty) -> RobustQuestion:
        """The same question about another uncertainty."""
        return replace(self, mission=replace(self.mission, uncertainty=uncertainty))

    def initial(self, part: BodyBin, gain_term: Fraction) -> InitialSet:
        """The initial set in the variables of a bin: s and y = |x(0)|_J.

        x = Omega + Phi zeta, with zeta = 2 g^2 kappa bv at the start (`gain_term` is g^2 kappa there).
        """
        starts = self.mission.starts
        believed = InitialSet.from_bounds(
            BodyBounds.of(self.mission.body),
            max_angle_deg=starts.max_angle_deg,
            max_rate=starts.max_rate,
            max_weighted_rate=starts.max_weighted_rate,
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
    schedule = q.mission.schedule
    piece = next(schedule.profile.pieces)
    g = piece.shape[0] if piece.shape else Fraction(0)
    gain_term = g * g / known.initial_filter
    found: RobustFloor | None = None
    for count in SCALE_BINS:
        parts = []
        for part in body_bins(q.mission.body, q.mission.uncertainty, count):
            system = RobustPersistenceSystem(
                decay=known.decay,
                initial_filter=known.initial_filter,
                constants=part.constants,
                push=part.push,
            )
            initial = q.initial(part, gain_term)
            pipe = robust_flowpipe(system, schedule, initial, horizon=q.horizon, options=q.options)
            parts.append((part, pipe))
        ends = [p.failed_at if p.failed_at is not None else p.end for _, p in parts if p.tail is None]
        found = RobustFloor(q, known, tuple(parts), min(ends, default=None))
        if found.failed_at is None or len(parts) < count:
            break
    assert found is not None
    return found
