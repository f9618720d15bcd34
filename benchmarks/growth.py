"""How cost grows: with samples, windows, runs, horizon and a transfer's windows.

    python benchmarks/growth.py [largest] [part ...]

largest = 1 (default) or a fraction of it for a quick look; parts: samples, windows, ensembles, optimum
(default: all). Prints tables; what was measured at full size is kept in growth.json, part by part, and
growth.svg is drawn from it. A time is the best of a few repetitions (other programs only add to it), and
the power is fitted to the last two decades.
"""

from __future__ import annotations

import gc
import json
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
from intermit.verify.schedule.excitation import excitation
from samples import BODY, CONSTANTS, PARAMETERS, UNIFORM, check_function, states
from trajectories import starts

Points = list[tuple[float, float]]
Series = dict[str, Points]
PICTURE, MEASURED = Path(__file__).with_name("growth.svg"), Path(__file__).with_name("growth.json")
REPETITIONS, ENOUGH = 5, 1.0
PARTS = ("samples", "windows", "ensembles", "optimum")
PANELS = ("samples", "windows", "runs of 16 s", "horizon, s", "windows of a transfer")
BLOCK = 1 << 14


def timed(work: Callable[[], object]) -> float:
    """Best time, s, of up to five repetitions or a second of them; no garbage is collected (as in timeit)."""
    best, spent, count = float("inf"), 0.0, 0
    while count < 1 or (count < REPETITIONS and spent < ENOUGH):
        gc.collect()
        gc.disable()
        began = time.perf_counter()
        work()
        seconds = time.perf_counter() - began
        gc.enable()
        best, spent, count = min(best, seconds), spent + seconds, count + 1
    return best


def power(points: Points) -> float:
    """Exponent of the least-squares line through the logarithms of the last two decades."""
    x, y = np.log(np.array(points).T)
    kept = x >= x[-1] - np.log(100.0) - 1e-9
    return float(np.polyfit(x[kept], y[kept], 1)[0]) if kept.sum() > 1 else float("nan")


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
        counts = (10**4, 10**5, 10**6, 10**7) if scale == 1.0 else (10**4, int(10**7 * scale))
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
    for count in (10, 100, 1000, 10**4, 10**5) if scale == 1.0 else (10, int(10**5 * scale)):
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
        for count in (10, 100, 1000, 10**4) if scale == 1.0 else (10, int(10**4 * scale)):
            x0 = starts(count)

            def runs(x: np.ndarray = x0, b: str = backend) -> object:
                return simulate_ensemble(LAW, J1, PAPER, x, horizon=Fraction(16), backend=b)

            by_count[backend].append((count, timed(runs)))
        for horizon in (8, 80, 800) if scale == 1.0 else (8, max(16, int(800 * scale))):

            def longer(h: int = horizon, b: str = backend) -> object:
                return simulate_ensemble(LAW, J1, PAPER, starts(100), horizon=Fraction(h), backend=b)

            by_horizon[backend].append((horizon, timed(longer)))
    return by_count, by_horizon


def optima() -> Series:
    """Minimum-peak transfers through more and more windows, built and solved."""
    from intermit.models.norms import EUCLIDEAN
    from intermit.optim.peak import SequentialConvex
    from optimum import ours

    points = []
    for count in (4, 7, 14, 28, 56):
        seconds, _ = ours(SequentialConvex(), EUCLIDEAN, f"{8 * (count - 1) + 3.22:.2f}")
        points.append((count, seconds))
    return {"convex programs, Euclidean": points}


def report(title: str, series: Series, notes: list[str]) -> None:
    """Seconds, and the power of the last two decades."""
    rows = []
    for name, points in series.items():
        (x0, y0), (x1, y1) = points[0], points[-1]
        rows.append([name, f"{x0:g}: {y0:.3g} s", f"{x1:g}: {y1:.3g} s", f"{power(points):.2f}"])
    table(f"Growth with {title}", ["cost of", "from", "to", "power"], rows, notes)


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


def measure(part: str, scale: float) -> dict[str, Series]:
    """The panels of one part; memory of the samples is printed with them."""
    notes: list[str] = []
    if part == "samples":
        series, notes = samples(scale)
        panels = {"samples": series}
    elif part == "windows":
        panels = {"windows": windows(scale)}
    elif part == "ensembles":
        by_count, by_horizon = ensembles(scale)
        panels = {"runs of 16 s": by_count, "horizon, s": by_horizon}
    else:
        panels = {"windows of a transfer": optima()}
    for title, found in panels.items():
        report(title, found, notes)
    return panels


def main() -> None:
    scale = float(sys.argv[1]) if len(sys.argv) > 1 else 1.0
    parts = sys.argv[2:] or list(PARTS)
    if unknown := set(parts) - set(PARTS):
        raise SystemExit(f"unknown part {sorted(unknown)[0]!r}; parts: {', '.join(PARTS)}")
    print(machine())
    kept = json.loads(MEASURED.read_text()) if MEASURED.exists() else {}
    for part in parts:
        kept |= measure(part, scale)
    if scale == 1.0:
        MEASURED.write_text(json.dumps(kept, indent=1) + "\n")
        draw({title: kept[title] for title in PANELS if title in kept})


if __name__ == "__main__":
    main()
