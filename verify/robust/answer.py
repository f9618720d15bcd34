"""The robust question of a scenario: a flowpipe for each bin of bodies, and what follows from all of them."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import cached_property, partial
from typing import final

from ...models.laws import Law
from ...models.mission import Mission
from ...models.uncertainty import Uncertainty
from ..exact.ball import sqrt_above
from ..filter.certify import FloorOptions
from ..filter.comparison import BodyBounds
from ..filter.flowpipe import Flowpipe
from ..filter.recognise import ComparedLaw, compared_law
from ..filter.sets import InitialSet
from .adaptive import RobustAdaptiveSystem
from .bodies import BodyBin, body_bins
from .certify import OPTIONS, robust_flowpipe
from .constants import root_above
from .persistence import RobustPersistenceSystem
from .system import RobustSystem

MAX_BINS = 8
"""Bins of the initial set's error angle for a law that learns."""
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
    def grows(self) -> bool:
        """Whether a disturbance keeps a gain growing that the law learns."""
        return self.known.adaptive and self.question.mission.uncertainty.disturbance > 0

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
    schedule = q.mission.schedule
    g = next(schedule.profile.pieces).shape
    gain = known.initial_gain if known.adaptive else 1 / known.initial_filter
    gain_term = (g[0] if g else Fraction(0)) ** 2 * gain
    grows = known.adaptive and q.mission.uncertainty.disturbance > 0
    horizon = q.mission.horizon if grows and schedule.period is not None else q.horizon
    found: RobustFloor | None = None
    for count in SCALE_BINS:
        parts: list[tuple[BodyBin, Flowpipe]] = []
        bodies = list(body_bins(q.mission.body, q.mission.uncertainty, count))
        for part in bodies:
            system, initial = _system(known, part), q.initial(part, gain_term)
            prove = partial(robust_flowpipe, system, schedule, horizon=horizon, options=q.options)
            pipes = binned(prove, initial) if system.is_binned else [prove(initial)]
            parts += [(part, pipe) for pipe in pipes]
        ends = [p.failed_at if p.failed_at is not None else p.end for _, p in parts if p.tail is None]
        found = RobustFloor(q, known, tuple(parts), min(ends, default=None))
        if found.failed_at is None or len(bodies) < count:
            break
    assert found is not None
    return found


def binned(prove: Callable[[InitialSet], Flowpipe], initial: InitialSet) -> list[Flowpipe]:
    """Halve the set in the error angle where it is worst: first what fails, then the lowest floor."""
    pipes = [prove(initial)]
    while len(pipes) < MAX_BINS:
        worst = min(pipes, key=lambda p: (p.failed_at is None, float(p.failed_at or 0), p.floor))
        i = worst.initial
        middle = (i.s_low + i.s_high) / 2
        if not i.s_low < middle < i.s_high:
            break
        pipes.remove(worst)
        pipes += [
            prove(InitialSet(a, b, i.y_low, i.y_high, i.description))
            for a, b in ((i.s_low, middle), (middle, i.s_high))
        ]
    return pipes


def _system(known: ComparedLaw, part: BodyBin) -> RobustSystem:
    lam, R0, constants, push = known.decay, known.initial_filter, part.constants, part.push
    if not known.adaptive:
        return RobustPersistenceSystem(decay=lam, initial_filter=R0, constants=constants, push=push)
    return RobustAdaptiveSystem(
        decay=lam,
        initial_filter=R0,
        learning_rate=known.learning_rate,
        weight=known.weight,
        initial_gain=known.initial_gain,
        constants=constants,
        push=push,
    )
