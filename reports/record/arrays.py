"""The arrays of a record: checked, packed into the same bytes whenever they are the same, and read back."""

from __future__ import annotations

import hashlib
import io
import zipfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ...errors import InputError
from .document import ArrayEntry

Array = NDArray[np.float64]


class RecordError(InputError):
    """The record does not have the form its classes demand, or its files do not belong together."""


def frozen_array(name: str, value: ArrayLike) -> Array:
    """Copy an array as read-only little-endian float64.

    Raises
    ------
    RecordError
        If it holds NaN or -inf, or has no dimension.
    """
    array = np.array(value, dtype="<f8", order="C", copy=True)
    if array.ndim == 0 or not np.all(np.isfinite(array) | np.isposinf(array)):
        raise RecordError(f"array {name!r}: expected at least one dimension and no NaN or -inf")
    array.setflags(write=False)
    return array


def described(value: Array) -> ArrayEntry:
    """Shape, and the hash of the little-endian bytes."""
    return ArrayEntry(shape=value.shape, sha256=hashlib.sha256(value.tobytes()).hexdigest())


def arrays_bytes(arrays: Mapping[str, Array]) -> bytes:
    """Pack the .npz file: sorted names, fixed dates, so that the same arrays give the same bytes."""
    buffer = io.BytesIO()
    with zipfile.ZipFile(buffer, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as archive:
        for name in sorted(arrays):
            entry = io.BytesIO()
            np.lib.format.write_array(entry, np.asarray(arrays[name]), version=(1, 0), allow_pickle=False)
            info = zipfile.ZipInfo(f"{name}.npy")
            info.external_attr = 0o644 << 16
            info.compress_type = zipfile.ZIP_DEFLATED
            archive.writestr(info, entry.getvalue())
    return buffer.getvalue()


def read_arrays(path: Path, wanted: bool) -> dict[str, Array]:
    """Read the .npz file; none if no array is wanted and there is none.

    Raises
    ------
    RecordError
        If it cannot be read or is not what `arrays_bytes` packs.
    """
    if not wanted and not path.exists():
        return {}
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as stored:
            return {name: frozen_array(name, stored[name]) for name in stored.files}
    except OSError as error:
        raise RecordError(f"{path}: the record's arrays cannot be read; keep both files together") from error
    except (ValueError, KeyError, zipfile.BadZipFile) as error:
        raise RecordError(f"{path}: not the arrays of a record ({error})") from error
