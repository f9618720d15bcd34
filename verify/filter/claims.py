"""Claims that rest on the certified floor: R_min, convergence, the torque limit.

Each answer about R_min is labelled with what it guarantees: certified (every start of the set),
converged (an upper bound of inf R of every run), along a run, worst found.
"""

from __future__ import annotations

from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from math import degrees, isfinite
from typing import final

from ...models.apart import apart
from ...models.mission import TorqueLimit
from ...models.norms import Norm
from ..certificates.format import Certificate
from ..claim_table import CLAIM_KEYS, stated
from ..exact.rounding import digits_above, digits_below
from ..schedule.zero_runs import longest_zero_run
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict
from .certify import FilterLowerBound, idle_exponent
from .converged import ConvergedFloor
from .convergence import Convergence
from .torque_bound import TorqueBound
from .worst_found import WorstFound

PAGE = CLAIM_KEYS["filter.floor"].page
FORGOTTEN = 10
"""Lambda times an off-time after which what is left of R, below 1e-4 of it, is why no step is proved."""
MUELLER = CLAIM_KEYS["filter.floor"].source


@final
@dataclass(frozen=True, kw_only=True)
class FloorFacts:
    """Everything known about R_min of one law; what was not asked for is None.

    Attributes
    ----------
    no_system, no_system_step : why the law has no comparison system, and what its user can do; empty if it
        has one
    floor : certified floor; None if the law has no comparison system
    converged : for periodic schedules
    along_run : least R of the scenario's own run, s, and its horizon, s
    worst : least R found over the set
    certificate : the floor written out for the stand-alone checker
    """

    no_system: str
    no_system_step: str
    floor: FilterLowerBound | None
    converged: ConvergedFloor | None = None
    along_run: tuple[float, float] | None = None
    worst: WorstFound | None = None
    certificate: Certificate | None = None


def floor_claim(facts: FloorFacts) -> Claim:
    """Claim "filter.floor": R(t) >= R_min > 0 from every start of the set."""
    floor = facts.floor
    quantities = _other_answers(facts)
    if floor is None:
        return _undecided(
            "filter.floor",
            "R(t) >= R_min > 0",
            facts.no_system,
            facts.no_system_step,
            quantities,
        )
    asked = "for all t >= 0" if floor.schedule.period is not None else "over the table"
    if not reaches_far_enough(floor):
        reason, step = _shortfall(floor)
        statement = f"R(t) >= R_min > 0 {asked}, from every start with {floor.initial.description}"
        return _undecided("filter.floor", statement, reason, step, quantities)
    asked = _covered(floor)
    certified = Quantity(
        "certified_floor",
        floor.value,
        floor.value,
        "s",
        "R_min certified, every start of the set",
        True,
        "lower",
    )
    return stated(
        "filter.floor",
        (f"R(t) >= {_down(floor.value)} s {asked}, from every start with {floor.initial.description}"),
        Verdict.PROVED,
        (_certificate(facts, floor), *_search_evidence(facts)),
        (certified, *quantities),
    )


def convergence_claim(facts: FloorFacts, found: Convergence | None, attitude: float, rate: float) -> Claim:
    """Claim "convergence": error angle and rate go to zero within a proved envelope."""
    floor = facts.floor
    general = "error angle and rate go to zero from every start of the initial set"
    if floor is None:
        return _undecided("convergence", general, facts.no_system, facts.no_system_step)
    if found is None:
        return _undecided("convergence", general, *_shortfall(floor))
    quantities = _reach_quantities(floor, found)
    if floor.schedule.period is None:
        reason = "the table is finite: after its last window nothing acts, so no limit exists to speak of"
        step = f"give the schedule a period if it repeats; the proved bounds stand {_covered(floor)}"
        return _undecided("convergence", general, reason, step, quantities)
    if not found.converges:
        reason, step = _shortfall(floor)
        return _undecided("convergence", general, reason, step)
    period = floor.schedule.period
    statement = (
        f"from every start with {floor.initial.description}, the bounds of sqrt(1 - b0) and |Omega|_J "
        f"shrink by a factor {_up(found.ratio)} every {float(period):g} s "
        f"from t = {float(found.envelope_start):g} s on"
    )
    if found.settling is not None:
        statement += (
            f"; |bv| <= {attitude:g} and |w| <= {rate:g} rad/s for good after {_up(found.settling)} s"
        )
    system = floor.system
    why = (Evidence(EvidenceKind.THEOREM, system.why_it_converges, PAGE),) if system.why_it_converges else ()
    return stated("convergence", statement, Verdict.PROVED, (_certificate(facts, floor), *why), quantities)


def limit_words(limit: TorqueLimit) -> str:
    """A torque limit as a statement."""
    return f"|g u| <= {float(limit.torque):g} {limit.norm.unit} ({limit.norm.key})"


