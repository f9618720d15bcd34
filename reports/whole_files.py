"""Files that are there whole or not at all: written beside their place, then moved into it in one step."""

from __future__ import annotations

import os
from contextlib import suppress
from pathlib import Path


def write_whole(path: Path, data: bytes | str, *, new: bool = False, named: Path | None = None) -> None:
    """Write a file beside its place and move it there; on failure nothing is left behind.

    Parameters
    ----------
    path : Path
        Where it goes.
    data : bytes | str
        Text is written as UTF-8.
    new : bool
        Refuse a place that is taken.
    named : Path, optional
        What an error calls it; the path itself without it.

    Raises
    ------
    OSError
        Naming the file, if it cannot be written (a full disk, no permission, no such folder, or taken).
    """
    partial = path.with_name(f".{path.name}.{os.getpid()}.part")
    try:
        partial.write_bytes(data.encode() if isinstance(data, str) else data)
        if new:
            os.link(partial, path)  # unlike a rename it fails where something stands
            partial.unlink()
        else:
            os.replace(partial, path)
    except BaseException as error:
        with suppress(OSError):
            partial.unlink(missing_ok=True)
        if isinstance(error, OSError):
            raise OSError(error.errno, error.strerror or str(error), str(named or path)) from error
        raise
