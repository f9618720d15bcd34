"""The claims about one law of a scenario."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, replace
from fractions import Fraction
from functools import partial
from typing import final

import numpy as np

from ...models.laws import Law
from ...models.types import Progress, silent
from ...scenario import LawChoice, Scenario
from ...verify.claim_table import CLAIM_KEYS, order_of, stated
from ...verify.filter.answer import FloorAnswer, answer
from ...verify.filter.claims import torque_quantities
from ...verify.filter.over_time import BoundsOverTime, bounds_over_time
from ...verify.filter.torque_excess import refuted_limit
from ...verify.robust.claims import robust_claims
from ...verify.robust.found import MembersFound, fly_members
from ...verify.sampling import SampledDerivative, with_samples
from ...verify.verdict import Claim, Quantity, Verdict
from ..claims.known_inertia import say_inertia
from ..simulated_run import Run, RunFigures
from .filter_question import floor_question, is_certified, robust_question
from .makers import algebraic_claims
from .margins import convergence_margins, with_margins
from .sampled import reference_floor, sample_law
from .why_floor import floor_note


@final
@dataclass(frozen=True, kw_only=True)
class CaseOptions:
    """How much is asked about one law.

    Attributes
    ----------
    margins : look for how far schedule and lambda may change
    search : look for the worst start by simulation
    """

    margins: bool = True
    search: bool = True


@final
@dataclass(frozen=True)
class Findings:
    """What was found about one law beside its run; it can be sent between processes.

    Attributes
    ----------
    claims : in the order of the claim keys
    reference_floor : R_min in V's k* = 1/R_min, s; None where none is known
    curves : certified bounds over the scenario's horizon; None where nothing reaches that far
    samples : sampled derivative of V; None where the law has no storage function
    notes : what a reader should know beside the claims
    """

    claims: tuple[Claim, ...]
    reference_floor: Fraction | None
    curves: BoundsOverTime | None
    samples: SampledDerivative | None
    notes: tuple[str, ...] = ()


@final
@dataclass(frozen=True)
class Case:
    """One law of the scenario, checked and run.

    Attributes
    ----------
    claims : the findings' claims, marked as counted or not
    run : from the scenario's initial state; None if no simulation was asked for
    """

    choice: LawChoice
    findings: Findings
    claims: tuple[Claim, ...]
    run: Run | None


@final
@dataclass(frozen=True)
class Decided:
    """What exact means decide about one law, and what the parts that follow need of it.

    Attributes
    ----------
    claims : without margins and samples
    has_margins : whether convergence is proved, so that its margins may be looked for
    """

    claims: tuple[Claim, ...]
    reference_floor: Fraction | None
    curves: BoundsOverTime | None
    note: str
    has_margins: bool


KNOWN_BODY = (
    "the claims that do not say 'on every body' speak of a body, thrusters and a torque known exactly: "
    "[uncertainty] does not enter them"
)
Sampled = tuple[SampledDerivative | None, str]
"""Samples of V', or the reason why there are none."""


def decide(
    scenario: Scenario,
    choice: LawChoice,
    seen: RunFigures,
    options: CaseOptions,
    progress: Progress | None = None,
) -> Decided:
    """Decide every claim about one law; `seen` is what its run showed. Margins and samples come after it."""
    tell = progress if progress is not None else silent
    law = choice.build()
    tell("V' as a polynomial", 0.0)
    claims = {claim.key: claim for claim in algebraic_claims(scenario, law)}
    tell("floor of R", 0.2)
    question = floor_question(scenario, law, seen, search=options.search)
    found = answer(question)
    claims |= {claim.key: claim for claim in found.claims}
    _add_torque(claims, found)
    if not scenario.uncertainty.is_nominal:
        tell("every body of the uncertainty", 0.45)
        claims |= {
            claim.key: claim
            for claim in robust_claims(
                robust_question(scenario, law), _members(scenario, law), margins=options.margins
            )
        }
    limit = claims.get("torque.limit")
    if limit is not None and limit.verdict is Verdict.UNDECIDED and seen.excess_at is not None:
        tell("the run beyond the torque limit", 0.5)
        start = scenario.initial
        claims[limit.key] = refuted_limit(
            limit, question, quaternion=start.attitude, rate=start.exact_rate, at=seen.excess_at
        )
    return Decided(
        say_inertia(claims.values(), scenario, law),
        reference_floor(scenario, law, claims.get("filter.floor"), seen),
        bounds_over_time(found.floor, scenario.horizon) if found.floor is not None else None,
        floor_note(scenario.schedule, found.converged),
        options.margins and claims["convergence"].verdict is Verdict.PROVED and not _is_from_outside(found),
    )


