"""What the benchmarks share: contenders that take turns, medians, and a table with accuracy beside."""

from __future__ import annotations

import os

os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")  # one thread: methods are compared, not cores
os.environ.setdefault("OMP_NUM_THREADS", "1")

import gc
import statistics
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import Any

from intermit.models.laws import AdaptiveScaling
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
PAPER = build_schedule(
    [Window(Fraction("0.01"), Fraction("3.21"))], Hermite(Fraction("0.01")), period=Fraction(8)
)
LAW = AdaptiveScaling(Fraction("0.525"), Fraction("0.1"), Fraction(1), Fraction("0.2"))


class Missing(Exception):  # noqa: N818 - it is no error
    """A competitor that is not installed."""


@dataclass(frozen=True)
class Contender:
    """One way of doing the work.

    `prepare` builds it and gives the callable that is timed; it raises `Missing` with the name of
    what is not installed. The callable does `share` of the work (slow ones do less of it).
    """

    name: str
    prepare: Callable[[], Callable[[], Any]]
    share: float = 1.0


@dataclass(frozen=True)
class Time:
    """Times of one contender: each round's, s, scaled to the whole work, and its set-up."""

    name: str
    rounds: list[float]
    setup: float
    answer: Any

    @property
    def median(self) -> float:
        """Median round, s."""
        return statistics.median(self.rounds)


def race(contenders: Sequence[Contender], rounds: int) -> tuple[list[Time], list[str]]:
    """Let all take turns, `rounds` times over; who is missing is named."""
    runners: list[tuple[Contender, Callable[[], Any], float]] = []
    missing: list[str] = []
    for contender in contenders:
        began = time.perf_counter()
        try:
            run = contender.prepare()
        except Missing as absent:
            missing.append(f"{contender.name}: skipped, {absent} is not installed")
            continue
        run()  # whatever is compiled or cached at the first call belongs to the set-up
        runners.append((contender, run, time.perf_counter() - began))
    times: list[list[float]] = [[] for _ in runners]
    answers: list[Any] = [None] * len(runners)
    for _ in range(rounds):
        for i, (contender, run, _) in enumerate(runners):
            gc.collect()
            began = time.perf_counter()
            answers[i] = run()
            times[i].append((time.perf_counter() - began) / contender.share)
    results = [Time(c.name, t, s, a) for (c, _, s), t, a in zip(runners, times, answers, strict=True)]
    return results, missing


def table(
    title: str, headings: Sequence[str], rows: Sequence[Sequence[str]], notes: Sequence[str] = ()
) -> None:
    """Print a table in Markdown."""
    widths = [max(len(str(r[i])) for r in [headings, *rows]) for i in range(len(headings))]

    def line(cells: Sequence[str]) -> str:
        return "| " + " | ".join(str(c).ljust(w) for c, w in zip(cells, widths, strict=True)) + " |"

    print(f"\n### {title}\n")
    print(line(headings))
    print("|" + "|".join("-" * (w + 2) for w in widths) + "|")
    for row in rows:
        print(line(row))
    for note in notes:
        print(f"\n{note}")
    print(flush=True)


def machine() -> str:
    """The machine in one line, for the figures' sake."""
    import platform

    import casadi
    import numpy
    import scipy

    model = platform.processor() or platform.machine()
    try:
        with open("/proc/cpuinfo") as info:
            model = next(line.split(":")[1].strip() for line in info if line.startswith("model name"))
    except (OSError, StopIteration):
        pass
    versions = f"numpy {numpy.__version__}, scipy {scipy.__version__}, casadi {casadi.__version__}"
    load = os.getloadavg()[0]
    return (
        f"{model}, {os.cpu_count()} cores (load {load:.1f}), Python {platform.python_version()}, {versions}"
    )


def need(module: str) -> Any:
    """Import a competitor, or say that it is missing."""
    import importlib

    try:
        return importlib.import_module(module)
    except ImportError:
        raise Missing(module) from None
