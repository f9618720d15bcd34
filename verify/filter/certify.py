"""Certify the floor of the filter state over an initial set: transient, tail, and bins.

The answer is a list of flowpipes, one a bin of the initial set, each true as it stands.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, field, replace
from fractions import Fraction
from functools import cached_property
from heapq import heapify, heappop, heappush
from itertools import count
from math import ceil, inf
from typing import final

from ...models.laws import Law
from ...models.schedule import Schedule
from ..flow.stepping import CannotProceedError, ComparisonSystem, Step, Stepper
from ..schedule.zero_runs import longest_zero_run
from .comparison import BodyBounds
from .flowpipe import Flowpipe
from .known_proofs import system_of
from .law_system import LawSystem
from .recognise import NoComparisonError
from .sets import InitialSet
from .tail import MAX_RATIO, Tail, find_tail

ATTITUDE_BOUND_NEARLY_LOST = 1.9
"""Above this S = 1 - b0 (308 deg) a flowpipe that got stuck is taken to have lost the error angle."""
MIN_DECAY_EXPONENT = 8
"""Periods are followed until lambda t reaches this, if need be."""
WINDOW_BUDGET = 240
"""Bins times windows of a table or a period."""


HOPELESS_EXPONENT = 30
"""Where R decays by more than exp of minus this between two windows, the initial set is not split."""
MAX_PERIOD_WINDOWS = 100
"""Windows a period may have; of longer ones only this many are certified, and no tail is looked for."""


@final
@dataclass(frozen=True)
class FloorOptions:
    """How hard to try.

    Attributes
    ----------
    degree : degree of the flowpipe's polynomials
    slack : relative slack of the inequalities, traded against the number of steps
    max_bins : bins of the initial set, for a system that gains by them
    max_periods : periods after which no tail is looked for any more; up to ten times as many where
        lambda times the period is small
    settling_moves : how often the bin that settles last is refined (see `sooner`)
    """

    degree: int = 9
    slack: float = 2e-4
    max_bins: int = 24
    max_periods: int = 40
    settling_moves: int = 12

    def __post_init__(self) -> None:
        if not 2 <= self.degree <= 12:
            raise ValueError(f"degree must lie between 2 and 12, received {self.degree}")
        if not 0 < self.slack < 0.1:
            raise ValueError(f"slack must lie between 0 and 0.1, received {self.slack}")
        if self.max_bins < 1 or self.max_periods < 1 or self.settling_moves < 0:
            raise ValueError("max_bins and max_periods must be at least 1, settling_moves at least 0")


@final
@dataclass(frozen=True)
class FilterLowerBound:
    """A certified floor of R and everything that follows from its flowpipes.

    Attributes
    ----------
    law, bounds, schedule, initial : what it speaks about
    flowpipes : one a bin; together they cover `initial`
    horizon : end of the time covered, s, or None for all time
    """

    law: Law
    bounds: BodyBounds
    schedule: Schedule
    initial: InitialSet
    flowpipes: tuple[Flowpipe, ...]
    horizon: Fraction | None

    @property
    def system(self) -> LawSystem:
        """The law's comparison system."""
        system = self.flowpipes[0].system
        assert isinstance(system, LawSystem)
        return system

    @cached_property
    def value(self) -> float:
        """R >= value, s, over the time covered, for every trajectory from the initial set."""
        return min(w.floor for w in self.flowpipes)

    @property
    def steps(self) -> int:
        """Number of proved steps."""
        return sum(sum(1 for _ in w.all_steps()) for w in self.flowpipes)

    @property
    def lost_angle(self) -> bool:
        """Whether it got stuck because a bound of the error angle reached 2 pi."""
        lost = [w for w in self.flowpipes if w.failed_at is not None]
        gaps = [w.boxes[-1].cosine_gap if w.steps else w.initial.s_high**2 for w in lost]
        return max(gaps, default=0.0) > ATTITUDE_BOUND_NEARLY_LOST

    @property
    def failed_at(self) -> Fraction | None:
        """Earliest instant from which nothing could be proved, s, or None."""
        return min((w.failed_at for w in self.flowpipes if w.failed_at is not None), default=None)


def comparison_system(law: Law, bounds: BodyBounds) -> LawSystem | None:
    """Return the comparison system of a law, or None for laws that have none.

    It rests on the law's equations, compared as polynomials (see `system_of`), and on no name or class.
    None too for parameters the inequalities do not cover: lambda, R(0), gamma or a <= 0, k(0) < 0.
    """
    try:
        return system_of(law, bounds)
    except NoComparisonError:
        return None


def idle_exponent(law: Law, schedule: Schedule) -> float:
    """Lambda times the longest stretch without thrust: R decays by exp of minus it."""
    gap = longest_zero_run(schedule)
    decay = law.parameters.get("lambda", Fraction(0))
    return 0.0 if gap is None else float(decay * (gap.off - gap.on))


