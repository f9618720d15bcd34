"""How peak, floor and settling depend on duty cycle and period; and the least on-time that suffices."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass, field, replace
from fractions import Fraction
from typing import final

from ..models.laws import Law
from ..models.mission import Mission
from ..models.norms import Norm
from ..models.schedule import Hermite, Shape, Window, build_schedule
from ..models.simulation import SimulationError
from ..models.types import Interrupted, Progress, silent
from .comparison.measure import run_law
from .tuning.front import BestPossible, best_possible

FloorOf = Callable[[Law, Mission], float | None]
"""Certified lower bound on the filter state R of a law on a mission, s; None where there is none."""


@final
@dataclass(frozen=True, eq=False)
class ScheduleCase:
    """One periodic schedule.

    Attributes
    ----------
    period, on_time : s
    floor : certified lower bound on R, s, or None
    settling : of the law, s, or None if it does not settle within the mission's horizon
    law_peak : peak applied torque of the law, N m, or None if its run failed
    best : optimum and bound for the mission's time
    """

    period: Fraction
    on_time: Fraction
    floor: float | None
    settling: float | None
    law_peak: float | None
    best: BestPossible

    @property
    def duty_cycle(self) -> float:
        """On-time per period."""
        return float(self.on_time / self.period)


@final
@dataclass(frozen=True, kw_only=True)
class ScheduleFamily:
    """Periodic schedules with one window a period.

    Attributes
    ----------
    opening : start of the window in the period, s
    shape : of g in the window
    """

    opening: Fraction = Fraction(1, 100)
    shape: Shape = field(default_factory=Hermite)

    def applied_to(self, mission: Mission, period: Fraction, on_time: Fraction) -> Mission:
        """The same work through another schedule.

        Raises
        ------
        ValueError
            If the window does not fit in the period.
        """
        window = Window(self.opening, self.opening + on_time)
        return replace(mission, schedule=build_schedule([window], self.shape, period=period))


def study_schedules(
    law: Law,
    mission: Mission,
    periods: Sequence[Fraction],
    duty_cycles: Sequence[Fraction],
    *,
    time: Fraction,
    norm: Norm,
    floor: FloorOf,
    family: ScheduleFamily | None = None,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> tuple[ScheduleCase, ...]:
    """Every period with every duty cycle, in that order; cases go to the executor's workers.

    Parameters
    ----------
    law : Law
        The law that is run through every schedule.
    mission : Mission
        Body, start and tolerances; its own schedule is replaced by each case's.
    periods : Sequence[Fraction]
        Periods, s, each > 0.
    duty_cycles : Sequence[Fraction]
        Window time over period, each in (0, 1).
    time : Fraction
        Transfer time of the optimum, s, the same for all cases.
    norm : str
        Of the torque, "component" or "euclidean".
    floor : FloorOf
        Certified floor of R, a function that can be pickled.
    family : ScheduleFamily, optional
        How a period and a duty cycle make a schedule; its defaults without one.
    executor : Executor, optional
        Workers that share the cases; None does them here.
    progress : Progress, optional
        Is told how many are done.

    Raises
    ------
    Interrupted
        With the cases so far, where the user interrupts.
    """
    family = family if family is not None else ScheduleFamily()
    jobs = [
        (law, family.applied_to(mission, period, duty * period), period, duty * period, time, norm, floor)
        for period in periods
        for duty in duty_cycles
    ]
    tell = progress if progress is not None else silent
    done: list[ScheduleCase] = []
    futures = None if executor is None else [executor.submit(study_case, *job) for job in jobs]
    try:
        for i, job in enumerate(jobs):
            tell(f"schedule {i + 1} of {len(jobs)}", i / len(jobs))
            done.append(study_case(*job) if futures is None else futures[i].result())
    except KeyboardInterrupt:
        ready = [f for f in (futures or [])[len(done) :] if f.done() and not f.cancelled()]
        done += [f.result() for f in ready if f.exception() is None]
        raise Interrupted(tuple(done), f"not finished: {len(jobs) - len(done)} schedules") from None
    return tuple(done)


def study_case(
    law: Law,
    mission: Mission,
    period: Fraction,
    on_time: Fraction,
    time: Fraction,
    norm: Norm,
    floor: FloorOf,
) -> ScheduleCase:
    """One case of the study."""
    settling, peak = None, None
    try:
        run = run_law(law.name, law, mission)
        settling, peak = run.figures.settling, run.peak(norm)
    except SimulationError:
        pass  # the case then has no run: its peak and settling stay None, and are shown so
    best = best_possible(mission, time, norm)
    return ScheduleCase(period, on_time, floor(law, mission), settling, peak, best)


@final
@dataclass(frozen=True, eq=False)
class LeastOnTime:
    """Answer to the inverse question for one period.

    Attributes
    ----------
    suffices : least on-time found for which all conditions hold, s, or None if none does
    fails : greatest on-time below it for which one does not, s (0 if the search met none)
    floor, optimum : at `suffices`
    limiting : the condition that fails at `fails`
    """

    period: Fraction
    suffices: Fraction | None
    fails: Fraction
    floor: float | None
    optimum: float | None
    limiting: str


def least_on_time(
    law: Law,
    mission: Mission,
    period: Fraction,
    *,
    torque_limit: Fraction,
    time: Fraction,
    norm: Norm,
    floor: FloorOf,
    family: ScheduleFamily | None = None,
    resolution: Fraction = Fraction(1, 100),
) -> LeastOnTime:
    """Bisect the on-time between failing and holding of: a certified floor of R, and optimum <= limit.

    More window never raises the optimum, so one threshold is what bisection finds for that
    condition; for the certified floor it finds a threshold, and both ends are evaluated.
    """
    family = family if family is not None else ScheduleFamily()
    low, high = Fraction(0), period - family.opening

    def verdict(on_time: Fraction) -> tuple[str, float | None, float | None]:
        candidate = family.applied_to(mission, period, on_time)
        bottom = floor(law, candidate)
        if bottom is None or bottom <= 0:
            return "no certified floor of R", bottom, None
        best = best_possible(candidate, time, norm).optimum
        if best is None:
            return "no checked optimum", bottom, None
        return ("" if best <= torque_limit else "optimum above the torque limit"), bottom, best

    limiting, bottom, best = verdict(high)
    if limiting:
        return LeastOnTime(period, None, high, bottom, best, limiting)
    while high - low > resolution:
        middle = _rounded((low + high) / 2)
        failure, b, p = verdict(middle)
        if failure:
            low, limiting = middle, failure
        else:
            high, bottom, best = middle, b, p
    return LeastOnTime(period, high, low, bottom, best, limiting)


def _rounded(value: Fraction) -> Fraction:
    """To a thousandth of a second: on-times that a person can write down."""
    return Fraction(round(value * 1000), 1000)
