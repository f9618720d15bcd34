"""Everything a report shows, in one record: the check, the optimum and the comparison of one scenario."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import final

from ..reports.join import join
from ..reports.record import Record
from ..scenario import Scenario
from .check import CheckOptions, CheckStudy, run_check
from .check_record import check_record

Progress = Callable[[str, float], None]


@final
@dataclass(frozen=True, kw_only=True)
class ReportOptions:
    """What a report holds beside the check.

    Attributes
    ----------
    optimum : the least peak any controller could do with, for the scenario's final time
    comparison : each law against the optimum for its own settling time
    check : what the check does beyond its claims
    """

    optimum: bool = True
    comparison: bool = True
    check: CheckOptions = field(default_factory=CheckOptions)


def run_report(
    scenario: Scenario,
    options: ReportOptions | None = None,
    *,
    date: str = "",
    author: str = "",
    progress: Progress | None = None,
    checked: Callable[[CheckStudy], None] | None = None,
) -> Record:
    """Run what a report shows and join it into one record; the outcome is the check's.

    `checked` is told the check's findings as soon as they are there.

    Raises
    ------
    ScenarioError
        If the scenario cannot be checked as it asks.
    """
    options = options if options is not None else ReportOptions()
    tell = progress if progress is not None else _silent
    command = f"intermit report {scenario.path.name}"
    check = run_check(scenario, options.check, _part(tell, 0.0, 0.6))
    if checked is not None:
        checked(check)
    records = [check_record(check, date=date, author=author, command=command)]
    if options.optimum:
        from .optimum import OptimumOptions, run_optimum
        from .optimum_record import optimum_record

        records.append(optimum_record(run_optimum(scenario, OptimumOptions(), _part(tell, 0.6, 0.8))))
    if options.comparison:
        from .compare import comparison_record, run_comparison

        tell("comparison", 0.8)
        records.append(comparison_record(run_comparison(scenario)))
    tell("done", 1.0)
    return join(records, title=scenario.name, command=command, date=date, author=author)


def _part(tell: Progress, start: float, end: float) -> Progress:
    return lambda stage, fraction: tell(stage, start + (end - start) * fraction)


def _silent(stage: str, fraction: float) -> None:
    del stage, fraction
