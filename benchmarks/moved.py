"""Tables moved in time: time and memory of check and optimum beside those of the unmoved table.

    python benchmarks/moved.py [tables]

Each measurement is a process of its own, least of two rounds. A table that stands at 1.76e9 s, with the run
started there (`initial.time`) or years before (at rest), shall take no more than 1.2 times as much.
"""

from __future__ import annotations

import os
import resource
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
from common import machine, table

SHIFTS = (0, 1000, 1_000_000, 1_760_000_000)
ROUNDS = 2
LIMIT = 1.2
SCENARIO = """
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]
[schedule]
windows = [{windows}]
[initial]
time = {start}
axis = [1, 2, 3]
angle_deg = 80
[[law]]
type = "quaternion-pd"
proportional = 0.4
derivative = 1.5
[simulation]
horizon = {horizon}
[check]
samples = 4096
[optimum]
final_time = {horizon}
starts = 1
"""


def written(folder: Path, seed: int, shift: int, start: int) -> Path:
    """A random irregular table, moved, as a scenario file."""
    rng = np.random.default_rng(seed)
    at, windows = 1.0, []
    for _ in range(4):
        length = rng.integers(500, 4000) / 1000
        windows.append((at, at + length))
        at += length + rng.integers(500, 4000) / 1000
    path = folder / f"{seed}-{shift}-{start}.toml"
    edges = ", ".join(f"[{a + shift:.3f}, {b + shift:.3f}]" for a, b in windows)
    path.write_text(SCENARIO.format(windows=edges, start=start, horizon=f"{at + shift:.3f}"))
    return path


def measured(command: str, path: Path) -> tuple[float, float]:
    """Least seconds of processor time of the rounds, and most megabytes, of one command."""
    seconds, memory = [], []
    for _ in range(ROUNDS):
        process = subprocess.Popen(
            [sys.executable, "-m", "intermit", command, str(path)],
            stdout=subprocess.DEVNULL,
            stderr=subprocess.DEVNULL,
        )
        _, _, used = os.wait4(process.pid, 0)
        seconds.append(used.ru_utime + used.ru_stime)
        memory.append(_megabytes(used))
    return min(seconds), max(memory)


def _megabytes(used: resource.struct_rusage) -> float:
    return used.ru_maxrss / (1e6 if sys.platform == "darwin" else 1e3)


def main() -> int:
    """Print the table; 1 if a moved table took more than the limit."""
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 3
    rows, worst = [], 0.0
    with tempfile.TemporaryDirectory() as name:
        for seed in range(count):
            for command in ("check", "optimum"):
                still = measured(command, written(Path(name), seed, 0, 0))
                for shift in SHIFTS[1:]:
                    for start in (shift, 0):
                        found = measured(command, written(Path(name), seed, shift, start))
                        ratios = [a / b for a, b in zip(found, still, strict=True)]
                        worst = max(worst, *ratios)
                        rows.append(
                            [
                                f"{seed}",
                                command,
                                f"{shift:.3g} s",
                                "with the table" if start else "at 0 s",
                                f"{found[0]:.2f} ({ratios[0]:.2f})",
                                f"{found[1]:.0f} ({ratios[1]:.2f})",
                            ]
                        )
    headings = ["table", "command", "moved by", "run starts", "s (ratio)", "MB (ratio)"]
    table("Tables moved in time", headings, rows, [f"Largest ratio {worst:.2f}.", machine()])
    return int(worst > LIMIT)


if __name__ == "__main__":
    raise SystemExit(main())
