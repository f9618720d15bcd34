"""Where words go: results to stdout, everything about the run itself to stderr."""

from __future__ import annotations

import sys
from collections.abc import Iterator
from contextlib import contextmanager
from typing import TYPE_CHECKING, Protocol, final

if TYPE_CHECKING:
    from rich.console import Console
    from rich.progress import Progress, TaskID

PIPE_WIDTH = 120
"""Columns of a table when stdout is not a terminal."""


class Step(Protocol):
    """How long work tells how far it is: what it does, and the fraction done in [0, 1]."""

    def __call__(self, stage: str, fraction: float) -> None:
        """Report progress."""


def output() -> Console:
    """Console of the results: styled on a terminal; plain text, 120 columns, in a pipe."""
    from rich.console import Console

    terminal = sys.stdout.isatty()
    return Console(
        file=sys.stdout,
        width=None if terminal else PIPE_WIDTH,
        no_color=None if terminal else True,
        highlight=False,
        emoji=False,
        markup=False,
        legacy_windows=False,
    )


def note(text: str) -> None:
    """One line about the run (time, files written), on stderr."""
    sys.stderr.write(text + "\n")


@contextmanager
def progress(title: str) -> Iterator[Step]:
    """A progress bar with the time gone and left (estimated) on a terminal; nothing in a pipe."""
    if not sys.stderr.isatty():
        yield _silent
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (
        TextColumn("{task.description}", markup=False),
        BarColumn(),
        TimeElapsedColumn(),
        TimeRemainingColumn(),
    )
    bar = Progress(*columns, console=Console(stderr=True), transient=True)
    with bar:
        yield _Bar(bar, bar.add_task(title, total=1.0))


def _silent(stage: str, fraction: float) -> None:
    del stage, fraction


@final
class _Bar:
    def __init__(self, bar: Progress, task: TaskID) -> None:
        self._bar, self._task = bar, task

    def __call__(self, stage: str, fraction: float) -> None:
        self._bar.update(self._task, description=stage, completed=min(max(fraction, 0.0), 1.0))
