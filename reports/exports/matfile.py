"""MATLAB's level 5 MAT-file, the little of it that structures of real columns need.

Source: "MAT-File Format", The MathWorks, level 5. Little-endian, uncompressed, no clock in the header.
"""

from __future__ import annotations

import struct
from collections.abc import Mapping

import numpy as np

from ..record import Array

_INT8, _INT32, _UINT32, _DOUBLE, _MATRIX = 1, 5, 6, 9, 14
_STRUCT_CLASS, _DOUBLE_CLASS = 2, 6
_NAME_LENGTH = 64


def mat_bytes(variables: Mapping[str, Mapping[str, Array]]) -> bytes:
    """Write each variable as a 1 x 1 structure whose fields are column vectors.

    Raises
    ------
    ValueError
        If a field's name is longer than 63 characters or a variable is larger than the format's 2 GB.
    """
    header = (
        b"MATLAB 5.0 MAT-file, written by intermit".ljust(116) + bytes(8) + struct.pack("<H", 0x0100) + b"IM"
    )
    return header + b"".join(_structure(name, fields) for name, fields in variables.items())


def _element(kind: int, data: bytes) -> bytes:
    return struct.pack("<II", kind, len(data)) + data + bytes(-len(data) % 8)


def _matrix(name: str, kind: int, shape: tuple[int, int], rest: bytes) -> bytes:
    body = _element(_UINT32, struct.pack("<II", kind, 0)) + _element(_INT32, struct.pack("<ii", *shape))
    body += _element(_INT8, name.encode("ascii")) + rest
    if len(body) >= 2**31:
        raise ValueError(f"{name}: {len(body)} bytes do not fit into this file format")
    return _element(_MATRIX, body)


def _structure(name: str, fields: Mapping[str, Array]) -> bytes:
    if any(len(field) >= _NAME_LENGTH for field in fields):
        raise ValueError(f"{name}: a field's name has more than {_NAME_LENGTH - 1} characters")
    names = b"".join(field.encode("ascii").ljust(_NAME_LENGTH, b"\0") for field in fields)
    length = struct.pack(
        "<HHi", _INT32, 4, _NAME_LENGTH
    )  # a small element: type, size and data in eight bytes
    columns = b"".join(_column(values) for values in fields.values())
    return _matrix(name, _STRUCT_CLASS, (1, 1), length + _element(_INT8, names) + columns)


def _column(values: Array) -> bytes:
    data = np.ascontiguousarray(values, dtype="<f8").tobytes()
    return _matrix("", _DOUBLE_CLASS, (len(values), 1), _element(_DOUBLE, data))
