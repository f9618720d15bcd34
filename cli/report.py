"""`intermit report`."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from ..errors import InputError
from ..study.options import CheckOptions, ReportOptions, help_of
from .options import WORKERS, Debug

Sources = Annotated[
    list[Path],
    typer.Argument(
        metavar="SCENARIO.toml | results.json [results.json]",
        help="A scenario to study; or a record to make the pages of again; or two records to compare.",
    ),
]


def run(
    context: typer.Context,
    sources: Sources,
    out: Annotated[Path, typer.Option("-o", "--out", metavar="DIR", help="Folder of the report.")],
    date: Annotated[str, typer.Option(help="Date on the title page (default: SOURCE_DATE_EPOCH).")] = "",
    author: Annotated[str, typer.Option(help="Name on the title page.")] = "",
    optimum: Annotated[
        bool, typer.Option("--optimum/--no-optimum", help=help_of(ReportOptions, "optimum"))
    ] = True,
    compare: Annotated[
        bool, typer.Option("--compare/--no-compare", help=help_of(ReportOptions, "comparison"))
    ] = True,
    margins: Annotated[
        bool, typer.Option("--margins/--no-margins", help=help_of(CheckOptions, "margins"))
    ] = True,
    front: Annotated[bool, typer.Option("--front/--no-front", help=help_of(ReportOptions, "front"))] = True,
    audit: Annotated[bool, typer.Option("--audit/--no-audit", help=help_of(ReportOptions, "audit"))] = True,
    force: Annotated[bool, typer.Option("--force", help="Write among files of another's making.")] = False,
    debug: Debug = False,
) -> int:
    """Write a report: one page to look at, a PDF for the board, tables and figures for the paper.

    From a record nothing is computed again. An interrupted run leaves the old report as it was.
    """
    del debug
    from .console import note

    began = perf_counter()
    records = [path for path in sources if path.suffix == ".json" or path.is_dir()]
    if records and len(records) < len(sources):
        raise InputError("give one scenario, one record, or two records; not a scenario beside a record")
    if records:
        _refuse_unread(context)
    if len(sources) > 2 or (len(sources) == 2 and not records):
        raise InputError("give one scenario, one record, or two records to compare")
    if len(records) == 2:
        from ..reports.build import write_comparison

        code, folder = write_comparison(records[0], records[1], out, force=force)
    elif records:
        from ..reports.build import rebuild_report

        code, folder = rebuild_report(records[0], out, force=force)
    else:
        code, folder = _study(
            sources[0], out, (optimum, compare, margins, front, audit), (date, author), force
        )
    note(f"{folder / 'report.html'}: {perf_counter() - began:.1f} s")
    return code


def _refuse_unread(context: typer.Context) -> None:
    """Refuse what only a study reads: from a record nothing is computed again, its title page included."""
    unread = ("date", "author", "optimum", "compare", "margins", "front", "audit")
    for name in unread:
        source = context.get_parameter_source(name)
        if source is not None and source.name == "COMMANDLINE":
            raise InputError(
                f"--{name} is read when a scenario is studied, received beside a record: leave it out, "
                "or make the report again from the scenario"
            )


def _study(
    source: Path, out: Path, wanted: tuple[bool, ...], given: tuple[str, str], force: bool
) -> tuple[int, Path]:
    from ..reports.build import exit_code, write_report
    from ..reports.folder import refuse
    from ..study.check.result import CheckStudy
    from ..study.report.run import run_report
    from .check_page import print_check
    from .console import output, progress
    from .opening import open_scenario

    scenario = open_scenario(source, says_clock=True)
    refuse(out, force=force)
    check = CheckOptions(margins=wanted[2], workers=WORKERS)
    options = ReportOptions(
        optimum=wanted[0], comparison=wanted[1], front=wanted[3], audit=wanted[4], check=check
    )
    studies: list[CheckStudy] = []
    with progress(scenario.name) as step:
        record = run_report(
            scenario, options, date=given[0], author=given[1], progress=step, checked=studies.append
        )
    print_check(output(), studies)
    return exit_code(record), write_report(record, out, force=force)
