"""Persistent excitation: how much the schedule acts within every interval of length T.

mu1(T) and mu2(T) are the least and the greatest integral of g^2 over [t, t + T]. mu1(T) > 0
exactly if T exceeds the longest run on which g is zero (at T equal to it, mu1 = 0: the infimum
of such T is not attained). All in exact rational arithmetic.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.schedule import Schedule, Window
from ...models.schedule import polynomial as poly
from ...models.schedule.polynomial import Coefficients
from ..claim_table import CLAIM_KEYS, stated
from ..exact.bernstein import least_value
from ..exact.rational_quantity import rational_quantity, seconds
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness
from .excitation_screen import MAX_EXACT, screen
from .moving_integral import MovingIntegral, Segment
from .zero_runs import default_length, longest_zero_run, missable_windows

KEY = "schedule.excitation"
SOURCE = CLAIM_KEYS[KEY].source
RELATIVE_WIDTH = Fraction(1, 10**12)
"""Largest width of the enclosures of mu1 and mu2, relative to T."""


@final
@dataclass(frozen=True)
class Bound:
    """An extreme of the integral of g^2 over [t, t + T], s.

    Attributes
    ----------
    low, high : the exact extreme lies between them
    instant : t at which the integral is `high` for mu1, `low` for mu2, exactly
    """

    low: Fraction
    high: Fraction
    instant: Fraction


@final
@dataclass(frozen=True)
class Excitation:
    """Excitation over every interval of one length.

    Attributes
    ----------
    length : T, s
    least, greatest : mu1(T) and mu2(T)
    zero_run : longest interval on which g is zero (of a finite table: within it), or None
    periodic : whether the table repeats; otherwise all intervals lie within the table
    segments : polynomial pieces of the moving integral that were bounded
    exact_segments : how many of them in rationals (the others were ruled out in floats)
    """

    length: Fraction
    least: Bound
    greatest: Bound
    zero_run: Window | None
    periodic: bool
    segments: int
    exact_segments: int


def excitation(schedule: Schedule, length: Fraction) -> Excitation:
    """Enclose mu1 and mu2 of a schedule.

    Parameters
    ----------
    schedule : Schedule
        The schedule whose g it is about.
    length : Fraction
        T > 0, s. For a finite table only intervals within it count.

    Raises
    ------
    ValueError
        If the length is not positive.
    """
    if length <= 0:
        raise ValueError(f"the excitation window must be > 0 s, received {float(length):g}")
    moving = MovingIntegral(schedule, length)
    segments = list(moving.segments())
    every = list(range(len(segments)))
    low, high = (every, every) if len(segments) <= MAX_EXACT else screen(moving, segments)
    least, used = _extreme(moving, [segments[i] for i in low], length, sign=1)
    greatest, also = _extreme(moving, [segments[i] for i in high], length, sign=-1)
    least = Bound(max(least.low, Fraction(0)), least.high, least.instant)
    run = longest_zero_run(schedule)
    return Excitation(length, least, greatest, run, schedule.is_periodic, len(segments), used + also)


def _extreme(
    moving: MovingIntegral, segments: Sequence[Segment], length: Fraction, *, sign: int
) -> tuple[Bound, int]:
    """Minimum (sign 1) or maximum (sign -1) of the moving integral."""
    best: dict[tuple[object, ...], tuple[int, Segment]] = {}
    for segment in segments:
        # segments with the same pieces and offsets differ by a constant: only the least can hold the extreme
        key = _shape(moving, segment)
        whole = sign * moving.whole_pieces(segment)
        if key not in best or whole < best[key][0]:
            best[key] = whole, segment
    candidates = [segment for _, segment in best.values()]
    polynomials = [_signed(moving, segment, sign) for segment in candidates]
    found = least_value(polynomials, RELATIVE_WIDTH * length)
    segment = candidates[found.index]
    instant = moving.clock.time(segment.start) + found.argument * moving.clock.time(segment.width)
    low, high = sorted((sign * found.low, sign * found.high))
    return Bound(low, high, instant), len(candidates)


def _shape(moving: MovingIntegral, segment: Segment) -> tuple[object, ...]:
    """What a segment's polynomial depends on, but for its constant: zero parts of g all count alike."""
    parts = [part if moving.squares[part[0]] else None for part in (segment.lower, segment.upper)]
    return (segment.width if any(parts) else 0, *parts)


