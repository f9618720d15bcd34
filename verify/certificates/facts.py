"""A schedule's facts and the filter's start as certificates, proved or refuted, as they were decided."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from fractions import Fraction
from itertools import pairwise

from ...models.laws import Law
from ...models.schedule import Schedule
from .. import checker
from ..schedule.filter_start import greatest_gain_at
from ..schedule.timeline import Timeline
from ..verdict import Claim, Verdict
from .format import Certificate, certificate_text
from .schedule import schedule_data

COUNTEREXAMPLE = "schedule-counterexample"


def fact_certificate(schedule: Schedule, claim: Claim) -> Certificate | None:
    """Certificate of a claim of `schedule_facts`, as it was decided; None if it has none.

    A refuted order has none: a scenario with such windows is refused when it is read.
    """
    make = (_PROVED if claim.verdict is Verdict.PROVED else _REFUTED).get(claim.key)
    return None if make is None else _accepted(make(Timeline(schedule)))


def filter_start_certificate(schedule: Schedule, law: Law) -> Certificate | None:
    """Certificate that R(0) is within its bound, or above it.

    None for a law whose R(0) is not its parameter R0, and where twelve digits do not tell.
    """
    start = next((state.initial for state in law.controller_states if state.name == "R"), None)
    given = {name: law.parameters[name] for name in ("lambda", "R0") if name in law.parameters}
    if len(given) < 2 or start != given["R0"]:
        return None
    data = {"parameters": given, "schedule": schedule_data(schedule)}
    low, high, instant = greatest_gain_at(schedule)
    claim = {"greatest": high}
    if given["lambda"] * given["R0"] <= 2 * low**2:
        return _accepted(Certificate("filter-start", data, claim, {"instant": instant}))
    return _accepted(Certificate("filter-start-counterexample", data, claim))


def windows_data(schedule: Schedule) -> dict[str, object]:
    """Thruster windows and the times in which its thrust is uncertain, as certificate data."""
    return {
        "windows": [(window.on, window.off) for window in schedule.windows],
        "thruster": {"rise": schedule.thruster_rise, "fall": schedule.thruster_fall},
    }


def _accepted(certificate: Certificate | None) -> Certificate | None:
    if certificate is None:
        return None
    findings = checker.check_text(certificate_text([certificate]))
    return certificate if all(finding.valid for finding in findings) else None


def _data(timeline: Timeline, *names: str) -> dict[str, object]:
    known = windows_data(timeline.schedule)
    return {"schedule": schedule_data(timeline.schedule)} | {name: known[name] for name in names}


def _order(timeline: Timeline) -> Certificate:
    schedule = timeline.schedule
    claim = {"shortest_window": min(w.length for w in schedule.windows)}
    gaps = list(_gaps(schedule))
    if gaps:
        claim["shortest_gap"] = min(gaps)
    return Certificate("schedule-order", _data(timeline, "windows"), claim)


def _gaps(schedule: Schedule) -> Iterator[Fraction]:
    windows = schedule.windows
    for before, after in pairwise(windows):
        yield after.on - before.off
    if schedule.period is not None:
        yield windows[0].on + schedule.period - windows[-1].off


def _smooth(timeline: Timeline) -> Certificate:
    return Certificate("schedule-smooth", _data(timeline), {})


def _support(timeline: Timeline) -> Certificate:
    return Certificate("schedule-support", _data(timeline, "windows"), {})


def _uncertain(timeline: Timeline) -> Certificate:
    return Certificate("schedule-uncertain-thrust", _data(timeline, "windows", "thruster"), {})


def _jump(timeline: Timeline) -> Certificate | None:
    jump = timeline.first_jump()
    if jump is None:
        return None
    claim = {"fact": "smooth", "instant": jump.instant}
    return Certificate(COUNTEREXAMPLE, _data(timeline), claim)


def _acts_outside(timeline: Timeline) -> Certificate | None:
    action = next(iter(timeline.actions(timeline.gaps())), None)
    if action is None:
        return None
    claim = {"fact": "support", "instant": action.instant}
    return Certificate(COUNTEREXAMPLE, _data(timeline, "windows"), claim)


def _acts_uncertainly(timeline: Timeline) -> Certificate | None:
    action = next(iter(timeline.actions(timeline.uncertain())), None)
    if action is None:
        return None
    claim = {"fact": "uncertain-thrust", "instant": action.instant}
    return Certificate(COUNTEREXAMPLE, _data(timeline, "windows", "thruster"), claim)


Maker = Callable[[Timeline], Certificate | None]
_PROVED: Mapping[str, Maker] = {
    "schedule.order": _order,
    "schedule.smooth": _smooth,
    "schedule.support": _support,
    "schedule.uncertain-thrust": _uncertain,
}
_REFUTED: Mapping[str, Maker] = {
    "schedule.smooth": _jump,
    "schedule.support": _acts_outside,
    "schedule.uncertain-thrust": _acts_uncertainly,
}
