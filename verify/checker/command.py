"""The command line of the checker."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from .kinds import Finding, check_text
from .tables import read_part


def printable(text: str) -> str:
    """Escape everything but plain characters: names come from the file, and must not pass for verdicts."""
    return "".join(c if " " <= c <= "~" else c.encode("unicode_escape").decode() for c in text)


def report(findings: list[Finding]) -> str:
    """Return the findings as text."""
    lines: list[str] = []
    for finding in findings:
        trust = f"  (trusting the part {printable(finding.part)})" if finding.part else ""
        lines.append(f"{'VALID' if finding.valid else 'INVALID'}  {printable(finding.kind)}{trust}")
        lines += [f"    {printable(line)}" for line in finding.claim]
        if finding.reason:
            lines.append(f"    reason: {printable(finding.reason)}")
    good = sum(finding.valid for finding in findings)
    outside = sum(bool(finding.part) for finding in findings)
    trust = f", {outside} of them by a part from outside" if outside else ""
    lines.append(f"{good} of {len(findings)} valid{trust}")
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str]) -> int:
    """Check the file named on the command line, with the parts named there, and return the exit code."""
    rest, names = list(arguments), []
    while len(rest) >= 2 and rest[0] == "--with":
        names.append(rest[1])
        rest = rest[2:]
    if len(rest) != 1 or rest[0].startswith("-"):
        sys.stderr.write("usage: python -I -S CHECKER [--with PART.py ...] FILE\n")
        return 2
    place = rest[0]
    try:
        parts = []
        for place in names:
            parts.append(read_part(Path(place).read_text(encoding="utf-8"), Path(place).name))
        place = rest[0]
        text = Path(place).read_text(encoding="utf-8")
    except Exception as error:  # a part may raise anything
        sys.stderr.write(f"cannot read {place}: {error}\n")
        return 2
    digits = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        findings = check_text(text, tuple(parts))
        sys.stdout.write(report(findings))
    finally:
        sys.set_int_max_str_digits(digits)
    return 0 if all(finding.valid for finding in findings) else 1
