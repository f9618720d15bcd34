"""How cost grows: with samples, windows, runs and horizon; tables, and benchmarks/growth.svg.

python benchmarks/growth.py [largest]     largest = 1 (default) or a fraction of it for a quick look
"""

from __future__ import annotations

import sys
import time
import tracemalloc
from collections.abc import Callable, Iterator
from fractions import Fraction
from functools import partial
from pathlib import Path

import numpy as np
from common import J1, LAW, PAPER, machine, need, table
from intermit.models.ensemble import simulate_ensemble
from intermit.models.lowering import BlockFunction, heyoka_available, sample_function, shared, walk
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify.excitation import excitation
from samples import BODY, CONSTANTS, PARAMETERS, UNIFORM, check_function, states
from trajectories import starts

Series = dict[str, list[tuple[float, float]]]
PICTURE = Path(__file__).with_name("growth.svg")
BLOCK = 1 << 14


def timed(work: Callable[[], object]) -> float:
    began = time.perf_counter()
    work()
    return time.perf_counter() - began


def blocks(count: int) -> Iterator[tuple[np.ndarray, ...]]:
    x = states(BLOCK)
    for start in range(0, count, BLOCK):
        size = min(BLOCK, count - start)
        yield x[:, :size], PARAMETERS, BODY, CONSTANTS


def samples(scale: float) -> tuple[Series, list[str]]:
    """Streamed samples, reduced to their worst value; and the memory they take."""
    function, series, notes = shared(walk(check_function())), {}, []

    def worst(many: BlockFunction, count: int) -> float:
        return max(float(r[1].max()) for r in many.stream(blocks(count)))

    for backend in ["default", "fast"] if heyoka_available() else ["default"]:
        many = sample_function(function, uniform=UNIFORM, backend=backend)
        worst(many, 10)
        counts = (10**4, 10**5, 10**6, int(10**7 * scale))
        series[backend] = [(n, timed(partial(worst, many, n))) for n in counts]
    many = sample_function(function, uniform=UNIFORM)
    for count in (10**5, 10**6):
        tracemalloc.start()
        worst(many, count)
        most = tracemalloc.get_traced_memory()[1] / 1e6
        notes.append(f"{count} streamed samples allocate {most:.1f} MB at most")
        tracemalloc.stop()
    return series, notes


def windows(scale: float) -> Series:
    """A table of windows, no two alike in spacing: built, integrated, its excitation constants enclosed."""
    series: Series = {"schedule and exact integral": [], "excitation constants": []}
    for count in (10, 100, 1000, 10**4, int(10**5 * scale)):
        rng = np.random.default_rng(0)
        gaps = [Fraction(int(g), 100) for g in rng.integers(400, 600, count)]

        def build(gaps: list[Fraction] = gaps) -> object:
            at, table_of = Fraction(0), []
            for gap in gaps:
                table_of.append(Window(at + gap, at + gap + Fraction(16, 5)))
                at += gap + Fraction(16, 5)
            schedule = build_schedule(table_of, Hermite())
            schedule.square_integral(Fraction(0), schedule.end)
            return schedule

        series["schedule and exact integral"].append((count, timed(build)))
        schedule = build()
        series["excitation constants"].append((count, timed(lambda s=schedule: excitation(s, Fraction(20)))))
    return series


def ensembles(scale: float) -> tuple[Series, Series]:
    """Runs of 16 s against their number, and 100 runs against the horizon; final states only."""
    backends = ["default", "fast"] if heyoka_available() else ["default"]
    by_count: Series = {b: [] for b in backends}
    by_horizon: Series = {b: [] for b in backends}
    for backend in backends:
        simulate_ensemble(LAW, J1, PAPER, starts(8), horizon=Fraction(8), backend=backend)
        for count in (10, 100, 1000, int(10**4 * scale)):
            x0 = starts(count)

            def runs(x: np.ndarray = x0, b: str = backend) -> object:
                return simulate_ensemble(LAW, J1, PAPER, x, horizon=Fraction(16), backend=b)

            by_count[backend].append((count, timed(runs)))
        for horizon in (8, 80, int(800 * scale)):

            def longer(h: int = horizon, b: str = backend) -> object:
                return simulate_ensemble(LAW, J1, PAPER, starts(100), horizon=Fraction(h), backend=b)

            by_horizon[backend].append((horizon, timed(longer)))
    return by_count, by_horizon


def optima() -> Series:
    """Minimum-peak transfers through more and more windows, built and solved."""
    from intermit.optim.norms import Euclidean
    from intermit.optim.peak import SequentialConvex
    from optimum import ours

    points = []
    for count in (4, 7, 14, 28, 56):
        seconds, _ = ours(SequentialConvex(), Euclidean(), f"{8 * (count - 1) + 3.22:.2f}")
        points.append((count, seconds))
    return {"convex programs, Euclidean": points}


def report(title: str, unit: str, series: Series, notes: list[str] | None = None) -> None:
    """Seconds, and the power of the last tenfold."""
    sizes = [x for x, _ in next(iter(series.values()))]
    rows = []
    for name, points in series.items():
        (x0, y0), (x1, y1) = points[-2:]
        power = np.log(y1 / y0) / np.log(x1 / x0) if x1 > x0 else np.nan
        rows.append([name, *(f"{y:.3g}" for _, y in points), f"{power:.2f}"])
    table(title, [unit, *(f"{x:g}" for x in sizes), "last power"], rows, notes or [])


def draw(panels: dict[str, Series]) -> None:
    pyplot = need("matplotlib.pyplot")
    figure, axes = pyplot.subplots(2, 3, figsize=(12, 6.5), layout="constrained")
    for unused in axes.ravel()[len(panels) :]:
        unused.set_axis_off()
    for axis, (title, series) in zip(axes.ravel(), panels.items(), strict=False):
        for name, points in series.items():
            x, y = np.array(points).T
            axis.loglog(x, y, "o-", label=name)
        x = np.array([p[0] for p in points])
        axis.loglog(x, y[-1] * x / x[-1], ":", color="grey", label="linear")
        axis.set_xlabel(title)
        axis.set_ylabel("seconds")
        axis.grid(True, which="major", alpha=0.3)
        axis.legend(frameon=False, fontsize=8)
    figure.savefig(PICTURE)


def main() -> None:
    scale = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
    print(machine())
    by_samples, notes = samples(scale)
    report("Growth with samples, seconds", "samples", by_samples, notes)
    by_windows = windows(scale)
    report("Growth with windows, seconds", "windows", by_windows)
    by_count, by_horizon = ensembles(scale)
    report("Growth with runs (16 s each), seconds", "runs", by_count)
    report("Growth with the horizon (100 runs), seconds", "horizon, s", by_horizon)
    by_transfer = optima()
    report("Growth of the optimum with windows, seconds", "windows", by_transfer)
    draw(
        {
            "samples": by_samples,
            "windows": by_windows,
            "runs of 16 s": by_count,
            "horizon, s": by_horizon,
            "windows of a transfer": by_transfer,
        }
    )


if __name__ == "__main__":
    main()
