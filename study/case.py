"""The claims about one law of a scenario."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from dataclasses import dataclass
from typing import final

from ..models.laws import Law
from ..scenario import LawChoice, Scenario
from ..verify.derivative import SampledDerivative, with_samples
from ..verify.filter_start import filter_start_claim
from ..verify.lyapunov import lyapunov_claims
from ..verify.verdict import Claim, Verdict
from .keys import CLAIM_KEYS, order_of
from .run import Run, run_law
from .sampled import reference_floor, sample_law

Progress = Callable[[str, float], None]


@final
@dataclass(frozen=True)
class Case:
    """One law of the scenario, built, checked and run.

    Attributes
    ----------
    claims : in the order of the claim keys
    samples : sampled derivative of V; None where the law has no storage function
    run : from the scenario's initial state; None if no simulation was asked for
    notes : what a reader should know beside the claims
    """

    choice: LawChoice
    law: Law
    claims: tuple[Claim, ...]
    samples: SampledDerivative | None
    run: Run | None
    notes: tuple[str, ...] = ()


def check_case(scenario: Scenario, choice: LawChoice, *, simulate: bool, progress: Progress) -> Case:
    """Decide every claim about one law, and run it."""
    law = choice.build()
    progress("proof of V'", 0.0)
    claims = {claim.key: claim for claim in decided_claims(scenario, law)}
    notes: list[str] = []
    run = None
    if simulate:
        progress("simulation", 0.0)
        run = run_law(scenario, law)
    progress("samples of V'", 0.5)
    floor = reference_floor(scenario, law, claims.get("filter.floor"), run)
    samples, why_not = sample_law(
        scenario, law, floor, lambda done: progress("samples of V'", 0.5 + 0.5 * done)
    )
    if samples is None:
        notes.append(f"V' was not sampled: {why_not}")
    else:
        _add_samples(claims, samples)
    ordered = tuple(sorted(claims.values(), key=lambda claim: order_of(claim.key)))
    return Case(choice, law, ordered, samples, run, tuple(notes))


def decided_claims(scenario: Scenario, law: Law) -> tuple[Claim, ...]:
    """Claims about one law that exact means decide, with their certificates; no samples, no simulation."""
    return (*_filter_claims(scenario, law), *_lyapunov_claims(scenario, law))


def _filter_claims(scenario: Scenario, law: Law) -> Iterator[Claim]:
    """Claims about the filter state, for a law that has one."""
    initial = {state.name: state.initial for state in law.controller_states}
    decay = law.parameters.get("lambda")
    if "R" in initial and decay is not None:
        yield filter_start_claim(scenario.schedule, decay=decay, initial=initial["R"])


def _lyapunov_claims(scenario: Scenario, law: Law) -> tuple[Claim, ...]:
    """Claims about the law's storage function, proved over the inertia's whole tolerance."""
    return lyapunov_claims(
        law, scenario.body, tolerance=scenario.inertia_tolerance, schedule=scenario.schedule
    )


def _add_samples(claims: dict[str, Claim], samples: SampledDerivative) -> None:
    """Put the samples under the two claims about V'."""
    sign = claims.get("lyapunov.derivative", _open("lyapunov.derivative"))
    claims[sign.key] = with_samples(sign, samples.sign, samples.sign_witness)
    if samples.identity is not None:
        identity = claims.get("lyapunov.identity", _open("lyapunov.identity"))
        claims[identity.key] = with_samples(identity, samples.identity, samples.identity_witness)


def _open(key: str) -> Claim:
    """A claim that has samples under it and no proof."""
    entry = CLAIM_KEYS[key]
    return Claim(
        key=key,
        title=entry.title,
        statement=entry.says,
        verdict=Verdict.UNDECIDED,
        reason="samples are no proof",
        next_step="give the law a storage function that is polynomial in the state (Law.storage)",
        source=entry.source,
    )
