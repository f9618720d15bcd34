"""Who decides each claim, and who writes the certificate of one that is decided without.

A new claim is an entry of `verify/claim_table.py`, a decider, its line here, and the checker's file.
"""

from __future__ import annotations

from collections.abc import Callable, Iterable
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

from ...models.closed_loop import close_loop
from ...models.laws import Law
from ...scenario import Scenario
from ...verify.certificates import Certificate
from ...verify.certificates.excitation import excitation_certificate
from ...verify.certificates.facts import fact_certificate, filter_start_certificate
from ...verify.filter.answer import answer
from ...verify.filter.recognise import follows_filter
from ...verify.linear.stability import stability_claim
from ...verify.lyapunov.candidates import offers_storage
from ...verify.lyapunov.claims import lyapunov_claims
from ...verify.robust.claims import robust_claims
from ...verify.schedule.excitation import excitation_claim
from ...verify.schedule.facts import schedule_claims
from ...verify.schedule.filter_start import filter_start_claim
from ...verify.schedule.zero_runs import default_length
from ...verify.verdict import Claim, Evidence, EvidenceKind, Verdict
from ..claims.known_inertia import say_inertia
from ..simulated_run import RunFigures
from .filter_question import floor_question, robust_question

Write = Callable[[Scenario, Claim], Certificate | None]
WriteOfLaw = Callable[[Scenario, Law, Claim], Certificate | None]


@final
@dataclass(frozen=True)
class ScheduleMaker:
    """Decides claims about a scenario's schedule, or its linear plant.

    Attributes
    ----------
    keys : of the claims that it may make
    decide : makes those that apply
    write : the certificate of one of them, where its decider gave none
    """

    keys: tuple[str, ...]
    decide: Callable[[Scenario], Iterable[Claim]]
    write: Write | None = None


@final
@dataclass(frozen=True)
class LawMaker:
    """Decides claims about one law of a scenario; the attributes are those of `ScheduleMaker`."""

    keys: tuple[str, ...]
    decide: Callable[[Scenario, Law], Iterable[Claim]]
    write: WriteOfLaw | None = None


def _facts(scenario: Scenario) -> Iterable[Claim]:
    choice = scenario.schedule_choice
    return schedule_claims(choice.schedule, overruns_as_printed=choice.overruns_as_printed)


def _excitation(scenario: Scenario) -> Iterable[Claim]:
    yield excitation_claim(scenario.schedule_choice.schedule, scenario.check.pe_window)


def _write_excitation(scenario: Scenario, claim: Claim) -> Certificate | None:
    if claim.verdict is not Verdict.PROVED:
        return None
    schedule = scenario.schedule
    return excitation_certificate(schedule, scenario.check.pe_window or default_length(schedule))


def _linear(scenario: Scenario) -> Iterable[Claim]:
    if scenario.linear is not None:
        yield stability_claim(scenario.linear)


def _filter_start(scenario: Scenario, law: Law) -> Iterable[Claim]:
    """Of a law whose state R is the persistence filter."""
    start = next((state.initial for state in law.controller_states if state.name == "R"), Fraction(0))
    decay = law.parameters.get("lambda", Fraction(0))
    if start > 0 and decay > 0 and follows_filter(close_loop(law)):
        yield filter_start_claim(scenario.schedule, decay=decay, initial=start)


def _lyapunov(scenario: Scenario, law: Law) -> Iterable[Claim]:
    """About the law's storage function, over the inertia's whole tolerance; without one, only if asked."""
    listed = scenario.check.claims or ()
    if not offers_storage(law) and not any(key.startswith("lyapunov.") for key in listed):
        return ()
    mission = scenario.mission
    return lyapunov_claims(law, mission.body, tolerance=mission.inertia_tolerance, schedule=mission.schedule)


def _floor(scenario: Scenario, law: Law) -> Iterable[Claim]:
    return answer(floor_question(scenario, law, RunFigures(), search=False)).claims


def _robust(scenario: Scenario, law: Law) -> Iterable[Claim]:
    return () if scenario.uncertainty.is_nominal else robust_claims(robust_question(scenario, law))


FACTS = ("schedule.order", "schedule.smooth", "schedule.support", "schedule.uncertain-thrust")
ABOUT_SCHEDULE = (
    ScheduleMaker(FACTS, _facts, lambda scenario, claim: fact_certificate(scenario.schedule, claim)),
    ScheduleMaker(("schedule.excitation",), _excitation, _write_excitation),
    ScheduleMaker(("linear.stable",), _linear),
)
ALGEBRAIC = (
    LawMaker(
        ("filter.start",),
        _filter_start,
        lambda scenario, law, _: filter_start_certificate(scenario.schedule, law),
    ),
    LawMaker(
        ("lambda.paper", "lambda.sharp", "lambda.rate", "lyapunov.identity", "lyapunov.derivative"),
        _lyapunov,
    ),
)
"""About a law, from its equations alone: `check` asks them first."""
ABOUT_LAW = (
    *ALGEBRAIC,
    LawMaker(("filter.floor", "convergence", "torque.limit"), _floor),
    LawMaker(("robust.floor", "robust.convergence", "robust.ultimate"), _robust),
)


def scenario_claims(scenario: Scenario) -> tuple[Claim, ...]:
    """Claims about the schedule, whatever the law; and about the linear plant through it, if one is given."""
    return tuple(claim for maker in ABOUT_SCHEDULE for claim in maker.decide(scenario))


def algebraic_claims(scenario: Scenario, law: Law) -> tuple[Claim, ...]:
    """Claims about R(0), and about the law's storage function."""
    return tuple(claim for maker in ALGEBRAIC for claim in maker.decide(scenario, law))


def decided_claims(scenario: Scenario, law: Law) -> tuple[Claim, ...]:
    """Claims about one law that exact means decide, with their certificates; no samples, no simulation."""
    made = [claim for maker in ABOUT_LAW for claim in maker.decide(scenario, law)]
    return say_inertia(made, scenario, law)


def with_certificate(claim: Claim, scenario: Scenario, law: Law | None = None) -> Claim:
    """Put a certificate under a claim that was decided without one, where it can have one."""
    certificate = _written(claim, scenario, law)
    if certificate is None:
        return claim
    summary = "decided once more, from the data alone, by the stand-alone checker"
    evidence = Evidence(EvidenceKind.CERTIFICATE, summary, claim.source, {"certificate": certificate})
    return replace(claim, evidence=(*claim.evidence, evidence))


def _written(claim: Claim, scenario: Scenario, law: Law | None) -> Certificate | None:
    if law is None:
        writers = [maker.write for maker in ABOUT_SCHEDULE if claim.key in maker.keys]
        return next((write(scenario, claim) for write in writers if write is not None), None)
    of_law = [maker.write for maker in ABOUT_LAW if claim.key in maker.keys]
    return next((write(scenario, law, claim) for write in of_law if write is not None), None)
