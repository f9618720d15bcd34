"""Collect every certificate that a scenario's claims have, and compare a file's data with a scenario."""

from __future__ import annotations

import json
from collections.abc import Iterator, Mapping, Sequence
from contextlib import suppress
from dataclasses import dataclass, replace
from typing import Any, final

from ...models.closed_loop import close_loop
from ...models.laws import Law
from ...models.types import Progress
from ...scenario import Scenario
from ...verify.certificates import Certificate, as_text, certificate_text
from ...verify.certificates.excitation import excitation_certificate
from ...verify.certificates.facts import fact_certificate, filter_start_certificate, windows_data
from ...verify.certificates.program import NotAlgebraicError
from ...verify.certificates.schedule import schedule_data
from ...verify.filter.certificate import question_data
from ...verify.linear.stability import plant_data
from ...verify.lyapunov import certificates_of
from ...verify.lyapunov.forms import inertia_data, law_form
from ...verify.schedule.zero_runs import default_length
from ...verify.verdict import Claim, Evidence, EvidenceKind, Verdict
from ..check.case import decided_claims
from ..check.filter_question import floor_question
from ..check.run import scenario_claims
from ..optimum.lower_bounds import asks_for_optimum, own_bound_claim, transfers_data
from ..simulated_run import RunFigures


@final
@dataclass(frozen=True)
class Certification:
    """What a scenario's claims have to show.

    Attributes
    ----------
    claims : (subject, claim) in order; the subject is a law's label or "schedule"
    certificates : every certificate under them
    """

    claims: tuple[tuple[str, Claim], ...]
    certificates: tuple[Certificate, ...]

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
        claims.append(("optimum", own_bound_claim(scenario)))
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


def differences(text: str, scenario: Scenario) -> tuple[str, ...]:
    """How the data of a valid certificate file differ from a scenario's; empty if they are equal.

    Every part of the file must agree with one law of the scenario in everything it says. A law is
    compared as polynomials, so that the order of its instructions does not matter.
    """
    parts = json.loads(text)["parts"]
    transfers = transfers_data(scenario) if any("transfer" in part["data"] for part in parts) else []
    known = list(_scenario_data(scenario, transfers))
    found: list[str] = []
    for number, part in enumerate(parts, start=1):
        gaps = [tuple(_unequal(part["data"], data)) for data in known]
        if not any(not gap for gap in gaps):
            least = min(gaps, key=len, default=())
            found.append(f"part {number}: {', '.join(least)}")
    return tuple(found)


def _scenario_data(scenario: Scenario, transfers: Sequence[Mapping[str, Any]]) -> Iterator[Mapping[str, Any]]:
    """Everything certificates may say of a scenario, for each of its laws, as they say it."""
    shared = {"schedule": schedule_data(scenario.schedule)} | windows_data(scenario.schedule)
    if scenario.linear is not None:
        shared |= plant_data(scenario.linear)
    shared |= {"inertia": scenario.body.exact_inertia, "transfers": transfers}
    if not scenario.laws:
        yield shared
    for choice in scenario.laws:
        law = choice.build()
        data = shared | question_data(floor_question(scenario, law, RunFigures(), search=False))
        data |= inertia_data(scenario.body.exact_inertia, scenario.inertia_tolerance)
        data["parameters"] = _true_parameters(law)
        with suppress(NotAlgebraicError):  # such a law has no certificate that writes it out
            data["law"] = law_form(close_loop(law))
        yield data


def _true_parameters(law: Law) -> dict[str, Any]:
    """Parameters of a law; R0 and k0 only where the states they name do start there."""
    starts = {f"{state.name}0": state.initial for state in law.controller_states}
    return {name: value for name, value in law.parameters.items() if starts.get(name, value) == value}


def _unequal(stated: Mapping[str, Any], expected: Mapping[str, Any]) -> Iterator[str]:
    """Names of the entries that the scenario does not confirm."""
    text = as_text(expected)
    bound_alone = stated.keys() == {"inertia", "transfer"}  # a bound speaks of the inertia as stated
    if (
        "inertia_tolerance" in text
        and "inertia_tolerance" not in stated
        and "inertia" in stated
        and not bound_alone
    ):
        yield "inertia_tolerance (the scenario has one, the certificate none)"
    for key, value in stated.items():
        if key == "law":
            if not _same_law(value, text["law"]):
                yield "law"
        elif key == "transfer":
            if not any(_same(value, transfer) for transfer in text["transfers"]):
                yield "transfer"
        elif key == "parameters":
            for name, number in value.items():
                if not _same(number, text["parameters"].get(name)):
                    yield f"parameters.{name}"
        elif not _same(value, text.get(key)):
            yield key


def _same(left: Any, right: Any) -> bool:
    """Whether two nested values hold the same exact numbers and text."""
    from ...verify.checker import Invalid, exact

    if isinstance(left, Mapping) and isinstance(right, Mapping):
        return left.keys() == right.keys() and all(_same(left[key], right[key]) for key in left)
    if isinstance(left, list) and isinstance(right, list):
        return len(left) == len(right) and all(map(_same, left, right))
    if left == right:
        return True
    try:
        return isinstance(left, str) and isinstance(right, str) and exact(left) == exact(right)
    except Invalid:
        return False


def _same_law(stated: Mapping[str, Any], own: Mapping[str, Any]) -> bool:
    """Whether the law of a certificate is the scenario's: the same torque and rates as polynomials.

    Where a certificate gives a name alone it speaks of the checker's own equations of that name: the
    scenario's law must have those, whatever it is called.
    """
    from ...verify.checker import Invalid, Node, family_of, law_polynomials

    try:
        if set(stated) == {"name"}:
            return bool(family_of(Node(own, "law")) == stated["name"])
        first, second = (law_polynomials(Node(law, "law")) for law in (stated, own))
    except (Invalid, LookupError):
        return False
    return first == second
