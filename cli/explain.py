"""`intermit explain`."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from ..errors import InputError
from .options import Debug

if TYPE_CHECKING:
    from ..study.check.result import CheckStudy


def run(
    claim: Annotated[
        str | None, typer.Argument(metavar="[CLAIM]", help="Key of a claim, e.g. filter.floor.")
    ] = None,
    scenario: Annotated[
        Path | None, typer.Argument(metavar="[SCENARIO.toml]", help="Put this scenario's numbers in.")
    ] = None,
    debug: Debug = False,
) -> None:
    """State a claim with its numbers, its evidence and its source; without a key, list them all."""
    del debug
    from ..verify.claim_table import CLAIM_KEYS
    from .console import output
    from .explain_page import print_claim, print_found, print_keys

    console = output()
    if claim is None:
        print_keys(console)
        return
    if claim not in CLAIM_KEYS:
        raise InputError(f"no claim has the key '{claim}' (keys: {', '.join(CLAIM_KEYS)})")
    print_claim(console, CLAIM_KEYS[claim])
    if scenario is not None:
        print_found(console, claim, _study(scenario))


def _study(path: Path) -> CheckStudy:
    from ..scenario import load_scenario
    from ..study.check.run import run_check
    from ..study.options import CheckOptions
    from .console import progress

    loaded = load_scenario(path)
    with progress(loaded.name) as step:
        return run_check(loaded, CheckOptions(simulate=False), step)