def certify_floor(
    law: Law,
    bounds: BodyBounds,
    schedule: Schedule,
    initial: InitialSet,
    *,
    horizon: Fraction | None = None,
    options: FloorOptions | None = None,
) -> FilterLowerBound | None:
    """Certify R >= value > 0 over the initial set, or return None for a law without comparison system.

    Parameters
    ----------
    law : Law
        The law; one without a comparison system gives None.
    bounds : BodyBounds
        Principal inertias of every body that the claim covers, kg m^2.
    schedule : Schedule
        Its windows; g must be continuous.
    initial : InitialSet
        Set of starts that the claim covers.
    horizon : Fraction or None
        End of the time asked for, s; None asks for all time (periodic schedules only). A periodic schedule is
        also certified for all time where a tail is found.
    options : FloorOptions, optional
        How hard to try; its defaults without one.

    Returns
    -------
    Floor
        Its `failed_at` tells where nothing could be proved any more, if anywhere; its `horizon`, how
        far the certificate reaches.

    Raises
    ------
    ValueError
        If g jumps: the laws use g', and Omega = w + 2 g^2 kappa bv would jump with g.
    """
    jump = _first_jump(schedule)
    if jump is not None:
        raise ValueError(f"g jumps at {float(jump):g} s: no floor of R can be certified")
    options = options or FloorOptions()
    system = comparison_system(law, bounds)
    if system is None:
        return None
    if idle_exponent(law, schedule) > HOPELESS_EXPONENT:
        options = replace(options, max_bins=1)
    if horizon is None and schedule.period is None:
        horizon = schedule.end
    run = FloorProof(system, schedule, horizon, options)
    if system.is_binned:
        flowpipes = run.binned(initial, bounds)
    else:
        flowpipes = (run.complete(Flowpipe(system, initial, ())),)
    ends = [w.failed_at if w.failed_at is not None else w.end for w in flowpipes if w.tail is None]
    reached = min(ends, default=None)
    return FilterLowerBound(law, bounds, schedule, initial, flowpipes, reached)


def _first_jump(schedule: Schedule) -> Fraction | None:
    """Instant at which g jumps, to zero at the end of a table too; None if it is continuous."""
    shapes, zero = schedule.profile.shapes, Fraction(0)
    ends = {shape: sum(shape, zero) for shape in dict.fromkeys(shapes)}
    after = (*shapes[1:], shapes[0] if schedule.is_periodic else ())
    for shape, following, knot in zip(shapes, after, schedule.profile.knots[1:], strict=True):
        if ends[shape] != (following[0] if following else zero):
            return knot
    return None


