"""The table of kinds, and the check of a whole file."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from .exact_numbers import Invalid, require
from .reading import Node, parse

FORMAT = "intermit-certificate"
VERSION = "1"

Check = Callable[[Node, Node], list[str]]
"""(data, certificate) -> the claim in words, line by line; raises Invalid if the proof fails."""

KINDS: dict[str, Check] = {}


def kind(name: str) -> Callable[[Check], Check]:
    """Enter a function into the table under the name that certificates give as their kind."""

    def enter(check: Check) -> Check:
        KINDS[name] = check
        return check

    return enter


@dataclass(frozen=True)
class Finding:
    """The checker's word on one certificate."""

    kind: str
    valid: bool
    claim: tuple[str, ...]
    reason: str


def check_text(text: str) -> list[Finding]:
    """Check everything in a certificate file."""
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
        require(name in KINDS, f"this checker knows no certificate of kind {name!r}")
        return Finding(name, True, tuple(KINDS[name](data, certificate)), "")
    except Invalid as error:
        return Finding(name, False, (), str(error))
    except (ArithmeticError, LookupError, TypeError, ValueError, MemoryError, RecursionError) as error:
        return Finding(name, False, (), f"malformed: {type(error).__name__}: {error}")
