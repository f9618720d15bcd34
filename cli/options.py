"""Options and arguments that several commands share, spelled once."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Annotated, final

import typer

from ..errors import InputError
from ..study.options import TuneOptions, help_of

if TYPE_CHECKING:
    from ..models.norms import Norm


@final
class _Debugging:
    """Whether an error shows its traceback."""

    on = False


debugging = _Debugging()


def _remember(asked: bool) -> bool:
    debugging.on = debugging.on or asked
    return asked


WORKERS = 2
"""Processes of a command that can share its work, unless the user says otherwise."""

Debug = Annotated[
    bool,
    typer.Option("--debug", callback=_remember, is_eager=True, help="Show the traceback of an error."),
]
ScenarioFile = Annotated[Path, typer.Argument(metavar="SCENARIO.toml", help="Scenario file.")]
ScenarioFiles = Annotated[
    list[Path], typer.Argument(metavar="SCENARIO.toml [...]", help="One scenario, or several side by side.")
]
JsonFile = Annotated[
    Path | None,
    typer.Option("--json", metavar="FILE", help="Write the whole record to FILE (arrays beside it, .npz)."),
]
PeakNorm = Annotated[str | None, typer.Option(metavar="NORM", help=help_of(TuneOptions, "norm"))]


def norm_of(word: str | None) -> Norm | None:
    """The norm of the torque that a word names.

    Raises
    ------
    InputError
        If it is not one.
    """
    from ..models.norms import NORMS

    if word is None or word in NORMS:
        return None if word is None else NORMS[word]
    raise InputError(f"--peak-norm: expected {' or '.join(NORMS)}, received {word!r}")
