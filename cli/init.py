"""`intermit init`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from .options import Debug

TEMPLATE_NAME = "scenario.toml"


def run(
    folder: Annotated[
        Path, typer.Argument(metavar="[DIR]", help="Folder to write to; made if missing.")
    ] = Path(),
    paper: Annotated[
        bool, typer.Option("--paper", help="Write the paper's examples instead of a commented template.")
    ] = False,
    debug: Debug = False,
) -> None:
    """Write a commented scenario to start from; nothing that exists is overwritten."""
    del debug
    from ..scenario.template import write_examples, write_template

    if paper:
        written = write_examples(folder)
    else:
        folder.mkdir(parents=True, exist_ok=True)
        written = (write_template(folder / TEMPLATE_NAME),)
    for path in written:
        typer.echo(path)
