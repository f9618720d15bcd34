"""The command line of the checker."""

from __future__ import annotations

import sys
from collections.abc import Sequence
from pathlib import Path

from .kinds import Finding, check_text


def printable(text: str) -> str:
    """Escape everything but plain characters: names come from the file, and must not pass for verdicts."""
    return "".join(c if " " <= c <= "~" else c.encode("unicode_escape").decode() for c in text)


def report(findings: list[Finding]) -> str:
    """Return the findings as text."""
    lines: list[str] = []
    for finding in findings:
        lines.append(f"{'VALID' if finding.valid else 'INVALID'}  {printable(finding.kind)}")
        lines += [f"    {printable(line)}" for line in finding.claim]
        if finding.reason:
            lines.append(f"    reason: {printable(finding.reason)}")
    good = sum(finding.valid for finding in findings)
    lines.append(f"{good} of {len(findings)} valid")
    return "\n".join(lines) + "\n"


def main(arguments: Sequence[str]) -> int:
    """Check the file named on the command line and return the exit code."""
    if len(arguments) != 1:
        sys.stderr.write("usage: python -I -S CHECKER FILE\n")
        return 2
    try:
        text = Path(arguments[0]).read_text(encoding="utf-8")
    except (OSError, UnicodeDecodeError) as error:
        sys.stderr.write(f"cannot read {arguments[0]}: {error}\n")
        return 2
    digits = sys.get_int_max_str_digits()
    sys.set_int_max_str_digits(0)
    try:
        findings = check_text(text)
        sys.stdout.write(report(findings))
    finally:
        sys.set_int_max_str_digits(digits)
    return 0 if all(finding.valid for finding in findings) else 1