@final
@dataclass(frozen=True)
class FloorProof:
    """How flowpipes are made for one system and schedule; step sizes carry over from one to the next."""

    system: LawSystem
    schedule: Schedule
    horizon: Fraction | None
    options: FloorOptions

    _known: list[Stepper] = field(default_factory=list)

    def _stepper(self, system: ComparisonSystem | None = None) -> Stepper:
        """Return a stepper that starts from the step sizes the last one of the main system found."""
        stepper = Stepper(system or self.system, degree=self.options.degree, slack=self.options.slack)
        if self._known:
            stepper.remember(self._known[-1])
        if system is None:
            self._known[:] = [stepper]
        return stepper

    def complete(self, early: Flowpipe, not_before: Fraction = Fraction(0)) -> Flowpipe:
        """Go on from an early flowpipe to the horizon, or to a tail as soon as that costs nothing.

        `not_before` is the earliest start of the tail, s: a later one decays faster.
        """
        if early.failed_at is not None:
            return early
        steps, least = list(early.steps), early.floor
        period, stepper = self.schedule.period, self._stepper()
        for start, stop in self._spans(early.end):
            state = steps[-1].end_state() if steps else None
            values = self.system.start(early.initial) if state is None else tuple(state.values())
            try:
                steps += stepper.run(self.schedule, start, stop, values)
            except CannotProceedError as failure:
                return Flowpipe(self.system, early.initial, (*steps, *failure.steps), failed_at=failure.time)
            if period is None or stop % period != 0 or stop < not_before:
                continue
            least = min(least, *(_floor_of(self.system, s) for s in steps if s.start >= start))
            state = steps[-1].end_state()
            before = next((s.end_state() for s in steps if s.stop == stop - period), None)
            tail = self._tail(stop, state, before) if before is not None else None
            if tail is not None:
                lowest = min(_floor_of(self.system, s) for s in tail.steps)
                if lowest >= 0.999 * least or stop >= self._max_periods * period:
                    return Flowpipe(self.system, early.initial, tuple(steps), tail)
        return Flowpipe(self.system, early.initial, tuple(steps))

    def _tail(self, start: Fraction, state: Mapping[str, float], before: Mapping[str, float]) -> Tail | None:
        """Look for a tail if the last period already shrank what must shrink; `before` is its start."""
        system, first = self.system.tail(tuple(state.values()))
        names = [name for group in system.decaying for name in group]
        if any(state[name] > MAX_RATIO * before[name] for name in names):
            return None
        return find_tail(system, self.schedule, start, first, self._stepper(system))

    def _spans(self, start: Fraction) -> list[tuple[Fraction, Fraction]]:
        """From `start` on: to the end of each period, or at once to a finite schedule's horizon."""
        period = self.schedule.period
        if period is None:
            assert self.horizon is not None
            return [(start, self.horizon)] if start < self.horizon else []
        if len(self.schedule.windows) > MAX_PERIOD_WINDOWS:
            stop = self.schedule.windows[MAX_PERIOD_WINDOWS].on
            return [(start, stop)] if start < stop else []
        first = start // period + 1
        ends = [n * period for n in range(first, max(first, self._max_periods) + 1)]
        return list(zip([start, *ends[:-1]], ends, strict=True))

    def early(self, initial: InitialSet, stop: Fraction) -> Flowpipe:
        """Return a flowpipe over [0, stop]."""
        try:
            steps = self._stepper().run(self.schedule, Fraction(0), stop, self.system.start(initial))
        except CannotProceedError as failure:
            return Flowpipe(self.system, initial, failure.steps, failed_at=failure.time)
        return Flowpipe(self.system, initial, tuple(steps))

    def binned(self, initial: InitialSet, bounds: BodyBounds) -> tuple[Flowpipe, ...]:
        """Halve the worst bin again and again: most by the floor of the first windows, then by all."""
        stop = self.early_end
        weight = self.weight(bounds)
        most = 1 + 3 * (self._max_bins - 1) // 4
        first = self._halve([self.early(initial, stop)], weight, most, lambda b: self.early(b, stop))
        return tuple(
            self._halve(
                [self.complete(w) for w in first],
                weight,
                self._max_bins,
                lambda b: self.complete(self.early(b, stop)),
            )
        )

    @property
    def _max_periods(self) -> int:
        """Periods enough for the rate's push to fade: s may grow for some 2/lambda before it shrinks."""
        assert self.schedule.period is not None
        asked, loss = self.options.max_periods, self.system.decay * self.schedule.period
        return max(asked, min(10 * asked, ceil(MIN_DECAY_EXPONENT / loss))) if loss > 0 else asked

    @property
    def _max_bins(self) -> int:
        """Bins, fewer for long tables: the work is bins times windows."""
        windows = min(len(self.schedule.windows), MAX_PERIOD_WINDOWS)
        if self.schedule.period is None and self.horizon is not None:
            windows = sum(1 for _ in self.schedule.windows_between(Fraction(0), self.horizon))
        return max(1, min(self.options.max_bins, WINDOW_BUDGET // max(windows, 1)))

    @staticmethod
    def _halve(
        flowpipes: list[Flowpipe], weight: float, most: int, prove: Callable[[InitialSet], Flowpipe]
    ) -> list[Flowpipe]:
        order = count()
        heap = [(_merit(w), next(order), w) for w in flowpipes]
        heapify(heap)
        while len(heap) < most:
            halves = halved(heap[0][2].initial, weight)
            if len(halves) == 1:
                break
            heappop(heap)
            for half in halves:
                flowpipe = prove(half)
                heappush(heap, (_merit(flowpipe), next(order), flowpipe))
        return [w for _, _, w in sorted(heap)]

    def weight(self, bounds: BodyBounds) -> float:
        """Width of the angle that a width of the rate counts for when a bin is halved."""
        return bounds.coupling * float(self.early_end) / 4

    @cached_property
    def early_end(self) -> Fraction:
        """End of the third window's rise: the least R is mostly seen by then."""
        span = self.schedule.end * (1 if self.schedule.period is None else 4)
        openings = [w.on for w in self.schedule.support_between(Fraction(0), span)][:3]
        rise = next(p for p in self.schedule.pieces_between(openings[-1], span) if p.start == openings[-1])
        return rise.end if self.horizon is None else min(rise.end, self.horizon)


def _floor_of(system: LawSystem, step: Step) -> float:
    """Least Bernstein coefficient of the filter's floor on a step; inf of a law without filter."""
    return inf if system.floor_component is None else min(step.controls[system.floor_component])


def _merit(flowpipe: Flowpipe) -> float:
    """Floor of an early flowpipe; where it got stuck, the earlier the worse."""
    return flowpipe.floor if flowpipe.failed_at is None else float(flowpipe.failed_at) * 1e-9


def halved(initial: InitialSet, weight: float) -> list[InitialSet]:
    """Two halves across the wider of the angle and `weight` times the rate; one if it is a point."""
    ds, dy = initial.s_high - initial.s_low, initial.y_high - initial.y_low
    if max(ds, weight * dy) < 1e-6:
        return [initial]
    if ds >= weight * dy:
        middle = (initial.s_low + initial.s_high) / 2
        edges = [(initial.s_low, middle), (middle, initial.s_high)]
        return [InitialSet(a, b, initial.y_low, initial.y_high, initial.description) for a, b in edges]
    middle = (initial.y_low + initial.y_high) / 2
    edges = [(initial.y_low, middle), (middle, initial.y_high)]
    return [InitialSet(initial.s_low, initial.s_high, a, b, initial.description) for a, b in edges]
