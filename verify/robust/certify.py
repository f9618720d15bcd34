"""Flowpipes of a robust system: period by period, then a part that repeats, with the pairs that decay."""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from math import ceil

from ...models.schedule import Schedule
from ..filter.certify import MIN_DECAY_EXPONENT, FloorOptions
from ..filter.flowpipe import Flowpipe
from ..filter.sets import InitialSet
from ..filter.tail import Tail, find_tail
from ..flow.stepping import CannotProceedError, Stepper
from .system import RobustSystem

OPTIONS = FloorOptions(degree=6, slack=3e-4)
FINEST = 64
"""A piece of the schedule is cut into at most this many steps: a bound that needs more is on its way out."""
SETTLING_PERIODS, PUSHED_PERIODS = 3, 6
"""Periods that pass before the repeating part, without and with a disturbance: each sharpens it."""


def robust_flowpipe(
    system: RobustSystem,
    schedule: Schedule,
    initial: InitialSet,
    *,
    horizon: Fraction | None = None,
    options: FloorOptions = OPTIONS,
) -> Flowpipe:
    """Prove bounds of every trajectory of the set, for all time where a repeating part is found.

    Parameters
    ----------
    system : RobustSystem
        The loop on every body, as inequalities.
    schedule : Schedule
        Its windows.
    initial : InitialSet
        Set of starts that is covered.
    horizon : Fraction, optional
        End of the time asked for, s; None asks for all time, of a periodic schedule.
    options : FloorOptions
        How hard to try.

    Returns
    -------
    Flowpipe
        Its `failed_at` is the instant from which nothing could be proved, if any.
    """
    stepper = Stepper(system, degree=options.degree, slack=options.slack, finest=FINEST)
    steps, state, start = [], system.start(initial), Fraction(0)
    for stop in _stops(schedule, system, horizon, options):
        before = state
        try:
            steps += stepper.run(schedule, start, stop, state)
        except CannotProceedError as failure:
            return Flowpipe(system, initial, (*steps, *failure.steps), failed_at=failure.time)
        state, start = tuple(steps[-1].end_state().values()), stop
        least = PUSHED_PERIODS if system.push else SETTLING_PERIODS
        if schedule.period is None or stop < least * schedule.period:
            continue
        tail = _tail(system, schedule, stop, state, before, stepper)
        if tail is not None:
            return Flowpipe(system, initial, tuple(steps), tail)
    return Flowpipe(system, initial, tuple(steps))


def _stops(
    schedule: Schedule, system: RobustSystem, horizon: Fraction | None, options: FloorOptions
) -> Iterator[Fraction]:
    period = schedule.period
    if period is None:
        yield min(schedule.end, horizon) if horizon is not None else schedule.end
        return
    most = max(options.max_periods, ceil(MIN_DECAY_EXPONENT / (system.decay * period)))
    for n in range(1, most + 1):
        if horizon is not None and n * period >= horizon:
            yield horizon
            return
        yield n * period


def _tail(
    system: RobustSystem,
    schedule: Schedule,
    start: Fraction,
    state: tuple[float, ...],
    before: tuple[float, ...],
    stepper: Stepper,
) -> Tail | None:
    """Try what may repeat from here, in the system's order."""
    first = dict(zip(system.names, before, strict=True))
    last = dict(zip(system.names, state, strict=True))
    for trial in system.repetitions(last, first):
        follow = Stepper(trial.system, degree=stepper.degree, slack=stepper.slack, finest=FINEST)
        follow.remember(stepper)
        tail = find_tail(trial.system, schedule, start, trial.state, follow)
        if tail is not None and trial.accepts(tail):
            return tail
    return None