def torque_claim(
    facts: FloorFacts,
    bound: TorqueBound | None,
    limit: TorqueLimit,
    seen: float | None = None,
) -> Claim:
    """Claim "torque.limit": the applied torque g u stays within the limit.

    `seen` is the largest applied torque of the scenario's own run in that norm, N m, for the reason.
    """
    floor, norm = facts.floor, limit.norm
    statement = limit_words(limit)
    if floor is None:
        return _undecided("torque.limit", statement, facts.no_system, facts.no_system_step)
    where = f"from every start with {floor.initial.description}"
    if bound is None or not reaches_far_enough(floor):
        reason, step = _shortfall(floor)
        return _undecided("torque.limit", f"{statement} {where}", reason, step)
    statement += f" {_covered(floor)}, {where}"
    quantities = torque_quantities(bound)
    if not isfinite(bound.applied):
        reason = f"the certified floor of R, {_down(floor.value)} s, lets the gain grow beyond all numbers"
        return _undecided("torque.limit", statement, reason, _filter_step(floor), quantities)
    if not norm.limits_torque:
        reason = f"what is certified bounds the torque's length: what {norm.name} need for it is not bounded"
        step = "give the limit as one of the torque's components or length, N m"
        return _undecided("torque.limit", statement, reason, step, quantities)
    # the torque's length, which is bounded, is never below its peak
    if Fraction(bound.applied) <= limit.torque:
        reserve = float(limit.torque) - bound.applied
        margin = Quantity("torque_reserve", reserve, reserve, "N m", "reserve")
        return stated(
            "torque.limit",
            statement,
            Verdict.PROVED,
            (_certificate(facts, floor),),
            quantities,
            (margin,),
        )
    reason = f"the certified bound {_up(bound.applied)} N m exceeds the limit"
    largest = _largest_found(facts, norm, seen)
    if largest is not None:
        value, whose = largest
        word = "exceeds it too" if value > limit.torque else "does not"
        reason += f"; the largest torque {whose}, {apart(value, limit.torque, digits=4)[0]} N m, {word}"
        if value > 0:
            reason += f" (the bound is {bound.applied / value:.2g} times it)"
    gains = ", ".join(floor.law.parameters)
    step = f"narrow the initial set, lower the gains ({gains}), or raise the limit"
    return _undecided("torque.limit", statement, reason, step, quantities)


def _largest_found(facts: FloorFacts, norm: Norm, seen: float | None) -> tuple[float, str] | None:
    """Largest torque that this study saw, N m in that norm, and whose it is."""
    found = [] if seen is None else [(seen, "of the simulated run")]
    if facts.worst is not None and norm in facts.worst.peak:
        found.append((facts.worst.peak[norm], f"of {facts.worst.runs} runs over the set"))
    return max(found, default=None)


def torque_quantities(bound: TorqueBound) -> tuple[Quantity, ...]:
    """Torque bounds as quantities; none where no finite bound is known."""
    if not isfinite(bound.applied):
        return ()
    return (
        Quantity(
            "torque_bound_applied",
            0.0,
            bound.applied,
            "N m",
            "applied torque g u, Euclidean, at most",
            True,
            "upper",
        ),
        Quantity(
            "torque_bound_commanded",
            0.0,
            bound.commanded,
            "N m",
            "command u, Euclidean, at most",
            True,
            "upper",
        ),
        Quantity("gain_bound", 0.0, bound.gain, "1/s", "gain kappa at most", True, "upper"),
    )


def reaches_far_enough(floor: FilterLowerBound) -> bool:
    """Whether the certificate covers all that can be asked: all time, or the whole finite table."""
    return floor.horizon is None or (floor.failed_at is None and floor.schedule.period is None)


def _covered(floor: FilterLowerBound) -> str:
    """The time that a certificate covers."""
    return "for all t >= 0" if floor.horizon is None else f"on [0, {_seconds(floor.horizon)}]"


def _other_answers(facts: FloorFacts) -> tuple[Quantity, ...]:
    found = []
    if facts.converged is not None:
        c = facts.converged
        label = "R_min converged, no run stays above it for ever"
        found.append(Quantity("converged_floor", c.low, c.high, "s", label, True))
    if facts.along_run is not None:
        value, end = facts.along_run
        label = f"R_min along the simulated run to {end:g} s"
        found.append(Quantity.point("floor_along_run", value, "s", digits=7, label=label))
    if facts.worst is not None:
        runs = f"{facts.worst.runs} run{'s' if facts.worst.runs > 1 else ''}"
        label = f"R_min worst found in {runs} over the set to {facts.worst.horizon:g} s"
        found.append(Quantity.point("worst_floor_found", facts.worst.value, "s", digits=7, label=label))
    return tuple(found)


