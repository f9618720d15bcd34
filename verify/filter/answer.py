"""One call for a check: certify the floor and everything that follows from it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.closed_loop import close_loop
from ...models.laws import LAWS, Law
from ...models.mission import Mission
from ...models.norms import MEASURED, Norm
from ...models.schedule import Schedule
from ..certificates.format import Certificate
from ..verdict import Claim
from .certificate import floor_certificate, refusal
from .certify import MAX_PERIOD_WINDOWS, FilterLowerBound, certify_floor
from .claims import FloorFacts, convergence_claim, floor_claim, reaches_far_enough, torque_claim
from .converged import ConvergedFilter, ConvergedFloor
from .convergence import Convergence, analyse_convergence
from .known_proofs import own_proofs, system_of
from .question import FloorQuestion
from .recognise import NoComparisonError, follows_filter, law_words
from .refine import tighten_settling_time
from .torque_bound import TorqueBound, torque_bound
from .worst_found import WorstFound, find_worst

MAX_TABLE_WINDOWS = 400
"""Windows of a finite table that are certified; of a longer one the claims say up to when they speak."""
SEARCH_PERIODS = 3
"""Periods simulated when looking for the worst start: the least R is seen early."""


@final
@dataclass(frozen=True)
class FloorAnswer:
    """Everything that was found; None where it does not apply.

    Attributes
    ----------
    claims : "filter.floor", "convergence" and, if a limit was given, "torque.limit"
    """

    claims: tuple[Claim, ...]
    floor: FilterLowerBound | None
    converged: ConvergedFloor | None
    worst: WorstFound | None
    torque: TorqueBound | None
    convergence: Convergence | None


def answer(question: FloorQuestion) -> FloorAnswer:
    """Answer a question about the floor of R."""
    q, schedule, settled = question, question.mission.schedule, question.mission.tolerance
    tolerances = {"attitude": float(settled.attitude), "rate": float(settled.rate)}
    proved = _proved(q)
    decay = q.law.parameters.get("lambda")
    has_filter = follows_filter(close_loop(q.law))
    converged = None
    short = schedule.period is not None and len(schedule.windows) <= MAX_PERIOD_WINDOWS
    if short and has_filter and decay is not None and decay > 0:
        converged = ConvergedFilter(schedule, decay).floor()
    worst = None
    if q.search is not None and has_filter:
        worst = find_worst(
            q.law, q.mission.body, schedule, q.initial, horizon=_search_horizon(schedule),
            max_rate=q.mission.starts.max_rate, search=q.search, norms=_measured(q.mission),
        )  # fmt: skip
    floor, torque, found = proved.floor, proved.torque, proved.convergence
    facts = FloorFacts(
        no_system=proved.refused or (_no_system(q) if floor is None else ""),
        no_system_step=_no_system_step(q.law) if floor is None else "",
        floor=floor,
        converged=converged,
        along_run=q.run_floor,
        worst=worst,
        certificate=proved.certificate,
    )
    claims = [convergence_claim(facts, found, **tolerances)]
    if any(state.name == "R" for state in q.law.controller_states):  # of other laws R says nothing
        claims.insert(0, floor_claim(facts))
    if q.mission.limit is not None:
        claims.append(torque_claim(facts, torque, q.mission.limit, q.run_peak))
    return FloorAnswer(tuple(claims), floor, converged, worst, torque, found)


@final
@dataclass(frozen=True)
class _Proved:
    """A floor with what follows from it and its certificate; or why the law's own proof was refused."""

    floor: FilterLowerBound | None = None
    torque: TorqueBound | None = None
    convergence: Convergence | None = None
    certificate: Certificate | None = None
    refused: str = ""


def _proved(q: FloorQuestion) -> _Proved:
    """Certify; what the code of a law's own proof raises refuses that proof, and ends nothing else."""
    try:
        return _certified(q)
    except Exception as error:
        if not own_proofs(q.law):
            raise
        said = f"{type(error).__name__}: {error}"
        return _Proved(refused=f"the proof that {law_words(q.law)} brings fails ({said})")


def _certified(q: FloorQuestion) -> _Proved:
    schedule, settled, horizon = q.mission.schedule, q.mission.tolerance, None
    if schedule.period is None:
        last = schedule.windows[:MAX_TABLE_WINDOWS][-1].off
        horizon = min(q.horizon, schedule.end) if q.horizon is not None else min(last, schedule.end)
    floor = certify_floor(q.law, q.bounds, schedule, q.initial, horizon=horizon, options=q.options)
    if floor is None:
        return _Proved()
    tolerances = {"attitude": float(settled.attitude), "rate": float(settled.rate)}
    floor = tighten_settling_time(floor, **tolerances, options=q.options)
    torque = torque_bound(floor) if floor.steps else None
    found = analyse_convergence(floor, **tolerances) if floor.steps else None
    if not reaches_far_enough(floor):
        return _Proved(floor, torque, found)
    certificate = floor_certificate(q, floor, convergence=found, torque=torque)
    refused = refusal(certificate, floor)
    return _Proved(refused=refused) if refused else _Proved(floor, torque, found, certificate)


def _measured(mission: Mission) -> tuple[Norm, ...]:
    """Norms in which the runs over the set are measured: the limit's too, if it is one of the torque."""
    own = (mission.limit.norm,) if mission.limit is not None and mission.limit.norm.limits_torque else ()
    return tuple(dict.fromkeys((*MEASURED, *own)))


def _no_system(question: FloorQuestion) -> str:
    """Why a law has no comparison system."""
    try:
        system_of(question.law, question.bounds)
    except NoComparisonError as error:
        return str(error)
    return ""


def _no_system_step(law: Law) -> str:
    """What the user of a law without comparison system can do."""
    if LAWS.get(law.name) is type(law):
        return "judge the law by its runs (intermit compare), and leave this key out of [check] claims"
    if own_proofs(law):
        return f"mend the proof that {type(law).__name__}.proofs returns, or its part of the checker"
    return (
        f"return a comparison system from {type(law).__name__}.proofs (docs/how-to/add-a-law.md), or write "
        "the law as docs/theory-floor.md does: + - * / alone, no limit on the torque in it"
    )


def _search_horizon(schedule: Schedule) -> Fraction:
    """Three periods, or the end of a finite table's third window cycle."""
    if schedule.period is not None and len(schedule.windows) == 1:
        return SEARCH_PERIODS * schedule.period
    later = [w.on for w in schedule.windows[SEARCH_PERIODS : SEARCH_PERIODS + 1]]
    return later[0] if later else schedule.end
