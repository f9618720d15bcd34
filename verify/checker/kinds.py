"""The table of kinds, and the check of a whole file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .exact_numbers import Invalid, require
from .reading import Node, parse
from .tables import OWN, Part, enter, entries, using

FORMAT = "intermit-certificate"
VERSION = "1"


@dataclass(frozen=True)
class Proof:
    """A claim in words, line by line, and the part whose system proves it (empty: the checker's own)."""

    lines: list[str]
    part: str = ""


Check = Callable[[Node, Node], list[str] | Proof]
"""(data, certificate) -> the claim in words; raises Invalid if the proof fails."""

KINDS: dict[str, Check] = OWN.kinds


def kind(name: str) -> Callable[[Check], Check]:
    """Enter a function into the table under the name that certificates give as their kind."""

    def entered(check: Check) -> Check:
        enter("kinds", name, check)
        return check

    return entered


@dataclass(frozen=True)
class Finding:
    """The checker's word on one certificate.

    Attributes
    ----------
    part : the part from outside on which a valid claim rests beside the checker; empty for none
    """

    kind: str
    valid: bool
    claim: tuple[str, ...]
    reason: str
    part: str = ""


def check_text(text: str, parts: tuple[Part, ...] = ()) -> list[Finding]:
    """Check everything in a certificate file; with parts from outside only if they are given."""
    with using(parts):
        return _check_text(text)


def _check_text(text: str) -> list[Finding]:
    try:
        file = parse(text)
        require(file["format"].text() == FORMAT, f"the format must be {FORMAT!r}")
        require(file["version"].text() == VERSION, f"this checker reads version {VERSION!r}")
        pairs = [
            (part["data"], one) for part in file["parts"].items() for one in part["certificates"].items()
        ]
        require(bool(pairs), "there is no certificate in the file")
    except Invalid as error:
        return [Finding("file", False, (), str(error))]
    findings = [check_certificate(data, certificate) for data, certificate in pairs]
    stray = list(file.unread())
    if stray and all(finding.valid for finding in findings):
        reason = f"nothing reads {', '.join(stray[:5])}"
        findings.append(Finding("file", False, (), reason))
    return findings


def check_certificate(data: Node, certificate: Node) -> Finding:
    """Check one certificate against the data of its part."""
    name = "unknown"
    try:
        name = certificate["kind"].text()
        known = {entry: (check, part) for entry, check, part in entries("kinds")}
        require(name in known, f"this checker knows no certificate of kind {name!r}")
        check, part = known[name]
        found = check(data, certificate)
        proof = found if isinstance(found, Proof) else Proof(found)
        return Finding(name, True, tuple(proof.lines), "", part or proof.part)
    except Invalid as error:
        return Finding(name, False, (), str(error))
    except (ArithmeticError, LookupError, TypeError, ValueError, MemoryError, RecursionError) as error:
        return Finding(name, False, (), f"malformed: {type(error).__name__}: {error}")
