"""`intermit paper`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import Debug, JsonFile


def run(
    scenarios: Annotated[
        list[Path] | None,
        typer.Argument(metavar="[SCENARIO.toml ...]", help="One a body (default: the shipped J1 and J2)."),
    ] = None,
    survey: Annotated[
        bool, typer.Option("--survey/--no-survey", help="Try the statements over the unstated data too.")
    ] = True,
    json: JsonFile = None,
    debug: Debug = False,
) -> int:
    """Run the paper's own comparisons, and check what its text says of them."""
    del debug
    from importlib.resources import as_file, files

    from ..scenario import load_scenario
    from ..study.paper.figures import paper_record, run_paper
    from .console import progress
    from .finish import finish

    with as_file(files("intermit").joinpath("examples")) as folder:
        paths = scenarios or [folder / "paper.toml", folder / "paper-j2.toml"]
        loaded = tuple(load_scenario(path) for path in paths)
        with progress("the paper's comparisons"):
            record = paper_record(run_paper(loaded, with_survey=survey))
    return finish(record, json)
