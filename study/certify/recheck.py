"""What the stand-alone checker says of a certificate file, as `intermit.recheck` returns it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass
from pathlib import Path
from typing import final

from ...errors import InputError
from ...reports.content.wording import short
from ...reports.summary import Shown, Summary
from ...verify.checker import Finding, Part, check_text, read_part

MAX_CLAIM = 80
"""Characters of a claim in the table; `finding.claim` has all its words."""


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
        rows = [(_word(f), f.kind, short(" ".join(f.claim), MAX_CLAIM)) for f in self.findings]
        why = [f"{f.kind}: {f.reason}" for f in self.findings if not f.valid]
        return Summary("Certificate file", (line, *why), ((("", "kind", "claim"), rows),))


def recheck_text(text: str, parts: Sequence[Path] = ()) -> Rechecked:
    """Prove every claim of a certificate file's text anew, trusting the checker and the parts named."""
    return Rechecked(tuple(check_text(text, read_parts(parts))))


def read_parts(files: Sequence[Path]) -> tuple[Part, ...]:
    """Read the checker's parts from outside; their code is run.

    Raises
    ------
    InputError
        If one cannot be read or run, or brings nothing.
    """
    parts = []
    for path in files:
        try:
            parts.append(read_part(path.read_text(encoding="utf-8"), path.name))
        except Exception as error:  # whatever the part's own code does
            raise InputError(f"{path}: is no part of the checker: {type(error).__name__}: {error}") from None
    return tuple(parts)


def _word(finding: Finding) -> str:
    return "VALID" if finding.valid else "INVALID"
