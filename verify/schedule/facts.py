"""What must be true of a schedule before any law is looked at, decided in exact rationals.

Order: the windows are ordered and disjoint. Smooth: g is C1. Support: g is zero outside the
windows. Uncertain thrust: g is zero while the thruster rises or falls. A window is an interval
in which full thrust is certain; during `thruster_rise` before it and `thruster_fall` after it
the thrust is unknown, so that there g must be zero.
"""

from __future__ import annotations

from fractions import Fraction

from ...models.schedule import Schedule
from ..claim_table import PAPER, stated
from ..exact.rational_quantity import rational_quantity, seconds
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness
from .timeline import Action, Jump, Timeline

EXACT = Evidence(
    EvidenceKind.CERTIFICATE,
    "every window, knot and piece compared in exact rational arithmetic",
    source="docs/schedule.md",
)
E9 = Evidence(
    EvidenceKind.WITNESS,
    "erratum E9: the printed g(2 t_r + t_on) = 0 keeps g acting for t_r after the thruster shuts off; "
    "g(t_r + t_on) = 0 was probably meant. The scenario asks for g as printed, so this is not counted",
    source=PAPER,
)


def schedule_claims(schedule: Schedule, *, overruns_as_printed: bool = False) -> tuple[Claim, ...]:
    """Decide the facts of a schedule.

    Parameters
    ----------
    schedule : Schedule
        The schedule, exact. One period, or the finite table, is examined; a periodic g repeats it.
    overruns_as_printed : bool
        True if g was asked to overrun `off` as the paper prints it: g acting within `thruster_fall`
        after `off` is then reported as erratum E9 and not counted.

    Returns
    -------
    tuple of Claim
        "schedule.order", "schedule.smooth", "schedule.support" and, where thruster_rise or
        thruster_fall is given, "schedule.uncertain-thrust". Never UNDECIDED.
    """
    timeline = Timeline(schedule)
    claims = [
        order_claim(timeline),
        smooth_claim(timeline),
        support_claim(timeline, overruns_as_printed=overruns_as_printed),
    ]
    if schedule.thruster_rise or schedule.thruster_fall:
        claims.append(uncertain_thrust_claim(timeline, overruns_as_printed=overruns_as_printed))
    return tuple(claims)


def order_claim(timeline: Timeline) -> Claim:
    """Decide that windows are not empty, in order, and disjoint, the first of the next period included."""
    time, windows = timeline.clock.time, list(timeline.windows)
    key = "schedule.order"
    statement = f"{_count(timeline.schedule)}: in order and disjoint"
    lengths = [off - on for on, off in windows]
    if timeline.schedule.is_periodic:
        windows.append((windows[0][0] + timeline.end, windows[0][1] + timeline.end))
    gaps = [windows[i + 1][0] - windows[i][1] for i in range(len(windows) - 1)]
    trouble = next((i for i, length in enumerate(lengths) if length <= 0), None)
    if trouble is not None:
        on, off = windows[trouble]
        what = f"window {trouble + 1} closes before it opens"
        return _order_refuted(key, statement, what, time(off), time(on - off))
    trouble = next((i for i, gap in enumerate(gaps) if gap < 0), None)
    if trouble is not None:
        what = f"window {trouble + 1} is still open when the next one opens"
        return _order_refuted(key, statement, what, time(windows[trouble + 1][0]), time(-gaps[trouble]))
    quantities = [rational_quantity("shortest_window", time(min(lengths)), unit="s")]
    margins: tuple[Quantity, ...] = ()
    if gaps:
        quantities.append(rational_quantity("longest_gap", time(max(gaps)), unit="s"))
        label = "windows stay apart while one grows by less than"
        margins = (rational_quantity("shortest_gap", time(min(gaps)), unit="s", label=label),)
    return stated(key, statement, Verdict.PROVED, (EXACT,), tuple(quantities), margins)


def smooth_claim(timeline: Timeline) -> Claim:
    """Decide that g is C1 at every knot, from one period to the next and at a table's end."""
    key = "schedule.smooth"
    statement = f"g and dg/dt are continuous at all {len(timeline.knots)} knots"
    jump = timeline.first_jump()
    if jump is None:
        return stated(key, statement, Verdict.PROVED, (EXACT,))
    return stated(key, statement, Verdict.REFUTED, (EXACT,), witness=_jump_witness(jump))


