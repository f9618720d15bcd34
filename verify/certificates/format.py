"""The certificate file: JSON with every number an exact string.

A file has parts; a part has `data`, what its claims speak about, and a list of certificates,
each with its kind, its claim and the witness that makes checking it plain algebra.
The checker (`verify/checker`) reads every field or refuses the file.
"""

from __future__ import annotations

import json
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from decimal import Decimal
from fractions import Fraction
from typing import Any, final

FORMAT = "intermit-certificate"
VERSION = "1"


@final
@dataclass(frozen=True)
class Certificate:
    """One certificate.

    Attributes
    ----------
    kind : str
        Which check of the stand-alone checker proves it.
    data : mapping
        What it speaks about; certificates whose data agree share a part of the file.
    claim, witness : mapping
        What is claimed, and what makes checking it algebra. Numbers are Fraction, int or Decimal.
    """

    kind: str
    data: Mapping[str, Any]
    claim: Mapping[str, Any]
    witness: Mapping[str, Any] = field(default_factory=dict)


def exact_text(value: Fraction | Decimal | int) -> str:
    """Exact string of a number: an integer, a finite decimal where there is one, else p/q."""
    x = Fraction(value)
    rest, twos, fives = x.denominator, 0, 0
    while rest % 2 == 0:
        rest, twos = rest // 2, twos + 1
    while rest % 5 == 0:
        rest, fives = rest // 5, fives + 1
    digits = max(twos, fives)
    if rest != 1 or digits > 30:
        return str(x)
    scaled = abs(x.numerator) * 10**digits // x.denominator
    whole, part = divmod(scaled, 10**digits)
    sign = "-" if x < 0 else ""
    return f"{sign}{whole}" + (f".{part:0{digits}d}" if digits else "")


def as_text(value: Any) -> Any:
    """Replace every number in nested lists, tuples and mappings by its exact string."""
    if isinstance(value, Mapping):
        return {str(key): as_text(x) for key, x in value.items()}
    if isinstance(value, (list, tuple)):
        return [as_text(x) for x in value]
    if isinstance(value, str):
        return value
    if isinstance(value, (Fraction, Decimal, int)) and not isinstance(value, bool):
        return exact_text(value)
    raise TypeError(f"a certificate holds exact numbers and text, received {type(value).__name__}")


def certificate_text(certificates: Iterable[Certificate]) -> str:
    """Text of a certificate file; certificates whose data agree share one part of it.

    Raises
    ------
    ValueError
        If there is no certificate.
    TypeError
        If a number is not exact.
    """
    parts: list[dict[str, Any]] = []
    for certificate in certificates:
        claim, witness = as_text(certificate.claim), as_text(certificate.witness)
        entry = {"kind": certificate.kind, "claim": claim, "witness": witness}
        data = as_text(certificate.data)
        home = next((part for part in parts if _agree(part["data"], data)), None)
        if home is None:
            home = {"data": {}, "certificates": []}
            parts.append(home)
        _merge(home["data"], data)
        home["certificates"].append(entry)
    if not parts:
        raise ValueError("there is nothing to certify")
    return json.dumps({"format": FORMAT, "version": VERSION, "parts": parts}, indent=1) + "\n"


def _agree(known: Mapping[str, Any], more: Mapping[str, Any]) -> bool:
    """Whether two nested mappings give no entry two values."""
    for key in known.keys() & more.keys():
        both = known[key], more[key]
        if isinstance(both[0], dict) and isinstance(both[1], dict):
            if not _agree(*both):
                return False
        elif both[0] != both[1]:
            return False
    return True


def _merge(known: dict[str, Any], more: Mapping[str, Any]) -> None:
    for key, value in more.items():
        if isinstance(value, dict):
            _merge(known.setdefault(key, {}), value)
        else:
            known[key] = value
