"""Claims about every body and thruster of an uncertainty: floor, convergence or the bound for good."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from math import degrees
from typing import Any

from ...models.uncertainty import NOMINAL
from ..claim_table import CLAIM_KEYS, stated
from ..exact.rounding import digits_above, digits_below
from ..filter.recognise import NoComparisonError
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict
from .answer import RobustFloor, RobustQuestion, certify_robust_floor
from .certificate import robust_certificate
from .consequences import Consequences, angle_of, consequences
from .found import MembersFound
from .margins import channel_margins
from .words import covered_words

PAGE = CLAIM_KEYS["robust.floor"].source
DIGITS = 6


def robust_claims(
    question: RobustQuestion, found: MembersFound | None = None, *, margins: bool = False
) -> tuple[Claim, ...]:
    """Claims about a law on every body of its uncertainty.

    Parameters
    ----------
    question : RobustQuestion
        The loop as the controller knows it, and what it does not know.
    found : MembersFound, optional
        Figures of extreme members, shown beside what is proved.
    margins : bool
        Look for how much more of each channel is proved.

    Returns
    -------
    tuple of Claim
        "robust.floor", and "robust.convergence" or, with a disturbance, "robust.ultimate".
    """
    key = "robust.ultimate" if question.mission.uncertainty.disturbance else "robust.convergence"
    beside = tuple(_found_quantities(found)) if found is not None else ()
    seen = {"robust.floor": [b for b in beside if b.name == "members_floor"]}
    seen[key] = [b for b in beside if b.name != "members_floor"]
    try:
        floor = certify_robust_floor(question)
    except (NoComparisonError, ValueError) as error:
        step = "narrow the uncertainty"
        if isinstance(error, NoComparisonError):
            step = "read the figures of the members that were flown; they are no proof"
        keys = ("robust.floor", key) if _has_filter(question) else (key,)
        return tuple(_undecided(k, question, str(error), step, tuple(seen[k])) for k in keys)
    open_ended = question.mission.schedule.period is not None and not floor.grows
    if floor.failed_at is not None or (open_ended and not floor.repeats):
        reason, step = _shortfall(floor)
        return tuple(_undecided(k, question, reason, step, tuple(seen[k])) for k in ("robust.floor", key))
    drawn = consequences(floor)
    evidence = _evidence(floor, drawn)
    motion = _motion_claim(key, floor, drawn, evidence, tuple(seen[key]))
    if margins and motion.verdict is Verdict.PROVED:
        motion = replace(motion, margins=tuple(channel_margins(question, _is_proved)))
    return _floor_claim(floor, evidence, tuple(seen["robust.floor"])), motion


def _floor_claim(floor: RobustFloor, evidence: Evidence, beside: tuple[Quantity, ...]) -> Claim:
    q = floor.question
    value = Quantity(
        "robust_floor", floor.value, floor.value, "s", "R_min certified, every body and start", True, "lower"
    )
    return stated(
        "robust.floor",
        statement=f"R(t) >= {digits_below(floor.value, DIGITS)} s {_when(floor)}, {_quantifiers(q)}",
        verdict=Verdict.PROVED,
        evidence=(evidence,),
        quantities=(value, *beside),
    )


def _motion_claim(
    key: str, floor: RobustFloor, drawn: Consequences, evidence: Evidence, beside: tuple[Quantity, ...]
) -> Claim:
    """Convergence or the bound for good; of a finite table neither is a limit to speak of."""
    q = floor.question
    quantities = (*_reach(floor, drawn), *beside)
    if floor.grows:
        reason = "any disturbance keeps the gain k growing: k' >= 0 never stops, so nothing holds for good"
        step = f"the bounds over [0, {float(floor.horizon or 0):g}] s stand below (simulation.horizon)"
        return _undecided(key, q, reason, step, quantities)
    if drawn.ratio is None and drawn.ultimate is None:
        reason = "the table is finite: after its last window nothing acts, so nothing holds for good"
        step = "give the schedule a period if it repeats; the bounds over the table stand below"
        return _undecided(key, q, reason, step, quantities)
    if drawn.ultimate is not None:
        u = drawn.ultimate
        says = (
            f"from t = {u.start:g} s on the error angle stays <= {digits_above(degrees(u.angle), 4)} deg and "
            f"|w| <= {digits_above(u.rate, 4)} rad/s, {_quantifiers(q)}"
        )
    else:
        assert drawn.ratio is not None
        assert q.mission.schedule.period is not None
        says = (
            f"the bounds of sqrt(1 - b0) and |x|_J shrink by a factor {digits_above(drawn.ratio, DIGITS)} "
            f"every {float(q.mission.schedule.period):g} s from t = {float(drawn.ratio_from):g} s on"
        )
        if drawn.settling is not None:
            settled = q.mission.tolerance
            says += (
                f"; |bv| <= {float(settled.attitude):g} and |w| <= {float(settled.rate):g} rad/s for good "
                f"after {digits_above(drawn.settling, DIGITS)} s"
            )
        says += f", {_quantifiers(q)}"
    return stated(
        key,
        statement=says,
        verdict=Verdict.PROVED,
        evidence=(evidence,),
        quantities=quantities,
    )


def _evidence(floor: RobustFloor, drawn: Consequences) -> Evidence:
    pipes = [pipe for _, pipe in floor.parts]
    steps = sum(sum(1 for _ in pipe.all_steps()) for pipe in pipes)
    details: dict[str, Any] = {"steps": steps, "certificate": robust_certificate(floor, drawn)}
    return Evidence(
        EvidenceKind.CERTIFICATE,
        f"{len(pipes)} polynomial sub- and supersolutions, {steps} steps, every differential inequality "
        "proved by Bernstein coefficients in exact rationals, with constants that hold for every body",
        source=PAGE,
        details=details,
    )


def _reach(floor: RobustFloor, drawn: Consequences) -> Iterator[Quantity]:
    when = "" if floor.horizon is None else f" {_when(floor)}"
    yield Quantity(
        "robust_largest_angle", 0.0, degrees(angle_of(drawn.largest_gap)) * (1 + 1e-14), "deg",
        f"error angle 2 acos(b0) at most{when}, every body", True, "upper",
    )  # fmt: skip
    yield Quantity(
        "robust_largest_rate", 0.0, drawn.largest_rate, "rad/s",
        f"rate |w| at most{when}, every body", True, "upper",
    )  # fmt: skip
    if drawn.ultimate is not None:
        u = drawn.ultimate
        whose = f"from t = {u.start:g} s on, every body"
        yield Quantity(
            "robust_ultimate_angle",
            0.0,
            degrees(u.angle) * (1 + 1e-14),
            "deg",
            f"error angle {whose}",
            True,
            "upper",
        )
        yield Quantity("robust_ultimate_rate", 0.0, u.rate, "rad/s", f"rate |w| {whose}", True, "upper")
    if drawn.settling is not None:
        until = "" if floor.horizon is None else f", up to {float(floor.horizon):g} s alone"
        yield Quantity(
            "robust_settling", 0.0, drawn.settling, "s",
            f"settled at the latest{until}, every body", True, "upper",
        )  # fmt: skip


def _found_quantities(found: MembersFound) -> Iterator[Quantity]:
    whose = f"in {found.count} runs of extreme members from the scenario's start"
    if found.least_filter is not None:
        yield Quantity.point(
            "members_floor", found.least_filter, "s", digits=4, label=f"least R found {whose}"
        )
    yield Quantity.point(
        "members_angle",
        degrees(found.largest_angle),
        "deg",
        digits=4,
        label=f"largest error angle found {whose}",
    )
    for name, value, unit, what in (
        ("members_last_angle", degrees(found.last_angle), "deg", "error angle"),
        ("members_last_rate", found.last_rate, "rad/s", "rate |w|"),
    ):
        label = f"largest {what} found in their last tenth, to {found.horizon:g} s"
        yield Quantity.point(name, value, unit, digits=3, label=label)


def _has_filter(question: RobustQuestion) -> bool:
    return any(state.name == "R" for state in question.law.controller_states)


def _quantifiers(q: RobustQuestion) -> str:
    starts = q.mission.starts
    start = f"2 acos(b0) <= {float(starts.max_angle_deg):.6g} deg"
    if starts.max_rate is not None:
        start += f", |w(0)| <= {float(starts.max_rate):.6g} rad/s"
    if starts.max_weighted_rate is not None:
        start += f", |Omega(0)|_J0 <= {float(starts.max_weighted_rate):.6g} sqrt(kg m^2) rad/s"
    elif starts.max_rate is None:
        start += ", at rest"
    covered = covered_words(q.mission.uncertainty)
    known = "; the controller uses J0 and g"
    if q.mission.inertia_tolerance is not None:
        known += "; J0 is the inertia as stated (spacecraft.inertia_tolerance is not covered here)"
    return f"from every start with {start}, for {covered}{known}"


def _when(floor: RobustFloor) -> str:
    return "for all t >= 0" if floor.horizon is None else f"on [0, {float(floor.horizon):g}] s"


def _shortfall(floor: RobustFloor) -> tuple[str, str]:
    """Why a floor was not proved, and the channel without which it would be."""
    q = floor.question
    at = floor.failed_at
    where = f"from t = {float(at):.4g} s" if at is not None else "as a repeating bound"
    reason = f"with {', '.join(q.mission.uncertainty.channels)} together nothing could be proved {where}"
    enough = [name for name in q.mission.uncertainty.channels if _is_proved_without(q, name)]
    if enough:
        return (
            reason,
            f"without {' or without '.join(enough)} it is proved: narrow it, or narrow the initial set",
        )
    if _is_proved(q.about(NOMINAL)):
        return reason, "with nothing uncertain it is proved: narrow the uncertainty, or the initial set"
    return reason, "not even with nothing uncertain could it be proved: narrow the initial set first"


def _is_proved_without(q: RobustQuestion, channel: str) -> bool:
    default = getattr(NOMINAL, channel)
    changes: dict[str, Any] = {channel: default}
    return _is_proved(q.about(replace(q.mission.uncertainty, **changes)))


def _is_proved(q: RobustQuestion) -> bool:
    try:
        floor = certify_robust_floor(q)
    except ValueError:
        return False
    return floor.failed_at is None and (floor.repeats or floor.grows or q.mission.schedule.period is None)


def _undecided(
    key: str, q: RobustQuestion, reason: str, step: str, quantities: tuple[Quantity, ...]
) -> Claim:
    general = {
        "robust.floor": "R(t) >= R_min > 0",
        "robust.convergence": "error angle and rate go to zero",
        "robust.ultimate": "error angle and rate stay within a bound from some time on",
    }
    return stated(
        key,
        statement=f"{general[key]}, {_quantifiers(q)}",
        verdict=Verdict.UNDECIDED,
        reason=reason,
        next_step=step,
        quantities=quantities,
    )
