"""Notes which functions are reached, where INTERMIT_REACHED names a folder (see `reached.py`)."""

import os
from pathlib import Path

import reached

FOLDER = os.environ.get("INTERMIT_REACHED")
if FOLDER:
    reached.install()


def pytest_sessionfinish() -> None:
    if FOLDER:
        reached.write(Path(FOLDER))
