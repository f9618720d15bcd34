"""`intermit recheck`."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from ..errors import InputError
from .exit_codes import ExitCode
from .options import Debug


def run(
    file: Annotated[Path, typer.Argument(metavar="FILE", help="Certificate file.")],
    scenario: Annotated[
        Path | None,
        typer.Option(
            "--scenario", metavar="SCENARIO.toml", help="Demand that the file speaks of this scenario."
        ),
    ] = None,
    part: Annotated[
        list[Path] | None,
        typer.Option(
            "--with", metavar="PART.py", help="Trust a comparison system of somebody else's (runs its code)."
        ),
    ] = None,
    debug: Debug = False,
) -> int:
    """Prove every claim of a certificate file anew, from the file alone.

    A part that is named is trusted beside the checker; every claim that rests on one says so.
    Exit code 0 if everything is valid (and equal to the scenario's data, if one is given), else 1.
    """
    del debug
    from ..study.certify.recheck import read_parts
    from ..verify import checker

    try:
        text = file.read_text(encoding="utf-8")
    except UnicodeDecodeError as error:
        raise InputError(f"{file}: is not UTF-8 text (byte {error.start + 1})") from None
    findings = checker.check_text(text, read_parts(part or ()))
    typer.echo(checker.report(findings), nl=False)
    valid = all(finding.valid for finding in findings)
    if scenario is None or not valid:
        return ExitCode.HOLDS if valid else ExitCode.REFUTED
    from ..scenario import load_scenario
    from ..study.certify.same_scenario import differences, uncovered

    loaded = load_scenario(scenario)
    found = differences(text, loaded)
    for line in uncovered(text, loaded):
        typer.echo(f"NOMINAL  {line}")
    for line in found:
        typer.echo(f"DIFFERS  {line} is not that of {scenario}")
    if not found:
        typer.echo(f"EQUAL  the data are those of {scenario}")
    return ExitCode.REFUTED if found else ExitCode.HOLDS
