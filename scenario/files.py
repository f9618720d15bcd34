"""Reading what a user names: regular files, UTF-8, of bounded size."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from .errors import ScenarioError

MEGABYTE = 1024 * 1024
MAX_FILE = 10 * MEGABYTE
"""Bytes a scenario, CSV or law file may have: 10 MB, checked before it is read."""


def read_text(path: Path, where: str) -> str:
    """Return the text of a file.

    Parameters
    ----------
    path : Path
        The file.
    where : str
        How messages name it: the file the user gave, or the key that names it.

    Raises
    ------
    ScenarioError
        If it is missing, a directory, not a regular file, too large, unreadable or not UTF-8.
    """
    try:
        problem = _refusal(path.stat())
        if problem is None:
            with path.open("rb") as stream:
                raw = stream.read(MAX_FILE)
    except FileNotFoundError:
        problem = "no such file"
    except (OSError, ValueError) as error:
        reason = error.strerror if isinstance(error, OSError) and error.strerror else str(error)
        problem = f"cannot be read: {reason}"
    if problem is not None:
        raise ScenarioError(where, problem)
    try:
        return raw.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        raise ScenarioError(where, f"is not UTF-8 text (byte {error.start + 1})") from None


def _refusal(status: os.stat_result) -> str | None:
    """Return why a file is not read, or None if it may be."""
    if stat.S_ISDIR(status.st_mode):
        return "is a directory, expected a file"
    if not stat.S_ISREG(status.st_mode):
        return "is not a regular file"
    if status.st_size > MAX_FILE:
        limit = MAX_FILE // MEGABYTE
        return f"has {status.st_size / MEGABYTE:.1f} MB: files over {limit} MB are refused"
    return None
