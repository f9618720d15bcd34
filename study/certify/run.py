"""Collect every certificate that a scenario's claims have."""

from __future__ import annotations

from dataclasses import dataclass, replace
from pathlib import Path
from typing import final

from ...errors import InputError
from ...models.laws import Law
from ...models.types import Progress
from ...reports.summary import Shown, Summary
from ...reports.whole_files import write_whole
from ...scenario import Scenario
from ...verify.certificates import Certificate, certificate_text
from ...verify.certificates.excitation import excitation_certificate
from ...verify.certificates.facts import fact_certificate, filter_start_certificate
from ...verify.lyapunov import certificates_of
from ...verify.schedule.zero_runs import default_length
from ...verify.verdict import Claim, Evidence, EvidenceKind, Verdict
from ..check.case import decided_claims
from ..check.run import scenario_claims
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
    claims = [("schedule", _certified(claim, scenario)) for claim in scenario_claims(scenario)]
    for i, choice in enumerate(scenario.laws):
        progress(choice.label, i / len(scenario.laws))
        law = choice.build()
        claims += [
            (choice.label, _certified(claim, scenario, law)) for claim in decided_claims(scenario, law)
        ]
    if bound and asks_for_optimum(scenario):
        progress("lower bound", 1.0)
        claims.append(("optimum", own_bound(scenario).claim))
    return Certification(tuple(claims), certificates_of(claim for _, claim in claims))


def _certified(claim: Claim, scenario: Scenario, law: Law | None = None) -> Claim:
    """Put a certificate under a claim that was decided without one, where it can have one."""
    certificate = _certificate(claim, scenario, law)
    if certificate is None:
        return claim
    summary = "decided once more, from the data alone, by the stand-alone checker"
    evidence = Evidence(EvidenceKind.CERTIFICATE, summary, claim.source, {"certificate": certificate})
    return replace(claim, evidence=(*claim.evidence, evidence))


def _certificate(claim: Claim, scenario: Scenario, law: Law | None) -> Certificate | None:
    schedule = scenario.schedule
    if claim.key == "filter.start":
        return None if law is None else filter_start_certificate(schedule, law)
    if claim.key == "schedule.excitation":
        if claim.verdict is not Verdict.PROVED:
            return None
        return excitation_certificate(schedule, scenario.check.pe_window or default_length(schedule))
    return fact_certificate(schedule, claim)
