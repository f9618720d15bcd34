"""Schedule study: peak, floor and settling against duty cycle and period; the least on-time that suffices."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from concurrent.futures import Executor
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.mission import Mission
from ...models.norms import NORMS, Norm
from ...models.types import Interrupted, Progress
from ...optim.schedule_study import LeastOnTime, ScheduleCase, ScheduleFamily, least_on_time, study_schedules
from ...optim.tuning.conditions import certified_floor
from ...reports import parts
from ...reports.record import Record
from ...reports.record.claims import QuantityEntry
from ...reports.record.document import Sections
from ...reports.record.tables import CellEntry, CollectionEntry, FigureEntry, TableEntry
from ...scenario import LawChoice, Scenario, ScenarioError
from ..collections import Arrays, certified_below, collection_record, newtons
from ..optimum.run import require_few_windows

DEFAULT_DUTY = (Fraction(1, 5), Fraction(3, 10), Fraction(2, 5), Fraction(1, 2), Fraction(3, 5))
"""Duty cycles studied where the scenario names none."""


@final
@dataclass(frozen=True, eq=False)
class ScheduleStudy:
    """Cases of one law over periods and duty cycles, and the inverse answers by period."""

    scenario: Scenario
    law: LawChoice
    norm: Norm
    time: Fraction
    cases: tuple[ScheduleCase, ...]
    least: tuple[LeastOnTime, ...]


def run_schedule_study(
    scenario: Scenario,
    *,
    law: str | None = None,
    norm: Norm | None = None,
    executor: Executor | None = None,
    progress: Progress | None = None,
) -> ScheduleStudy:
    """Study the schedules of [study] for one law of the scenario, in the norm of [optimum] or the given.

    Raises
    ------
    ScenarioError
        If the scenario has no law, or neither it nor its schedule names a period.
    Interrupted
        With the study so far, where the user interrupts after its first schedule.
    """
    if not scenario.laws:
        raise ScenarioError(scenario.path.name, "has no [[law]] to study")
    choice = scenario.law(law) if law is not None else scenario.laws[0]
    own = scenario.schedule.period
    periods = scenario.study.periods or ((own,) if own is not None else ())
    if not periods:
        raise ScenarioError(
            f"{scenario.path.name}: study.periods", "required with a finite table, but missing"
        )
    duty = scenario.study.duty_cycles or DEFAULT_DUTY
    time = scenario.optimum.final_time or scenario.horizon
    built, mission, norm = choice.build(), scenario.mission, norm or NORMS[scenario.optimum.norm]
    _require_windows_that_fit(scenario, mission, periods, duty, time)
    cases: tuple[ScheduleCase, ...] = ()
    least: list[LeastOnTime] = []

    def study() -> ScheduleStudy:
        return ScheduleStudy(scenario, choice, norm, time, cases, tuple(least))

    try:
        cases = study_schedules(
            built, mission, periods, duty, time=time, norm=norm, floor=certified_floor, executor=executor,
            progress=progress,
        )  # fmt: skip
        limit = scenario.study.torque_limit
        for period in periods if limit is not None else ():
            assert limit is not None
            found = least_on_time(
                built, mission, period, torque_limit=limit, time=time, norm=norm, floor=certified_floor
            )
            least.append(found)
    except Interrupted as stopped:
        cases = stopped.found
        if not cases:
            raise KeyboardInterrupt from None
        raise Interrupted(study(), stopped.left_out) from None
    except KeyboardInterrupt:
        raise Interrupted(study(), "not finished: the least on-times") from None
    return study()


def _require_windows_that_fit(
    scenario: Scenario,
    mission: Mission,
    periods: Sequence[Fraction],
    duty: Sequence[Fraction],
    time: Fraction,
) -> None:
    """Refuse a period in which the window of some duty cycle cannot stand, or of which too many come."""
    family = ScheduleFamily()
    for period in periods:
        require_few_windows(scenario, int(time // period), time)
        for share in duty:
            try:
                family.applied_to(mission, period, share * period)
            except ValueError as error:
                raise ScenarioError(
                    f"{scenario.path.name}: study",
                    f"period {float(period):g} s with duty cycle {float(share):g}: {error}",
                ) from None


def schedule_record(study: ScheduleStudy) -> Record:
    """The study as a table, a figure for each quantity, and the inverse answers."""
    arrays = Arrays()
    tables = [_cases_table(study)] + ([_least_table(study)] if study.least else [])
    section = CollectionEntry(
        title=f"Schedule study of {study.law.label}",
        summary=f"One Hermite window a period; optimum and bound for {float(study.time):g} s to the "
        "scenario's terminal tolerances.",
        tables=tuple(tables),
        figures=(
            _figure(study, arrays, "law", "peak of the law", "N m", lambda c: c.law_peak),
            _figure(study, arrays, "optimum", "optimum found", "N m", lambda c: c.best.optimum),
            _figure(study, arrays, "bound", "certified bound", "N m", lambda c: c.best.bound),
            _figure(study, arrays, "floor", "certified floor of R", "s", lambda c: c.floor),
        ),
    )
    return collection_record(
        study.scenario,
        title=f"Schedule study of {study.scenario.name}",
        command=f"intermit sweep {study.scenario.path.name}",
        sections=Sections(schedule_study=section),
        arrays=arrays,
        options={"norm": study.norm.key, "time": float(study.time), "law": study.law.label},
    )


def _seconds(name: str, value: float | None, missing: str) -> CellEntry:
    return missing if value is None else parts.figure_of(name, value, digits=6, unit="s")


def _exact(name: str, value: Fraction, unit: str = "s") -> QuantityEntry:
    return parts.quantity(name, float(value), unit=unit)


def _cases_table(study: ScheduleStudy) -> TableEntry:
    columns = [
        parts.column("period", "period", "s"),
        parts.column("on", "on-time", "s"),
        parts.column("floor", "R certified", "s"),
        parts.column("settling", "settling", "s"),
        parts.column("law", "law's peak", "N m"),
        parts.column("optimum", "optimum found", "N m"),
        parts.column("bound", "certified bound", "N m"),
    ]
    rows: list[dict[str, CellEntry]] = [
        {
            "period": _exact("period", case.period),
            "on": _exact("on", case.on_time),
            "floor": "none proved"
            if case.floor is None
            else parts.quantity("floor", case.floor, unit="s", rigorous=True, side="lower"),
            "settling": _seconds("settling", case.settling, "not within the horizon"),
            "law": newtons("law", case.law_peak) if case.law_peak is not None else "run failed",
            "optimum": case.best.answer.reason
            if case.best.optimum is None
            else newtons("optimum", case.best.optimum),
            "bound": certified_below("bound", case.best.bound),
        }
        for case in study.cases
    ]
    return parts.table("schedules", f"Periods and duty cycles, {study.norm.key} norm", columns, rows)


def _least_table(study: ScheduleStudy) -> TableEntry:
    columns = [
        parts.column("period", "period", "s"),
        parts.column("suffices", "on-time that suffices", "s"),
        parts.column("fails", "on-time that does not", "s"),
        parts.column("floor", "R certified there", "s"),
        parts.column("optimum", "optimum there", "N m"),
        parts.column("limiting", "what fails below"),
    ]
    rows: list[dict[str, CellEntry]] = []
    for answer in study.least:
        floor = answer.floor
        rows.append(
            {
                "period": _exact("period", answer.period),
                "suffices": "none" if answer.suffices is None else _exact("suffices", answer.suffices),
                "fails": _exact("fails", answer.fails),
                "floor": None
                if floor is None
                else parts.quantity("floor", floor, unit="s", rigorous=True, side="lower"),
                "optimum": None if answer.optimum is None else newtons("optimum", answer.optimum),
                "limiting": answer.limiting,
            }
        )
    return parts.table("least", "Least on-time a period", columns, rows)


def _figure(
    study: ScheduleStudy,
    arrays: Arrays,
    key: str,
    title: str,
    unit: str,
    value: Callable[[ScheduleCase], float | None],
) -> FigureEntry:
    lines = []
    for number, period in enumerate(dict.fromkeys(case.period for case in study.cases), start=1):
        all_of = ((c.duty_cycle, value(c)) for c in study.cases if c.period == period)
        known = [(duty, found) for duty, found in all_of if found is not None]
        if known:
            x = arrays.put(f"study.{key}.{number}.duty", [d for d, _ in known])
            y = arrays.put(f"study.{key}.{number}.value", [v for _, v in known])
            lines.append(parts.series(f"period {float(period):g} s", x, y, style="line+points"))
    return parts.figure(
        f"study_{key}", title, parts.axis("duty cycle"), parts.axis(title, unit), lines,
        alt=f"{title} against duty cycle, one line a period.",
    )  # fmt: skip
