"""`intermit check`."""

from __future__ import annotations

from time import perf_counter
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError
from ..study.options import CheckOptions, help_of
from .options import WORKERS, Debug, JsonFile, ScenarioFiles

if TYPE_CHECKING:
    from ..study.check.result import CheckStudy


def run(
    scenarios: ScenarioFiles,
    json: JsonFile = None,
    simulate: Annotated[
        bool, typer.Option("--simulate/--no-simulate", help=help_of(CheckOptions, "simulate"))
    ] = True,
    margins: Annotated[
        bool, typer.Option("--margins/--no-margins", help=help_of(CheckOptions, "margins"))
    ] = True,
    search: Annotated[
        bool, typer.Option("--search/--no-search", help=help_of(CheckOptions, "search"))
    ] = True,
    workers: Annotated[
        int, typer.Option("--workers", min=1, help=help_of(CheckOptions, "workers"))
    ] = WORKERS,
    debug: Debug = False,
) -> int:
    """Check a schedule and its laws: one verdict a condition, with its numbers and margin.

    Give several scenarios to see them side by side.
    """
    del debug
    from ..study.check.run import run_check
    from ..study.claims.counting import exit_code
    from .check_page import print_check
    from .console import note, output, printing_what_is_found, progress
    from .opening import open_scenario
    from .size import check_size, state_size

    began = perf_counter()
    if json is not None and len(scenarios) > 1:
        raise InputError("--json writes one record: give one scenario")
    loaded = [open_scenario(path, says_clock=True) for path in scenarios]
    options = CheckOptions(simulate=simulate, margins=margins, search=search, workers=workers)
    for scenario in loaded:
        state_size(check_size(scenario))
    studies: list[CheckStudy] = []
    with printing_what_is_found(lambda study: print_check(output(), [*studies, study])):
        for scenario in loaded:
            with progress(scenario.name) as step:
                studies.append(run_check(scenario, options, step))
    print_check(output(), studies)
    if json is not None:
        from ..reports.record import write_record_to
        from ..study.check.record import check_record

        write_record_to(check_record(studies[0]), json)
    note(f"{perf_counter() - began:.1f} s")
    return exit_code(claim for study in studies for claim in study.all_claims)
