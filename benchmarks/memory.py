"""The whole derivative check of very many samples: time, and the most memory the process ever held.

    python benchmarks/memory.py [samples]

The default, 2^24, takes seconds; 1000000000 takes some minutes and the same memory.
"""

from __future__ import annotations

import resource
import sys
import time

from common import machine, table
from samples import derivative_check


def peak() -> float:
    """Most resident memory of this process so far, MB (Linux counts in kB, macOS in bytes)."""
    most = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    return most / (1e6 if sys.platform == "darwin" else 1e3)


def main() -> None:
    count = int(sys.argv[1]) if len(sys.argv) > 1 else 1 << 24
    rows = []
    for number in (1 << 16, count):
        began = time.perf_counter()
        found = derivative_check(number)
        seconds = time.perf_counter() - began
        tallied = int(found.counts.sum())
        rows.append(
            [
                f"{tallied}",
                f"{seconds:.1f}",
                f"{number / seconds / 1e6:.2f}",
                f"{peak():.0f}",
                f"{found.violations}",
                f"{found.sampled_worst:.6f}",
            ]
        )
    table(
        "Memory of the whole derivative check, one thread",
        ["samples", "s", "million samples/s", "peak memory so far, MB", "V' > 0", "least -V'/W, 1/s"],
        rows,
        [machine()],
    )


if __name__ == "__main__":
    main()
