"""All benchmarks, one after another: `make bench`."""

from __future__ import annotations

import subprocess
import sys
from pathlib import Path

HERE = Path(__file__).parent
ORDER = ("samples.py", "memory.py", "trajectories.py", "optimum.py", "startup.py", "growth.py", "moved.py")


def main() -> int:
    """Run each in its own process, so that none inherits another's caches; 1 if any of them failed."""
    failed = []
    for name in ORDER:
        print(f"\n## {name}", flush=True)
        if not (HERE / name).exists():
            print(f"{name}: not here")
            continue
        if subprocess.run([sys.executable, HERE / name], check=False).returncode:
            failed.append(name)
    if failed:
        print(f"failed: {', '.join(failed)}", file=sys.stderr)
    return int(bool(failed))


if __name__ == "__main__":
    raise SystemExit(main())
