"""Write a report's folder whole or not at all, and never over files that are somebody else's.

The files go into a hidden folder beside the target, which then takes the target's name in one
step. A `manifest.json` says which files were written, with their hashes: a folder without it, or
with a file that is not in it or was changed since, is not replaced unless told to; and then its
other files stay.
"""

from __future__ import annotations

import ctypes
import hashlib
import json
import os
import shutil
import sys
from collections.abc import Mapping
from pathlib import Path, PurePosixPath
from tempfile import mkdtemp

from ..errors import InputError
from .whole_files import write_whole

MANIFEST = "manifest.json"
_AT_FDCWD = -100
_RENAME_EXCHANGE = 2


class FolderError(InputError):
    """The target cannot be written without losing something that is not this package's."""


def write_folder(
    target: str | Path,
    files: Mapping[str, bytes],
    *,
    extras: Mapping[str, bytes] | None = None,
    force: bool = False,
) -> Path:
    """Write files (by relative path with "/") as the folder `target`, all at once.

    Parameters
    ----------
    target : path
        The folder; created with its parents, replaced if this package wrote all of it.
    files, extras : mapping of path to bytes
        What to write; `extras` are those a rebuild must carry over (certificates, say).
    force : bool
        Write into a folder that holds other files: they stay unless they have the same name.

    Raises
    ------
    FolderError
        If the target is a file or holds something this package did not write.
    """
    folder = Path(os.path.realpath(target))
    everything = dict(extras or {}) | dict(files)
    everything[MANIFEST] = manifest(everything, tuple(extras or {}))
    reason = refuse(folder, force=force)
    folder.parent.mkdir(parents=True, exist_ok=True)
    partial = Path(mkdtemp(prefix=f".{folder.name}.", suffix=".partial", dir=folder.parent))
    try:
        _fill(partial, everything, folder)
        partial.chmod(0o755)
        if reason:
            _merge(partial, folder)
        else:
            _swap(partial, folder)
    finally:
        shutil.rmtree(partial, ignore_errors=True)
    return folder


def refuse(target: str | Path, *, force: bool = False) -> str:
    """Say before the work whether the target will be refused; returns what is foreign in it, if forced.

    Raises
    ------
    FolderError
        As `write_folder` would.
    """
    folder = Path(os.path.realpath(target))
    if folder.exists() and not folder.is_dir():
        raise FolderError(f"{folder} is a file; give a folder to write the report into")
    reason = foreign(folder)
    if reason and not force:
        raise FolderError(f"{folder} {reason}; give another folder, or --force to write among them")
    return reason


def manifest(files: Mapping[str, bytes], extras: tuple[str, ...] = ()) -> bytes:
    """List the files with their hashes."""
    hashes = {name: hashlib.sha256(data).hexdigest() for name, data in files.items()}
    document = {"format": "intermit-report", "files": hashes, "extras": sorted(extras)}
    return (json.dumps(document, indent=1, sort_keys=True) + "\n").encode()


def read_extras(folder: str | Path) -> dict[str, bytes]:
    """Read what a rebuild carries over: the files its manifest calls extras, if unchanged."""
    listed = _listed(Path(folder))
    if listed is None:
        return {}
    hashes, extras = listed
    found = {}
    for name in extras:
        path = Path(folder) / name
        data = path.read_bytes() if path.is_file() and _inside(name) else b""
        if hashlib.sha256(data).hexdigest() == hashes.get(name):
            found[name] = data
    return found


def foreign(folder: Path) -> str:
    """Why a folder is not this package's to replace; "" if it is (or is empty, or does not exist)."""
    if not folder.is_dir() or not any(folder.iterdir()):
        return ""
    listed = _listed(folder)
    if listed is None:
        return "was not written by intermit report"
    hashes, _ = listed
    for path in sorted(folder.rglob("*")):
        name = path.relative_to(folder).as_posix()
        if path.is_symlink() or (not path.is_dir() and name != MANIFEST and name not in hashes):
            return f"holds {name!r}, which intermit did not write"
        if (
            path.is_file()
            and name in hashes
            and hashlib.sha256(path.read_bytes()).hexdigest() != hashes[name]
        ):
            return f"holds {name!r}, which was changed since intermit wrote it"
    return ""


def _listed(folder: Path) -> tuple[dict[str, str], list[str]] | None:
    try:
        document = json.loads((folder / MANIFEST).read_text(encoding="utf-8"))
        if document["format"] != "intermit-report":
            return None
        return dict(document["files"]), [str(e) for e in document["extras"]]
    except (OSError, ValueError, KeyError, TypeError, RecursionError):
        return None


def _inside(name: str) -> bool:
    path = PurePosixPath(name)
    return not path.is_absolute() and ".." not in path.parts


def _fill(folder: Path, files: Mapping[str, bytes], goal: Path) -> None:
    """Write files into a folder that will become, or go into, the goal."""
    for name in sorted(files):
        if not _inside(name):
            raise FolderError(f"{name!r} would be outside the report")
        path = folder / name
        path.parent.mkdir(parents=True, exist_ok=True)
        write_whole(path, files[name], named=goal / name)


def _merge(partial: Path, folder: Path) -> None:
    """Move file by file into a folder that has others."""
    for path in sorted(p for p in partial.rglob("*") if p.is_file()):
        goal = folder / path.relative_to(partial)
        goal.parent.mkdir(parents=True, exist_ok=True)
        os.replace(path, goal)


def _swap(partial: Path, folder: Path) -> None:
    """Give the new folder the target's name in one step; the old one ends up under the hidden name."""
    if not folder.exists():
        os.rename(partial, folder)
        return
    if _exchange(partial, folder):
        return
    old = partial.with_suffix(".old")
    os.rename(folder, old)
    try:
        os.rename(partial, folder)
    except OSError:
        os.rename(old, folder)
        raise
    shutil.rmtree(old, ignore_errors=True)


def _exchange(one: Path, other: Path) -> bool:
    """Exchange two names atomically where the system can (Linux); False where it cannot."""
    if not sys.platform.startswith("linux"):
        return False
    try:
        renameat2 = ctypes.CDLL(None, use_errno=True).renameat2
    except (OSError, AttributeError):
        return False
    names = (os.fsencode(one), os.fsencode(other))
    return int(renameat2(_AT_FDCWD, names[0], _AT_FDCWD, names[1], _RENAME_EXCHANGE)) == 0