def _is_from_outside(found: FloorAnswer) -> bool:
    """Whether a proof rests on a system from outside: its every certificate must be checked, margins' too."""
    return found.floor is not None and found.floor.system.part is not None


def margins(scenario: Scenario, choice: LawChoice) -> tuple[Quantity, ...]:
    """How far schedule and lambda may change while convergence stays certified."""
    question = floor_question(scenario, choice.build(), RunFigures(), search=False)
    return tuple(convergence_margins(scenario, choice, partial(is_certified, question)))


def samples(
    scenario: Scenario, choice: LawChoice, floor: Fraction | None, progress: Callable[[float], None]
) -> Sampled:
    """Samples of V' with k* = 1/floor."""
    return sample_law(scenario, choice.build(), floor, progress)


def findings(decided: Decided, margins: tuple[Quantity, ...], sampled: Sampled) -> Findings:
    """Put margins and samples under the claims they belong to."""
    claims = {claim.key: claim for claim in decided.claims}
    if margins:
        claims["convergence"] = with_margins(claims["convergence"], margins)
    found, why_not = sampled
    if found is not None:
        _add_samples(claims, found)
    ordered = tuple(sorted(claims.values(), key=lambda claim: order_of(claim.key)))
    known = "" if not any(key.startswith("robust.") for key in claims) else KNOWN_BODY
    told = (decided.note, f"V' was not sampled: {why_not}" if why_not else "", known)
    notes = tuple(note for note in told if note)
    return Findings(ordered, decided.reference_floor, decided.curves, found, notes)


def _members(scenario: Scenario, law: Law) -> MembersFound:
    """Extreme members flown from the scenario's start."""
    start = np.concatenate([scenario.initial.quaternion, scenario.initial.rate])
    return fly_members(
        law,
        scenario.body,
        scenario.schedule,
        scenario.uncertainty,
        start,
        scenario.horizon,
        seed=scenario.check.seed,
    )


def _add_torque(claims: dict[str, Claim], found: FloorAnswer) -> None:
    """Without a limit to hold it against, the certified torque bound stands with the convergence."""
    proved = claims.get("filter.floor", claims["convergence"])
    if proved.verdict is Verdict.PROVED and found.torque is not None and "torque.limit" not in claims:
        convergence = claims["convergence"]
        quantities = (*convergence.quantities, *torque_quantities(found.torque))
        claims["convergence"] = replace(convergence, quantities=quantities)


def _add_samples(claims: dict[str, Claim], samples: SampledDerivative) -> None:
    """Put the samples under the two claims about V'."""
    sign = claims.get("lyapunov.derivative", _open("lyapunov.derivative"))
    claims[sign.key] = with_samples(sign, samples.sign, samples.sign_witness)
    if samples.identity is not None:
        identity = claims.get("lyapunov.identity", _open("lyapunov.identity"))
        claims[identity.key] = with_samples(identity, samples.identity, samples.identity_witness)


def _open(key: str) -> Claim:
    """A claim that has samples under it and no proof."""
    return stated(
        key,
        CLAIM_KEYS[key].says,
        Verdict.UNDECIDED,
        reason="samples are no proof",
        next_step="write the law with + - * / alone: its V' is then a polynomial, and can be proved",
    )
