"""`intermit tune`."""

from __future__ import annotations

from fractions import Fraction
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError
from ..study.options import TuneOptions, help_of
from .options import WORKERS, Debug, JsonFile, PeakNorm, ScenarioFile, norm_of

if TYPE_CHECKING:
    from ..optim.tuning.search import SearchHistory


def run(
    scenario: ScenarioFile,
    settle: Annotated[
        str | None, typer.Option(metavar="S[,S...]", help="Latest settling time, s; several with --front.")
    ] = None,
    peak_norm: PeakNorm = None,
    law: Annotated[str | None, typer.Option(metavar="LABEL", help=help_of(TuneOptions, "law"))] = None,
    front: Annotated[
        bool, typer.Option("--front", help="Every law at every settling time, beside the optimum.")
    ] = False,
    workers: Annotated[
        int, typer.Option(min=1, help="Processes that share the points of a front.")
    ] = WORKERS,
    seed: Annotated[int | None, typer.Option(min=0, help=help_of(TuneOptions, "seed"))] = None,
    json: JsonFile = None,
    debug: Debug = False,
) -> int:
    """Find the parameters with the least peak torque that settle in time, under certified conditions."""
    del debug
    from ..study.pool import executor_of
    from ..study.tune.run import front_record, run_front, run_tuning, tuning_record
    from .console import printing_what_is_found, progress
    from .finish import finish
    from .opening import open_scenario
    from .size import state_size, tune_size

    norm = norm_of(peak_norm)
    loaded = open_scenario(scenario)
    times = _times(settle)
    state_size(tune_size(loaded, max(len(times) * len(loaded.laws), 1) if front else 1))
    with printing_what_is_found(_best_so_far), progress(loaded.name) as step:
        if front:
            if not times:
                raise InputError("--front needs --settle with the settling times, e.g. --settle 20,28,36")
            with executor_of(workers) as executor:
                found = run_front(loaded, times, norm=norm, executor=executor)
            return finish(front_record(loaded, found), json)
        if len(times) > 1:
            raise InputError("--settle takes one time (several only with --front)")
        time = times[0] if times else None
        tuned = run_tuning(loaded, settle=time, norm=norm, law=law, seed=seed, progress=step)
    return finish(tuning_record(loaded, tuned), json, failed=tuned.law is None)


def _best_so_far(history: SearchHistory) -> None:
    """Print the best candidate of a search that was interrupted: simulated quickly, nothing certified."""
    best = next(iter(history.settled_by_peak), None)
    if best is None:
        typer.echo("No candidate has settled in time so far.")
        return
    found = ", ".join(f"{name} = {float(value):.6g}" for name, value in best.parameters)
    typer.echo(
        f"Best candidate so far, not certified, by the search's own run: {found}: peak {best.peak:.6g}"
    )


def _times(text: str | None) -> list[Fraction]:
    times = []
    for word in (text or "").split(","):
        if not word.strip():
            continue
        try:
            value = Fraction(word.strip())
        except (ValueError, ZeroDivisionError):
            raise InputError(f"--settle: expected times in s, received {word!r}") from None
        if value <= 0:
            raise InputError(f"--settle: expected a time > 0 s, received {word!r}")
        times.append(value)
    return times
