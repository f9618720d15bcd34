"""What the stand-alone checker says of a certificate file, as `intermit.recheck` returns it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

from ...reports.summary import Shown, Summary
from ...verify.checker import Finding, check_text


@final
@dataclass(frozen=True, repr=False)
class Rechecked(Shown):
    """The checker's findings, one a certificate; a sequence of them.

    Attributes
    ----------
    findings : `.kind`, `.valid`, `.claim` (its words, line by line) and, if it is not valid, `.reason`
    """

    findings: tuple[Finding, ...]

    @property
    def valid(self) -> bool:
        """Whether every certificate proves its claim."""
        return all(finding.valid for finding in self.findings)

    def __iter__(self) -> Iterator[Finding]:
        return iter(self.findings)

    def __len__(self) -> int:
        return len(self.findings)

    @property
    def summary(self) -> Summary:
        """Each finding: VALID, or INVALID with the reason."""
        invalid = sum(not finding.valid for finding in self.findings)
        line = f"{len(self) - invalid} valid, {invalid} not valid"
        rows = [(_word(f), f.kind, "; ".join(f.claim) or f.reason) for f in self.findings]
        why = [f"{f.kind}: {f.reason}" for f in self.findings if not f.valid]
        return Summary("Certificate file", (line, *why), ((("", "kind", "claim"), rows),))


def recheck_text(text: str) -> Rechecked:
    """Prove every claim of a certificate file's text anew."""
    return Rechecked(tuple(check_text(text)))


def _word(finding: Finding) -> str:
    return "VALID" if finding.valid else "INVALID"
