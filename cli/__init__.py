"""The command line: words in, words and exit codes out."""

from __future__ import annotations

import typer

app = typer.Typer(
    name="intermit",
    help="Check, optimise and report attitude control through thruster windows.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
)


@app.callback()
def _root() -> None:
    """Check, optimise and report attitude control through thruster windows."""


def main() -> None:
    """Run the command line."""
    app()
