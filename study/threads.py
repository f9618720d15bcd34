"""One BLAS thread a process: on small matrices more only get in each other's way.

Where another program has the second core, they wait for each other at every product: an optimum was seen
to take two to nine times as long.
"""

from __future__ import annotations

import os
from collections.abc import Iterator
from contextlib import contextmanager

THREADS = ("OPENBLAS_NUM_THREADS", "OMP_NUM_THREADS", "MKL_NUM_THREADS")
"""What a BLAS reads when it is loaded; a user's own setting is kept."""


def one_thread() -> None:
    """Keep this process to one BLAS thread, if no BLAS is loaded yet."""
    for name in THREADS:
        os.environ.setdefault(name, "1")


@contextmanager
def one_thread_each() -> Iterator[None]:
    """Start new processes with one BLAS thread each."""
    missing = [name for name in THREADS if name not in os.environ]
    one_thread()
    try:
        yield
    finally:
        for name in missing:
            del os.environ[name]
