"""`intermit sweep`."""

from __future__ import annotations

from typing import Annotated

import typer

from .options import WORKERS, Debug, JsonFile, PeakNorm, ScenarioFile, norm_of


def run(
    scenario: ScenarioFile,
    law: Annotated[
        str | None, typer.Option(metavar="LABEL", help="Law to study (default: the first).")
    ] = None,
    peak_norm: PeakNorm = None,
    workers: Annotated[int, typer.Option(min=1, help="Processes that share the cases.")] = WORKERS,
    json: JsonFile = None,
    debug: Debug = False,
) -> int:
    """Study schedules: peak, certified bound, floor of R and settling against duty cycle and period."""
    del debug
    from ..study.pool import executor_of
    from ..study.sweep.run import run_schedule_study, schedule_record
    from .console import printing_what_is_found, progress
    from .finish import finish
    from .opening import open_scenario
    from .size import state_size, sweep_size

    loaded = open_scenario(scenario)
    state_size(sweep_size(loaded))
    with (
        printing_what_is_found(lambda found: finish(schedule_record(found), None)),
        progress(loaded.name) as step,
        executor_of(workers) as executor,
    ):
        study = run_schedule_study(loaded, law=law, norm=norm_of(peak_norm), executor=executor, progress=step)
    return finish(schedule_record(study), json)
