"""`intermit certify`."""

from __future__ import annotations

from pathlib import Path
from time import perf_counter
from typing import Annotated

import typer

from ..errors import InputError
from .exit_codes import ExitCode
from .options import Debug


def run(
    scenario: Annotated[
        Path | None, typer.Argument(metavar="SCENARIO.toml", help="Scenario file.", show_default=False)
    ] = None,
    output: Annotated[
        Path | None, typer.Option("--output", "-o", metavar="FILE", help="Certificate file to write (JSON).")
    ] = None,
    checker: Annotated[
        Path | None,
        typer.Option("--checker", metavar="FILE.pyz", help="Write the stand-alone checker as one file."),
    ] = None,
    bound: Annotated[
        bool,
        typer.Option("--bound", help="Certify the lower bound of the [optimum] table's least peak too."),
    ] = False,
    debug: Debug = False,
) -> int:
    """Write the certificates of everything about a schedule and its laws that could be proved.

    The lower bound of the least peak takes longer than all the rest, and is written on demand.

    The file can be checked with `intermit recheck FILE`, or by the checker alone, which needs
    nothing but Python: python -I -S checker.pyz FILE, as --checker writes it.
    """
    del debug
    from ..reports.whole_files import write_whole

    if checker is not None:
        from ..verify.certificates.checker_archive import checker_archive

        write_whole(checker, checker_archive())
        typer.echo(f"the checker in {checker}: python -I -S {checker} FILE")
        if scenario is None and output is None:
            return ExitCode.HOLDS
    if scenario is None or output is None:
        missing = "SCENARIO.toml" if scenario is None else "--output FILE"
        raise InputError(f"certify: {missing} is missing: intermit certify SCENARIO.toml -o FILE")
    from ..study.certify.run import certify
    from ..study.optimum.lower_bounds import asks_for_optimum
    from ..verify.lyapunov import certificates_of
    from .console import note, progress
    from .opening import open_scenario

    began = perf_counter()
    loaded = open_scenario(scenario)
    with progress(loaded.name) as step:
        result = certify(loaded, step, bound=bound)
    if not result.certificates:
        note("nothing could be certified: no file written")
        return ExitCode.UNDECIDED
    write_whole(output, result.text)
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
