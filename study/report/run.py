"""Everything a report shows, in one record: check, optimum, comparison, and what [report] asks for."""

from __future__ import annotations

from collections.abc import Callable, Iterator

from ...models.norms import NORMS
from ...models.types import Progress, silent
from ...reports.join import join
from ...reports.record import Record
from ...reports.record.document import Sections
from ...reports.record.tables import CollectionEntry
from ...scenario import Scenario
from ..check.record import check_record
from ..check.result import CheckStudy
from ..check.run import run_check
from ..options import OptimumOptions, ReportOptions
from ..pool import executor_of


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
    tell = progress if progress is not None else silent
    command = f"intermit report {scenario.path.name}"
    check = run_check(scenario, options.check, _part(tell, 0.0, 0.4))
    if checked is not None:
        checked(check)
    first = check_record(check, date=date, author=author, command=command)
    records = [first, *_further(scenario, options, tell, first)]
    tell("done", 1.0)
    return join(records, title=scenario.name, command=command, date=date, author=author)


def _further(scenario: Scenario, options: ReportOptions, tell: Progress, check: Record) -> Iterator[Record]:
    """Records of the same input beside the check's."""
    if options.optimum:
        from ..optimum.record import optimum_record
        from ..optimum.run import run_optimum

        yield optimum_record(run_optimum(scenario, OptimumOptions(), _part(tell, 0.4, 0.5)))
    if options.comparison:
        from ..compare.run import comparison_record, run_comparison

        tell("comparison", 0.5)
        yield comparison_record(run_comparison(scenario))
    if options.front and scenario.report.front:
        tell("front", 0.6)
        yield _front(scenario, options.check.workers)
    if options.audit and scenario.report.audit:
        tell("audit", 0.98)
        yield _audit(check)


def _front(scenario: Scenario, workers: int) -> Record:
    """Peak torque against settling time, its points shared by the workers."""
    from ..tune.run import front_record, run_front

    asked = scenario.report
    with executor_of(workers) as executor:
        found = run_front(
            scenario,
            asked.front,
            norm=NORMS[asked.front_norm],
            labels=asked.front_laws,
            evaluations=asked.front_evaluations,
            executor=executor,
        )
    return front_record(scenario, found)


def _audit(check: Record) -> Record:
    """The audit's tables as part of this input's record.

    Its claims stay in its own record: they are about the paper's equations and decide nothing here.
    """
    from ..paper.audit_record import audit_record, run_audit

    found = audit_record(run_audit()).sections.audit
    assert found is not None
    section = CollectionEntry(
        title=found.title,
        summary=found.summary,
        tables=found.tables,
        notes=(*found.notes, "`intermit audit --json FILE` writes every counterexample in full."),
    )
    return Record.create(title="audit", provenance=check.provenance, sections=Sections(audit=section))


def _part(tell: Progress, start: float, end: float) -> Progress:
    return lambda stage, fraction: tell(stage, start + (end - start) * fraction)