def _signed(moving: MovingIntegral, segment: Segment, sign: int) -> Coefficients:
    along = poly.add(moving.increment(segment), poly.polynomial(moving.value(segment)))
    return poly.scale(along, Fraction(sign)) or (Fraction(0),)


def excitation_claim(schedule: Schedule, length: Fraction | None = None) -> Claim:
    """Claim that g is persistently exciting: every interval of length T holds some of g^2.

    Parameters
    ----------
    schedule : Schedule
        The schedule whose g it is about.
    length : Fraction or None
        T, s; by default `default_length`.

    Returns
    -------
    Claim
        "schedule.excitation": PROVED with mu1 and mu2 enclosed, or REFUTED with an interval on which
        g is zero. Never UNDECIDED. Of a finite table it speaks of intervals within the table only.
    """
    T = default_length(schedule) if length is None else length
    result = excitation(schedule, T)
    within = "" if result.periodic else " within the table"
    title = f"{CLAIM_KEYS[KEY].title}{within}"
    where = "for ever, since the table repeats" if result.periodic else _finite(schedule)
    statement = f"every interval of {seconds(T)} holds a positive integral of g^2 ({where})"
    evidence = Evidence(
        EvidenceKind.CERTIFICATE,
        "extremes of the moving integral of g^2, a piecewise polynomial, enclosed by Bernstein coefficients "
        f"in rationals{_screened(result)}; positive exactly if the interval exceeds the longest zero run",
        source=SOURCE,
        details={"segments": result.segments, "segments_in_rationals": result.exact_segments},
    )
    quantities = _quantities(result)
    run = result.zero_run
    if result.least.high == 0 or (run is not None and run.length >= T):
        return _refuted(title, statement, evidence, quantities, result)
    margins = [rational_quantity("slack", T - (run.length if run else 0), unit="s", label="gaps may grow by")]
    missable = missable_windows(schedule, T)
    if missable is not None:
        label = "windows in a row that may be missed"
        margins.append(Quantity("missable_windows", missable, missable, label=label, rigorous=True))
    return stated(KEY, statement, Verdict.PROVED, (evidence,), quantities, tuple(margins), title=title)


def _screened(result: Excitation) -> str:
    if result.segments <= MAX_EXACT:
        return ""
    return " (pieces that hold no extreme were first ruled out in floats, with an error allowance)"


def _finite(schedule: Schedule) -> str:
    return (
        f"within the finite table, up to {seconds(schedule.end)}; after it g = 0, and only a table that "
        "repeats excites for ever"
    )


def _quantities(result: Excitation) -> tuple[Quantity, ...]:
    least, greatest = result.least, result.greatest
    quantities = [
        rational_quantity(
            "mu1", least.low, least.high, "s", f"least integral, from t = {seconds(least.instant)}"
        ),
        rational_quantity(
            "mu2",
            greatest.low,
            greatest.high,
            "s",
            f"greatest integral, from t = {seconds(greatest.instant)}",
        ),
        rational_quantity("interval", result.length, unit="s", label="length of the interval"),
    ]
    if result.zero_run is not None:
        label = "longest zero run, which the interval must exceed"
        quantities.append(
            rational_quantity("longest_zero_run", result.zero_run.length, unit="s", label=label)
        )
    return tuple(quantities)


def _refuted(
    title: str,
    statement: str,
    evidence: Evidence,
    quantities: tuple[Quantity, ...],
    result: Excitation,
) -> Claim:
    run = result.zero_run
    start = run.on if run is not None else result.least.instant
    length = run.length if run is not None else result.length
    witness = Witness(
        f"g is zero from {seconds(start)} to {seconds(start + length)}: an interval of "
        f"{seconds(result.length)} from there holds nothing",
        {"time": float(start), "zero_run": float(length)},
        rational_quantity("zero_run", length, unit="s"),
    )
    return stated(KEY, statement, Verdict.REFUTED, (evidence,), quantities, witness=witness, title=title)
