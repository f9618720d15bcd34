"""The certificate file: JSON with every number an exact string.

What is in a file: `data`, what the claims speak about (shared by all of them), and a list of
certificates, each with its kind, its claim and the witness that makes checking it plain algebra.
The checker (`verify/checker.py`) reads every field or refuses the file.
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
        What it speaks about: goes into the file's shared data, where entries of one name must agree.
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
    """Text of a certificate file.

    Raises
    ------
    ValueError
        If two certificates disagree about an entry of their data, or if there is none.
    """
    data: dict[str, Any] = {}
    entries: list[dict[str, Any]] = []
    for certificate in certificates:
        for key, value in as_text(certificate.data).items():
            if data.setdefault(key, value) != value:
                raise ValueError(f"certificates disagree about {key}: write them to separate files")
        claim, witness = as_text(certificate.claim), as_text(certificate.witness)
        entries.append({"kind": certificate.kind, "claim": claim, "witness": witness})
    if not entries:
        raise ValueError("there is nothing to certify")
    document = {"format": FORMAT, "version": VERSION, "data": data, "certificates": entries}
    return json.dumps(document, indent=1) + "\n"
