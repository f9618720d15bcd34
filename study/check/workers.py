"""The laws of a scenario in parts, by this process and perhaps a few more; the findings are the same.

Of each law first what exact means decide, then its margins, then its samples. This process works
too: the others take from the same list whatever is next.
"""

from __future__ import annotations

from collections.abc import Callable, Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass
from functools import partial
from heapq import heappop, heappush
from multiprocessing import get_context
from multiprocessing.pool import Pool
from queue import Empty, SimpleQueue
from threading import Lock
from typing import Any, final

from ...models.types import Progress
from ...scenario import LawChoice, Scenario
from ...verify.verdict import Quantity
from ..pool import begin_work, starting_workers
from ..simulated_run import RunFigures
from .case import CaseOptions, Decided, Findings, Sampled, decide, findings, margins, samples

START = 0.1
"""Share of a check that is done before the jobs begin."""
PARTS: dict[str, Callable[..., Any]] = {"proofs": decide, "margins": margins, "samples": samples}
"""Parts of a law's job, in the order in which they are best begun: the longer ones first."""
POLL_SECONDS = 0.5
"""Seconds after which a wait for the others is begun anew, so that an interrupt is noticed everywhere."""


@final
@dataclass
class _Job:
    """One law: what it is asked, and what is known of it so far."""

    label: str
    scenario: Scenario
    choice: LawChoice
    decided: Decided | None = None
    margins: tuple[Quantity, ...] | None = None
    samples: Sampled | None = None

    @property
    def is_done(self) -> bool:
        """Whether every part that is asked of it was found."""
        if self.decided is None or self.samples is None:
            return False
        return self.margins is not None or not self.decided.has_margins

    def findings(self) -> Findings:
        """All parts together."""
        assert self.decided is not None and self.samples is not None  # noqa: PT018
        return findings(self.decided, self.margins or (), self.samples)


@final
class WorkerPool:
    """Carries out the jobs of several laws.

    A job may be handed over before the next one is known: other processes begin at once, this one in
    `findings`.
    """

    def __init__(self, pool: Pool | None, others: int, expected: int, tell: Progress) -> None:
        self._pool, self._idle, self._tell = pool, others, tell
        self._expected, self._done = max(expected, 1), 0
        self._jobs: list[_Job] = []
        self._ready: list[tuple[int, int, tuple[Any, ...]]] = []
        self._lock, self._news = Lock(), SimpleQueue[BaseException | None]()

    def add(self, scenario: Scenario, choice: LawChoice, seen: RunFigures, options: CaseOptions) -> None:
        """Hand over one law."""
        with self._lock:
            self._jobs.append(_Job(choice.label, scenario, choice))
            self._put("proofs", len(self._jobs) - 1, scenario, choice, seen, options)
        self._feed()

    def findings(self) -> list[Findings]:
        """Work until all is found; findings in the order in which the laws were handed over."""
        while not all(job.is_done for job in self._jobs):
            task = self._take()
            if task is not None:
                part, number, arguments = task
                self._record(part, number, _perform(part, arguments, self._progress(part, number)))
                self._feed()
                continue
            try:
                failure = self._news.get(timeout=POLL_SECONDS)
            except Empty:
                continue
            if failure is not None:
                raise failure
        return [job.findings() for job in self._jobs]

    def done(self) -> list[tuple[int, Findings]]:
        """Numbers and findings of the laws of which all is found already."""
        return [(i, job.findings()) for i, job in enumerate(self._jobs) if job.is_done]

    def _put(self, part: str, number: int, *arguments: Any) -> None:
        heappush(self._ready, (list(PARTS).index(part), number, arguments))

    def _take(self, *, away: bool = False) -> tuple[str, int, tuple[Any, ...]] | None:
        """Take what is next: for this process, or for one of the others if one is idle."""
        with self._lock:
            if not self._ready or (away and not self._idle):
                return None
            self._idle -= away
            place, number, arguments = heappop(self._ready)
        return list(PARTS)[place], number, arguments

    def _feed(self) -> None:
        """Give the other processes what they can take."""
        while self._pool is not None and (task := self._take(away=True)) is not None:
            part, number, arguments = task
            self._pool.apply_async(
                _perform, (part, arguments), callback=partial(self._arrived, part, number),
                error_callback=self._news.put,
            )  # fmt: skip

    def _arrived(self, part: str, number: int, result: Any) -> None:
        """Take a result from another process; called by the pool's own thread."""
        self._record(part, number, result)
        with self._lock:
            self._idle += 1
        self._feed()
        self._news.put(None)

    def _record(self, part: str, number: int, result: Any) -> None:
        """Keep what was found, and hand out what can now be done."""
        job = self._jobs[number]
        with self._lock:
            if part == "margins":
                job.margins = result
            elif part == "samples":
                job.samples = result
            else:
                job.decided = result
                if result.has_margins:
                    self._put("margins", number, job.scenario, job.choice)
                self._put("samples", number, job.scenario, job.choice, result.reference_floor)
            self._done += 1

    def _progress(self, part: str, number: int) -> Progress:
        label, parts = self._jobs[number].label, len(PARTS) * self._expected

        def tell(stage: str, fraction: float) -> None:
            self._tell(f"{label}: {stage}", START + (1 - START) * min((self._done + fraction) / parts, 1.0))

        tell(part, 0.0)
        return tell


def _perform(part: str, arguments: Sequence[Any], tell: Progress | None = None) -> Any:
    work = PARTS[part]
    if part == "samples":
        return work(*arguments, lambda done: tell("samples of V'", done) if tell is not None else None)
    return work(*arguments, tell) if part == "proofs" else work(*arguments)


@contextmanager
def crew(jobs: int, workers: int, tell: Progress) -> Iterator[WorkerPool]:
    """A crew of `workers` processes, this one among them, for so many laws; leaving ends the others.

    The others are fresh processes: nothing is forked that holds a thread.
    """
    others = min(workers, jobs) - 1
    if others < 1:
        yield WorkerPool(None, 0, jobs, tell)
        return
    with starting_workers():
        pool = get_context("spawn").Pool(others, initializer=begin_work)
    with pool:
        yield WorkerPool(pool, others, jobs, tell)
