"""`intermit compare`."""

from __future__ import annotations

from typing import Annotated

import typer

from ..study.options import CompareOptions, help_of
from .options import Debug, JsonFile, ScenarioFile


def run(
    scenario: ScenarioFile,
    law: Annotated[
        list[str] | None,
        typer.Option(metavar="FILE.py:CLASS[,NAME=VALUE]", help="Also a law of your own."),
    ] = None,
    at_horizon: Annotated[
        bool, typer.Option("--at-horizon", help=help_of(CompareOptions, "at_horizon"))
    ] = False,
    json: JsonFile = None,
    debug: Debug = False,
) -> int:
    """Put every law of a scenario beside the optimum for its own settling time, with a certified bound."""
    del debug
    from ..scenario import law_from_words, with_laws
    from ..study.compare.run import comparison_record, run_comparison
    from .console import printing_what_is_found, progress
    from .finish import finish
    from .opening import open_scenario
    from .size import compare_size, state_size

    loaded = with_laws(open_scenario(scenario), *(law_from_words(words) for words in law or ()))
    state_size(compare_size(loaded))
    with (
        printing_what_is_found(lambda partial: finish(comparison_record(partial), None)),
        progress(loaded.name) as step,
    ):
        found = run_comparison(loaded, CompareOptions(at_horizon=at_horizon), step)
    return finish(comparison_record(found), json, failed=not found.is_complete)