def support_claim(timeline: Timeline, *, overruns_as_printed: bool = False) -> Claim:
    """Decide that g is zero outside the windows."""
    key = "schedule.support"
    statement = "g(t) = 0 outside the windows, where full thrust is not certain"
    found = timeline.actions(timeline.gaps())
    if found:
        excused = overruns_as_printed and _only_overruns(timeline, found)
        return _action_refuted(key, statement, found, "outside every window", excused)
    margins: tuple[Quantity, ...] = ()
    inner = timeline.inner_margins()
    if inner is not None:
        opening, closing = (timeline.clock.time(x) for x in inner)
        margins = (
            rational_quantity("opening_margin", opening, unit="s", label="windows may open later by"),
            rational_quantity("closing_margin", closing, unit="s", label="windows may close earlier by"),
        )
    return stated(key, statement, Verdict.PROVED, (EXACT,), margins=margins)


def uncertain_thrust_claim(timeline: Timeline, *, overruns_as_printed: bool = False) -> Claim:
    """Decide that g is zero during thruster_rise before each window and thruster_fall after it."""
    key = "schedule.uncertain-thrust"
    schedule = timeline.schedule
    statement = (
        f"g(t) = 0 while the thruster rises ({seconds(schedule.thruster_rise)} before each window) "
        f"and falls ({seconds(schedule.thruster_fall)} after it)"
    )
    found = timeline.actions(timeline.uncertain())
    if found:
        excused = overruns_as_printed and _only_overruns(timeline, found)
        return _action_refuted(key, statement, found, "while the thrust is uncertain", excused)
    return stated(key, statement, Verdict.PROVED, (EXACT,))


def _only_overruns(timeline: Timeline, found: list[Action]) -> bool:
    """Whether g acts only within `thruster_fall` after a window's end, before the next one's rise."""
    schedule = timeline.schedule
    offs = sorted(w.off for w in schedule.windows)
    i = 0
    for action in found:
        while i + 1 < len(offs) and offs[i + 1] <= action.interval.on:
            i += 1
        if not offs[i] <= action.interval.on or action.interval.off > offs[i] + schedule.thruster_fall:
            return False
    return True


def _count(schedule: Schedule) -> str:
    number = len(schedule.windows)
    text = f"{number} window{'s' if number != 1 else ''}"
    if schedule.period is None:
        return f"{text} of a finite table"
    return f"{text} in each period of {seconds(schedule.period)}"


def _order_refuted(key: str, statement: str, what: str, at: Fraction, by: Fraction) -> Claim:
    if by == 0:
        violation, what = Quantity("empty_windows", 1.0, 1.0, rigorous=True), f"{what}: it is empty"
    else:
        violation = rational_quantity("overlap", by, unit="s")
    witness = Witness(f"{what}, at {seconds(at)}", {"time": float(at)}, violation)
    return stated(key, statement, Verdict.REFUTED, (EXACT,), witness=witness)


def _jump_witness(jump: Jump) -> Witness:
    unit = "" if jump.what == "g" else "1/s"
    size = f"{float(jump.size):.6g} {unit}".rstrip()
    return Witness(
        f"{jump.what} jumps by {size} at {seconds(jump.instant)}",
        {"time": float(jump.instant)},
        rational_quantity("jump", jump.size, unit=unit),
    )


def _action_refuted(key: str, statement: str, found: list[Action], where: str, excused: bool) -> Claim:
    first = found[0]
    span = f"{seconds(first.interval.on)} to {seconds(first.interval.off)}"
    more = f" (and in {len(found) - 1} more places)" if len(found) > 1 else ""
    witness = Witness(
        f"g is not zero from {span}, {where}{more}: g = {float(first.value):.6g} at {seconds(first.instant)}",
        {"time": float(first.instant), "from": float(first.interval.on), "to": float(first.interval.off)},
        rational_quantity("g", first.value),
    )
    evidence = (EXACT, E9) if excused else (EXACT,)
    return stated(
        key, statement, Verdict.REFUTED, evidence, witness=witness, counted=False if excused else None
    )