def _reach_quantities(floor: FilterLowerBound, found: Convergence) -> tuple[Quantity, ...]:
    if floor.failed_at is not None:
        return ()
    angle = degrees(found.largest_angle) * (1 + 1e-14)
    items = [
        Quantity("largest_angle", 0.0, angle, "deg", "error angle 2 acos(b0) at most", True, "upper"),
        Quantity("largest_rate", 0.0, found.largest_rate, "rad/s", "rate |w| at most", True, "upper"),
    ]
    if found.settling is not None:
        items.append(
            Quantity("settling_bound", 0.0, found.settling, "s", "settled at the latest", True, "upper")
        )
    return tuple(items)


def _certificate(facts: FloorFacts, floor: FilterLowerBound) -> Evidence:
    summary = (
        f"{len(floor.flowpipes)} polynomial sub- and supersolutions, {floor.steps} steps, every differential "
        "inequality proved by Bernstein coefficients in exact rationals"
    )
    part = floor.system.part
    if part is not None:
        summary += f"; they are the law's own, restated by its part of the checker ({part.title})"
    details: dict[str, object] = {"steps": floor.steps}
    if facts.certificate is not None:
        details["certificate"] = facts.certificate
    return Evidence(EvidenceKind.CERTIFICATE, summary, source=MUELLER, details=details)


def _search_evidence(facts: FloorFacts) -> tuple[Evidence, ...]:
    if facts.worst is None or facts.floor is None:
        return ()
    gap = facts.worst.value / facts.floor.value - 1
    summary = (
        f"search of {facts.worst.runs} runs: the certified floor is at most {100 * gap:.2g} per cent too low"
    )
    start = {"quaternion": list(facts.worst.quaternion), "rate": list(facts.worst.rate)}
    return (Evidence(EvidenceKind.SAMPLES, summary, details=start),)


def _shortfall(floor: FilterLowerBound) -> tuple[str, str]:
    told = floor.system.why_stuck(floor.initial)
    if told is not None:
        return told
    gap = longest_zero_run(floor.schedule)
    exponent = idle_exponent(floor.law, floor.schedule)
    has_filter = floor.system.floor_component is not None
    if has_filter and floor.failed_at is not None and gap is not None and exponent > FORGOTTEN:
        learns = "k" in (state.name for state in floor.law.controller_states)
        then = (
            "the gain k learns by it: next to nothing is certified of what it learns"
            if learns
            else "the gain of the next window is one over what is left"
        )
        if gap.on == 0:
            return (
                f"until the first window opens R decays by exp(-{exponent:.3g}) (lambda times "
                f"{float(gap.off):.6g} s), and {then}",
                "start the run with the first window (initial.time), or lower lambda "
                f"(now {_decay(floor):g} 1/s)",
            )
        return (
            f"while no window is open R decays by exp(-{exponent:.3g}) (lambda times the longest off-time), "
            f"and {then}",
            _filter_step(floor),
        )
    if floor.failed_at is not None and not floor.lost_angle:
        return (
            f"no further step could be proved from t = {float(floor.failed_at):.4g} s",
            "split the initial set finer (max_bins), or narrow it",
        )
    if floor.failed_at is not None:
        return (
            f"the certified bound of the error angle reaches 2 pi at t = {float(floor.failed_at):.4g} s: "
            "beyond it nothing can be certified",
            "narrow the initial set (smaller error angle or rate), or shorten the first off-time",
        )
    end = float(floor.horizon) if floor.horizon is not None else 0.0
    held = f"R >= {_down(floor.value)} s is" if isfinite(floor.value) else "bounds are"
    return (
        f"{held} certified on [0, {end:g}] s only: no repeating bound was found",
        "allow more periods, or narrow the initial set",
    )


def _decay(floor: FilterLowerBound) -> float:
    return float(floor.law.parameters.get("lambda", Fraction(0)))


def _filter_step(floor: FilterLowerBound) -> str:
    return f"lower lambda (now {_decay(floor):g} 1/s) or shorten the longest off-time"


def _undecided(
    key: str,
    statement: str,
    reason: str,
    next_step: str,
    quantities: tuple[Quantity, ...] = (),
) -> Claim:
    return stated(
        key, statement, Verdict.UNDECIDED, quantities=quantities, reason=reason, next_step=next_step
    )


def _seconds(value: Fraction) -> str:
    return f"{float(value):.9g} s"


def _down(value: float) -> str:
    """Five digits, never above the value."""
    return _written(digits_below(value, 5))


def _up(value: float) -> str:
    """Five digits, never below the value."""
    return _written(digits_above(value, 5))


def _written(value: Decimal) -> str:
    plain = value == 0 or -6 < value.adjusted() < 12
    return f"{value:f}" if plain else f"{value:e}".replace("e+", "e")
