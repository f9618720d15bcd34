"""Worker processes: fresh ones, with one BLAS thread each, deaf to the terminal's interrupt."""

from __future__ import annotations

import os
import signal
import sys
from collections.abc import Callable, Iterator
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from contextlib import contextmanager
from multiprocessing import active_children, get_context, parent_process
from multiprocessing.connection import wait
from threading import Thread, current_thread, main_thread
from types import ModuleType
from typing import ParamSpec, TypeVar, final

from .threads import one_thread_each

P = ParamSpec("P")
T = TypeVar("T")


@contextmanager
def executor_of(workers: int) -> Iterator[Executor | None]:
    """Processes that share independent work; None for one worker, which is this process.

    Leaving waits for them; an error or interrupt ends them at once.
    """
    if workers < 2:
        yield None
        return
    others = set(active_children())
    executor = _Workers(workers, mp_context=get_context("spawn"), initializer=begin_work)
    try:
        yield executor
    except BaseException:
        for process in set(active_children()) - others:
            process.terminate()
        raise
    finally:
        executor.shutdown(cancel_futures=True)


@final
class _Workers(ProcessPoolExecutor):
    """Starts a process when work is handed in and none is idle: always in the right scene."""

    def submit(self, fn: Callable[P, T], /, *args: P.args, **kwargs: P.kwargs) -> Future[T]:
        with starting_workers():
            return super().submit(fn, *args, **kwargs)


@contextmanager
def starting_workers() -> Iterator[None]:
    """Set the scene in which processes are started: what they inherit is right for workers.

    They get one BLAS thread and ignore SIGINT from their first instant. They do not run the user's
    program again: a script that calls this package needs no `if __name__ == "__main__"`. What they are
    sent is defined in this package, never in the user's program.
    """
    program = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        with one_thread_each(), _sigint_ignored():
            yield
    finally:
        sys.modules["__main__"] = program


@contextmanager
def _sigint_ignored() -> Iterator[None]:
    """Ignore interrupts for a moment; only the main thread can."""
    if current_thread() is not main_thread():
        yield
        return
    handler = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, handler)


def begin_work() -> None:
    """Workers ignore SIGINT, the parent stops them; and they end with it, however it ends."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()
    if parent is not None:
        Thread(target=_end_with, args=(parent.sentinel,), daemon=True).start()


def _end_with(sentinel: int) -> None:
    """Leave at once when the parent is gone: a killed one cannot stop its workers."""
    wait([sentinel])
    os._exit(1)
