"""Start-up: whole processes, and the heavy modules each of them loads.

python benchmarks/startup.py [rounds]
"""

from __future__ import annotations

import statistics
import subprocess
import sys
import time
from pathlib import Path

from common import machine, table

HEAVY = "numpy casadi scipy cvxpy clarabel matplotlib flint pydantic rich jinja2 heyoka".split()  # noqa: SIM905
SCENARIO = Path(__file__).parent.parent / "examples" / "paper.toml"
CASES = {
    "python -c pass": ["-c", "pass"],
    "import intermit": ["-c", "import intermit"],
    "intermit --help": ["-m", "intermit", "--help"],
    "intermit check, the paper's scenario": ["-m", "intermit", "check", str(SCENARIO)],
}


def loaded(arguments: list[str]) -> list[str]:
    """Heavy modules a run imports, from the interpreter's own list."""
    run = subprocess.run(
        [sys.executable, "-X", "importtime", *arguments], capture_output=True, text=True, check=False
    )
    names = {line.rsplit("|", 1)[-1].strip().split(".")[0] for line in run.stderr.splitlines() if "|" in line}
    return [name for name in HEAVY if name in names]


def main() -> None:
    rounds = int(sys.argv[1]) if len(sys.argv) > 1 else 5
    times: dict[str, list[float]] = {name: [] for name in CASES}
    for _ in range(rounds):
        for name, arguments in CASES.items():
            began = time.perf_counter()
            subprocess.run([sys.executable, *arguments], capture_output=True, check=False)
            times[name].append(time.perf_counter() - began)
    rows = [
        [name, f"{1000 * statistics.median(times[name]):.0f}", ", ".join(loaded(arguments)) or "none"]
        for name, arguments in CASES.items()
    ]
    table("Start-up, whole process", ["what", "median, ms", "heavy modules loaded"], rows, [machine()])


if __name__ == "__main__":
    main()
