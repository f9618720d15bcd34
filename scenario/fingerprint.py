"""The hash of what a scenario says: equal for files that mean the same, whatever their comments."""

from __future__ import annotations

import json
from collections.abc import Mapping
from enum import Enum
from fractions import Fraction
from hashlib import sha256
from pathlib import Path
from typing import Any

from pydantic import BaseModel

from .exact import decimal_text


def canonical(value: Any) -> Any:
    """Return plain JSON data: fractions as 'p/q', tables as objects without their `None` entries."""
    if isinstance(value, BaseModel):
        pairs = {
            (field.alias or name): getattr(value, name) for name, field in type(value).model_fields.items()
        }
        return canonical(pairs)
    if isinstance(value, Mapping):
        return {str(k): canonical(v) for k, v in value.items() if v is not None}
    if isinstance(value, (list, tuple)):
        return [canonical(v) for v in value]
    if isinstance(value, Fraction):
        return decimal_text(value)
    if isinstance(value, Enum):
        return value.value
    return value


def fingerprint(file: BaseModel, attachments: Mapping[str, Path]) -> str:
    """SHA-256 of the typed file and of the bytes of the files that it names."""
    content = {
        "scenario": canonical(file),
        "files": {name: sha256(path.read_bytes()).hexdigest() for name, path in sorted(attachments.items())},
    }
    text = json.dumps(content, sort_keys=True, separators=(",", ":"), ensure_ascii=True, default=str)
    return sha256(text.encode()).hexdigest()
