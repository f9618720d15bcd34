"""The laws of a scenario one after the other, or in a few processes; the findings are the same."""

from __future__ import annotations

import os
import signal
from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from multiprocessing import get_context
from typing import final

from ..scenario import LawChoice, Scenario
from .case import CaseOptions, Findings, find
from .run import Seen

Job = tuple[Scenario, LawChoice, Seen, CaseOptions]
Progress = Callable[[str, float], None]

START = 0.1
"""Share of a check that is done before the jobs begin."""
THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""What a BLAS reads when it is loaded; a user's own setting is kept."""


def find_all(jobs: Sequence[Job], workers: int, tell: Progress) -> list[Findings]:
    """Carry out the jobs; findings in their order."""
    if workers > 1 and len(jobs) > 1:
        return _in_processes(jobs, min(workers, len(jobs)), tell)
    width = (1 - START) / max(len(jobs), 1)
    return [find(*job, _Part(tell, job[1].label, START + width * i, width)) for i, job in enumerate(jobs)]


def _in_processes(jobs: Sequence[Job], workers: int, tell: Progress) -> list[Findings]:
    """Fresh processes (nothing is forked that holds a thread); leaving the block ends them."""
    findings = []
    with _one_thread_each(), get_context("spawn").Pool(workers, initializer=_ignore_interrupt) as pool:
        waiting = [pool.apply_async(find, job) for job in jobs]
        for number, (job, result) in enumerate(zip(jobs, waiting, strict=True)):
            tell(f"{job[1].label}: proofs and samples", START + (1 - START) * number / len(jobs))
            findings.append(result.get())
    return findings


@contextmanager
def _one_thread_each() -> Iterator[None]:
    """Start new processes with one BLAS thread: on small matrices more only get in each other's way."""
    missing = [name for name in THREADS if name not in os.environ]
    os.environ.update(dict.fromkeys(missing, "1"))
    try:
        yield
    finally:
        for name in missing:
            del os.environ[name]


def _ignore_interrupt() -> None:
    """An interrupt is for the parent, which ends its workers."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)


@final
@dataclass(frozen=True)
class _Part:
    """Progress of one job as part of the whole."""

    tell: Progress
    label: str
    start: float
    width: float

    def __call__(self, stage: str, fraction: float) -> None:
        self.tell(f"{self.label}: {stage}", self.start + self.width * fraction)
