"""Where words go: results to stdout, everything about the run itself to stderr."""

from __future__ import annotations

import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from threading import Event, Thread
from time import perf_counter
from typing import TYPE_CHECKING, Any, Protocol, Self, final

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
def printing_what_is_found(show: Callable[[Any], object]) -> Iterator[None]:
    """Print what a study had found when the user interrupted it, and say what is missing; then go on out."""
    from ..models.types import Interrupted

    try:
        yield
    except Interrupted as stopped:
        output().print(f"Interrupted: what follows was found until then; {stopped.left_out}.", style="bold")
        show(stopped.found)
        raise


@contextmanager
def progress(title: str) -> Iterator[Step]:
    """Progress with the time gone and left (estimated): a bar on a terminal, some lines in a pipe."""
    if not sys.stderr.isatty():
        with _Lines() as lines:
            yield lines
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


FIRST_LINE, NEXT_LINES = 10.0, 30.0
"""Seconds before the first line of progress in a pipe, and between the next ones."""


@final
class _Lines:
    """Says on stderr, from a thread of its own, how far the work is."""

    def __init__(self) -> None:
        self._began, self._stage, self._fraction = perf_counter(), "", 0.0
        self._done = Event()
        self._thread = Thread(target=self._speak, daemon=True)

    def __call__(self, stage: str, fraction: float) -> None:
        self._stage, self._fraction = stage, min(max(fraction, 0.0), 1.0)

    def _speak(self) -> None:
        wait = FIRST_LINE
        while not self._done.wait(wait):
            note(progress_line(self._stage, self._fraction, perf_counter() - self._began))
            wait = NEXT_LINES

    def __enter__(self) -> Self:
        self._thread.start()
        return self

    def __exit__(self, *_: object) -> None:
        self._done.set()


def progress_line(stage: str, fraction: float, seconds: float) -> str:
    """Say how far work is, after so many seconds; the time left only where it can be told."""
    said = f"{stage or 'at work'}: {100 * fraction:.0f} % after {seconds:.0f} s"
    if fraction < LEAST_SHARE:
        return said
    return f"{said}, about {seconds * (1 - fraction) / fraction:.0f} s left"


LEAST_SHARE = 0.02
"""Share of the work below which no time left is guessed."""


@final
class _Bar:
    def __init__(self, bar: Progress, task: TaskID) -> None:
        self._bar, self._task = bar, task

    def __call__(self, stage: str, fraction: float) -> None:
        self._bar.update(self._task, description=stage, completed=min(max(fraction, 0.0), 1.0))
