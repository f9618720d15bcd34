"""The frame: registers the commands and turns every outcome into one line and an exit code."""

from __future__ import annotations

import os
import sys
from collections.abc import Sequence
from importlib import import_module
from typing import Annotated

import typer

from ..errors import InputError
from ..study.threads import one_thread
from .exit_codes import HELP, ExitCode
from .options import Debug, debugging

COMMANDS = (
    "init",
    "check",
    "explain",
    "optimum",
    "compare",
    "tune",
    "sweep",
    "paper",
    "certify",
    "recheck",
    "audit",
    "report",
)
"""Modules of this room that are commands, in the order of the help page; `_` is spelled `-`."""

MAX_MESSAGE = 1000
"""Characters of an error message that are shown."""

SUMMARY = "Check, optimise and report attitude control through thruster windows."


def build_app() -> typer.Typer:
    """Assemble the application from the command files."""
    app = typer.Typer(
        name="intermit",
        help=SUMMARY,
        epilog=HELP,
        no_args_is_help=True,
        add_completion=False,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,
        context_settings={"help_option_names": ["-h", "--help"]},
    )
    app.callback()(_root)
    for name in COMMANDS:
        run = import_module(f".{name}", __package__).run
        app.command(name=name.replace("_", "-"), no_args_is_help=False)(run)
    return app


def _root(
    version: Annotated[
        bool,
        typer.Option("--version", callback=lambda v: _version(v), is_eager=True, help="Print the version."),
    ] = False,
    debug: Debug = False,
) -> None:
    """Check, optimise and report attitude control through thruster windows."""
    del version, debug


def _version(asked: bool) -> None:
    if asked:
        from .. import __version__

        typer.echo(__version__)
        raise typer.Exit


def main(arguments: Sequence[str] | None = None) -> None:
    """Run the command line and exit."""
    one_thread()
    sys.exit(run(sys.argv[1:] if arguments is None else arguments))


def run(arguments: Sequence[str]) -> int:
    """Run one command; return its exit code. Errors are one line on stderr, without a traceback."""
    debugging.on = False
    try:
        outcome = build_app()(args=list(arguments), standalone_mode=False)
        sys.stdout.flush()
    except BrokenPipeError:
        # The reader has gone (`intermit check ... | head`): nothing is left to say.
        os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
        return ExitCode.HOLDS
    except (KeyboardInterrupt, typer.Abort):
        return _fail("interrupted", ExitCode.INTERRUPTED)
    except Exception as error:
        if debugging.on:
            import traceback

            traceback.print_exc()
        return _report(error)
    if outcome == ExitCode.INTERRUPTED:
        return _fail("interrupted", ExitCode.INTERRUPTED)
    return int(outcome) if isinstance(outcome, int) else ExitCode.HOLDS


def _report(error: Exception) -> int:
    """One line for an error: the user's to mend (exit 2) or ours (exit 70)."""
    if isinstance(error, typer.Exit):
        return int(error.exit_code)
    usage = getattr(error, "format_message", None)
    if usage is not None:
        return _fail(usage() or "no command given; see --help", ExitCode.BAD_INPUT)
    if isinstance(error, InputError):
        return _fail(str(error), ExitCode.BAD_INPUT)
    if isinstance(error, OSError):
        where = f"{error.filename}: " if error.filename is not None else ""
        return _fail(f"{where}{error.strerror or error}", ExitCode.BAD_INPUT)
    hint = "" if debugging.on else " (--debug shows where)"
    return _fail(f"internal error: {type(error).__name__}: {error}{hint}", ExitCode.INTERNAL)


def _fail(message: str, code: ExitCode) -> int:
    """Say what went wrong in one line on stderr."""
    line = "".join(c if c.isprintable() else " " for c in message[:MAX_MESSAGE])
    typer.echo(f"intermit: {line}", err=True)
    return code
