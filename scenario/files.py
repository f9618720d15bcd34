"""Reading what a user names: regular files, UTF-8, of bounded size."""

from __future__ import annotations

import os
import stat
from pathlib import Path

from .errors import ScenarioError

MEGABYTE = 1024 * 1024
UTF16_MARKS, UTF32_MARKS = (b"\xff\xfe", b"\xfe\xff"), (b"\xff\xfe\x00\x00", b"\x00\x00\xfe\xff")
MAX_FILE = 10 * MEGABYTE
"""Bytes a scenario, CSV or law file may have: 10 MB, checked before it is read."""


def read_text(path: Path, where: str, *, wide: bool = False) -> str:
    """Return the text of a file: UTF-8, or UTF-16 with its byte order mark if `wide`.

    Parameters
    ----------
    path : Path
        The file.
    where : str
        How messages name it: the file the user gave, or the key that names it.
    wide : bool
        Whether UTF-16 is read too, as spreadsheets on Windows write it.

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
    utf16 = raw.startswith(UTF16_MARKS) and not raw.startswith(UTF32_MARKS)
    try:
        return raw.decode("utf-16" if wide and utf16 else "utf-8-sig")
    except UnicodeDecodeError as error:
        kind = "UTF-16 text" if utf16 else f"not UTF-8 text (byte {error.start + 1})"
        raise ScenarioError(where, f"is {kind}: save it as UTF-8") from None


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
