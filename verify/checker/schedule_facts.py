"""Kinds schedule-order, -smooth, -support, -uncertain-thrust and their counterexample."""

from __future__ import annotations

from bisect import bisect_right
from fractions import Fraction
from itertools import pairwise

from .exact_numbers import require, show
from .kinds import kind
from .reading import Node
from .schedules import Profile, describe_profile, read_profile, require_smooth

# A window is an interval [on, off] in which full thrust is certain. All comparisons are of rationals.


Span = tuple[Fraction, Fraction]


def read_windows(data: Node, profile: Profile) -> list[Span]:
    """Read the thruster windows of the table, or of one period, as the file lists them."""
    rows = data["windows"].matrix(columns=2)
    require(bool(rows), "there is no window")
    windows = [(on, off) for on, off in rows]
    within = profile.period is None or all(off <= profile.period for _, off in windows)
    require(all(on >= 0 for on, _ in windows) and within, "a window lies outside the period")
    return windows


def following(windows: list[Span], profile: Profile) -> list[Fraction]:
    """Gap after each window; the last one's up to the first window of the next period, if there is one."""
    gaps = [after[0] - before[1] for before, after in pairwise(windows)]
    if profile.period is not None:
        gaps.append(windows[0][0] + profile.period - windows[-1][1])
    return gaps


@kind("schedule-order")
def check_order(data: Node, certificate: Node) -> list[str]:
    """Windows are not empty, in order of time and disjoint, from one period to the next as well."""
    profile, claim = read_profile(data), certificate["claim"]
    windows = read_windows(data, profile)
    length = claim["shortest_window"].number()
    require(length > 0, "the shortest window must be longer than nothing")
    require(all(off - on >= length for on, off in windows), "a window is shorter than claimed")
    text = f"{describe_windows(windows, profile)}: in order, each at least {show(length)} s long,"
    gaps = following(windows, profile)
    if not gaps:
        return [text, "and there is only one"]
    least = claim["shortest_gap"].number()
    require(least >= 0, "a negative gap is an overlap")
    require(all(gap >= least for gap in gaps), "two windows are closer to each other than claimed")
    return [text, f"at least {show(least)} s from one to the next: disjoint"]


@kind("schedule-smooth")
def check_smooth(data: Node, certificate: Node) -> list[str]:
    """G and dg/dt are continuous at every knot, from one period to the next and at a table's end."""
    del certificate
    profile = read_profile(data)
    require_smooth(profile)
    return [f"g is C1: value and slope agree at every knot, for {describe_profile(profile)}"]


@kind("schedule-support")
def check_support(data: Node, certificate: Node) -> list[str]:
    """G = 0 outside the windows: every piece that is not the zero polynomial lies within one."""
    del certificate
    profile = read_profile(data)
    windows, joined = read_windows(data, profile), list[list[Fraction]]()
    for on, off in sorted(windows):
        if joined and on <= joined[-1][1]:
            joined[-1][1] = max(joined[-1][1], off)
        else:
            joined.append([on, off])
    openings = [on for on, _ in joined]
    for a, b in acting(profile):
        i = bisect_right(openings, a) - 1
        require(i >= 0 and b <= joined[i][1], f"g acts on [{show(a)}, {show(b)}] s, not within a window")
    return [f"g(t) = 0 outside {describe_windows(windows, profile)}, for {describe_profile(profile)}"]


@kind("schedule-uncertain-thrust")
def check_uncertain_thrust(data: Node, certificate: Node) -> list[str]:
    """G = 0 for the thruster's rise before every window and for its fall after it."""
    del certificate
    profile = read_profile(data)
    windows = read_windows(data, profile)
    rise, fall, spans = uncertain_spans(data, windows, profile)
    pieces = acting(profile)
    stops = [b for _, b in pieces]
    for on, off in spans:
        i = bisect_right(stops, on)
        met = i < len(pieces) and pieces[i][0] < off
        require(not met, f"g acts within [{show(on)}, {show(off)}] s, where the thrust is uncertain")
    return [
        f"g(t) = 0 for {show(rise)} s before and {show(fall)} s after {describe_windows(windows, profile)},",
        f"for {describe_profile(profile)}",
    ]


def acting(profile: Profile) -> list[Span]:
    """Pieces on which g is not the zero polynomial, in order of time."""
    pieces = zip(profile.shapes, pairwise(profile.knots), strict=True)
    return [(a, b) for shape, (a, b) in pieces if any(shape)]


def uncertain_spans(
    data: Node, windows: list[Span], profile: Profile
) -> tuple[Fraction, Fraction, list[Span]]:
    """Return rise, fall, and the intervals of [0, end] in which the thruster does either, in order.

    A window of a neighbouring period counts too.
    """
    rise, fall = (data["thruster"][name].number() for name in ("rise", "fall"))
    require(rise >= 0 and fall >= 0, "rise and fall must not be negative")
    end = profile.knots[-1]
    spans = [(on - rise, on) for on, _ in windows] + [(off, off + fall) for _, off in windows]
    shifts = (-end, Fraction(0), end) if profile.period is not None else (Fraction(0),)
    cut = [(max(a + shift, Fraction(0)), min(b + shift, end)) for a, b in spans for shift in shifts]
    return rise, fall, sorted((a, b) for a, b in cut if a < b)


def describe_windows(windows: list[Span], profile: Profile) -> str:
    """Return the windows for people."""
    first = f"[{show(windows[0][0])}, {show(windows[0][1])}] s"
    named = f"the window {first}" if len(windows) == 1 else f"the {len(windows)} windows from {first} on"
    return named + (f", every {show(profile.period)} s" if profile.period is not None else "")


@kind("schedule-counterexample")
def check_schedule_counterexample(data: Node, certificate: Node) -> list[str]:
    """One of the facts above is false, at the instant that the claim names."""
    profile, claim = read_profile(data), certificate["claim"]
    fact, t = claim["fact"].text(), claim["instant"].number()
    require(0 <= t <= profile.knots[-1], "the instant lies outside the table")
    if fact == "smooth":
        require(t > 0 or profile.period is not None, "a table begins at 0 s: there is nothing before it")
        sides = [profile.side(t, after=False), profile.side(t, after=True)]
        require(sides[0] != sides[1], "g and its slope are continuous there")
        values = " against ".join(f"g = {show(g)}, g' = {show(slope)} 1/s" for g, slope in sides)
        return [f"g is not C1: at t = {show(t)} s {values} after it, for {describe_profile(profile)}"]
    windows, g = read_windows(data, profile), profile.side(t, after=True)[0]
    require(g != 0, "g is zero there")
    where = describe_windows(windows, profile)
    if fact == "support":
        shifts = (0,) if profile.period is None else (-profile.period, 0, profile.period)
        closed = not any(on <= t + shift <= off for on, off in windows for shift in shifts)
        require(closed, "a window is open there")
        where = f"outside {where}"
    else:
        require(fact == "uncertain-thrust", f"there is no fact {fact!r}")
        rise, fall, spans = uncertain_spans(data, windows, profile)
        require(any(a < t < b for a, b in spans), "the thruster neither rises nor falls there")
        where = f"while the thruster rises ({show(rise)} s) or falls ({show(fall)} s) about {where}"
    return [f"g({show(t)} s) = {show(g)}, not zero, {where}, for {describe_profile(profile)}"]
