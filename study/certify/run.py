"""Collect every certificate that a scenario's claims have."""

from __future__ import annotations

from dataclasses import dataclass
from pathlib import Path
from typing import final

from ...errors import InputError
from ...models.types import Progress
from ...reports.summary import Shown, Summary
from ...reports.whole_files import write_whole
from ...scenario import Scenario
from ...verify.certificates import Certificate, certificate_text
from ...verify.lyapunov import certificates_of
from ...verify.verdict import Claim
from ..check.makers import decided_claims, scenario_claims, with_certificate
from ..optimum.lower_bounds import asks_for_optimum, own_bound


@final
@dataclass(frozen=True, repr=False)
class Certification(Shown):
    """What a scenario's claims have to show.

    Attributes
    ----------
    claims : (subject, claim) in order; the subject is a law's label or "schedule"
    certificates : every certificate under them
    """

    claims: tuple[tuple[str, Claim], ...]
    certificates: tuple[Certificate, ...]

    @property
    def summary(self) -> Summary:
        """Each claim and whether it has a certificate, as `intermit certify` prints them."""
        rows = [
            (
                "certified" if certificates_of([claim]) else "no certificate",
                claim.verdict.value,
                subject,
                claim.title,
            )
            for subject, claim in self.claims
        ]
        line = f"{len(self.certificates)} certificates for {len(self.claims)} claims"
        return Summary("Certificates", (line,), ((("certificate", "verdict", "about", "claim"), rows),))

    def write(self, path: str | Path) -> Path:
        """Write the certificate file whole or not at all; return its path.

        Raises
        ------
        InputError
            If nothing could be certified.
        """
        if not self.certificates:
            raise InputError("nothing could be certified: there is no file to write")
        write_whole(Path(path), self.text)
        return Path(path)

    @property
    def text(self) -> str:
        """The certificate file."""
        return certificate_text(self.certificates)


def certify(scenario: Scenario, progress: Progress, *, bound: bool = False) -> Certification:
    """Decide the claims of a scenario by exact means and collect their certificates.

    With `bound`, a scenario with an [optimum] table gets the lower bound of its least peak too.
    """
    claims = [("schedule", with_certificate(claim, scenario)) for claim in scenario_claims(scenario)]
    for i, choice in enumerate(scenario.laws):
        progress(choice.label, i / len(scenario.laws))
        law = choice.build()
        claims += [
            (choice.label, with_certificate(claim, scenario, law)) for claim in decided_claims(scenario, law)
        ]
    if bound and asks_for_optimum(scenario):
        progress("lower bound", 1.0)
        claims.append(("optimum", own_bound(scenario).claim))
    return Certification(tuple(claims), certificates_of(claim for _, claim in claims))
