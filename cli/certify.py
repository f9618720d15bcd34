"""`intermit certify`."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from .exit_codes import ExitCode
from .options import Debug, ScenarioFile


def run(
    scenario: ScenarioFile,
    output: Annotated[
        Path, typer.Option("--output", "-o", metavar="FILE", help="Certificate file to write (JSON).")
    ],
    bound: Annotated[
        bool,
        typer.Option("--bound", help="Certify the lower bound of the [optimum] table's least peak too."),
    ] = False,
    debug: Debug = False,
) -> int:
    """Write the certificates of everything about a schedule and its laws that could be proved.

    The lower bound of the least peak takes longer than all the rest, and is written on demand.

    The file can be checked with `intermit recheck FILE`, or by the checker alone, which needs
    nothing but Python: python -I -S checker.py FILE.
    """
    del debug
    from ..scenario import load_scenario
    from ..study.certify.run import certify
    from ..study.optimum.lower_bounds import asks_for_optimum
    from ..verify.lyapunov import certificates_of
    from .console import note, progress

    began = perf_counter()
    loaded = load_scenario(scenario)
    with progress(loaded.name) as step:
        result = certify(loaded, step, bound=bound)
    if not result.certificates:
        note("nothing could be certified: no file written")
        return ExitCode.UNDECIDED
    output.write_text(result.text, encoding="utf-8")
    for subject, claim in result.claims:
        held = len(certificates_of([claim]))
        typer.echo(
            f"{'certified' if held else 'no certificate':15}{claim.verdict.value:10}{subject}: {claim.title}"
        )
    typer.echo(f"{len(result.certificates)} certificates in {output}")
    if not bound and asks_for_optimum(loaded):
        note("the lower bound of the least peak is not among them: add --bound")
    note(f"{perf_counter() - began:.1f} s")
    return ExitCode.HOLDS
