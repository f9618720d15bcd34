"""Kind robust-floor: R above a floor, and attitude and rate bounded, on every body of an uncertainty.

The inequalities are those of `robust_persistence` and `robust_adaptive`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction

from .bernstein import bernstein, eighths
from .comparison import NO_BOUND, Bounds, initial_values
from .exact_numbers import require, show
from .filter_floor import cosine_below
from .floor_bounds import root_above
from .floor_steps import FloorStep, read_steps, require_loose
from .kinds import kind
from .known_laws import gain_numbers, read_scaled
from .reading import Node
from .robust_adaptive import RobustAdaptive
from .robust_constants import (
    RobustConstants,
    Uncertain,
    describe_uncertainty,
    read_constants,
    read_uncertainty,
    require_scales,
)
from .robust_persistence import RobustPersistence
from .robust_steps import Robust, RobustSystem, check_step
from .schedules import Profile, describe_profile, read_profile, require_continuous

Edges = tuple[Fraction, Fraction]


@dataclass(frozen=True)
class RobustBin:
    """One bin of bodies and starts: its constants, what is rounded once of them, its proved steps."""

    constants: RobustConstants
    root: Fraction
    angles: Edges
    system: RobustSystem
    steps: list[FloorStep]
    tail: list[FloorStep]
    ratio: Fraction | None


def read_system(data: Node) -> RobustSystem:
    """Return the system of the law of the data: its equations are proved to be the law's."""
    law = read_scaled(data)
    if law.loop.states == ("R",):
        R0 = initial_values(data, {"R": "R0"})["R"]
        require(R0 > 0, "expected R(0) > 0")
        return RobustPersistence(law.lam, R0)
    gamma, a = gain_numbers(law)
    start = initial_values(data, {"R": "R0", "k": "k0"})
    require(start["R"] > 0 and start["k"] >= 0, "expected R(0) > 0 and k(0) >= 0")
    return RobustAdaptive(law.lam, start["R"], gamma, a, start["k"])


def _check_bin(
    data: Node, place: Node, u: Uncertain, witness: Node, system: RobustSystem, profile: Profile
) -> RobustBin:
    """Check one bin: its start, its steps, and its repeating part if it has one."""
    k = read_constants(data, place, u, witness)
    root = 1 / root_below_of(k.least)
    c = root / root_below_of(Fraction(8))
    weakest = 1 + u.thrust[0] if u.stays else Fraction(1)
    d = Robust(profile, k, k.forcings(), c, u.push / weakest * root)
    low, high = place["s"].vector(2)
    require(0 <= low <= high, "a bin's angles are out of order")
    check_start(data, d, system.kappa(), high, place["y"].number())
    steps = read_steps(place["steps"], Fraction(0), system.sides)
    require_loose(
        _sides(system, steps[0]), system.start([low, high], place["y"].number()), steps[0], place.path
    )
    _check_run(system, d, steps, tail=False, scaled=False)
    if not place.has("tail"):
        return RobustBin(k, root, (low, high), system, steps, [], None)
    if isinstance(system, RobustAdaptive):
        system = system.with_limit(place["tail"])
    tail, ratio = _check_tail(system, d, place["tail"], steps[-1])
    return RobustBin(k, root, (low, high), system, steps, tail, ratio)


def root_below_of(value: Fraction) -> Fraction:
    """Return a positive rational <= sqrt(value)."""
    return value / root_above(value)


def _sides(system: RobustSystem, step: FloorStep, *, tail: bool = False) -> dict[str, int]:
    """Sides of the components that a step keeps; what it gives up says nothing."""
    lost = {"y", "s", "v", "z"} - system.kept(step)
    return {n: side for n, side in (system.tail_sides if tail else system.sides).items() if n not in lost}


def _check_run(
    system: RobustSystem, d: Robust, steps: Sequence[FloorStep], *, tail: bool, scaled: bool
) -> None:
    """Check steps one by one: a bound given up stays given up."""
    kept = system.kept(steps[0])
    for step in steps:
        require(system.kept(step) <= kept, "a bound that was given up comes back")
        kept = system.kept(step)
        check_step(system, d, step, tail=tail, scaled=scaled)


def _check_tail(
    system: RobustSystem, d: Robust, place: Node, last: FloorStep
) -> tuple[list[FloorStep], Fraction | None]:
    """Check a part that repeats for ever.

    Without a disturbance angle and rate end at most `ratio` times where they began; with one, no higher.
    """
    period = d.profile.period
    require(period is not None, "a finite schedule has no repeating part")
    assert period is not None
    require(last.stop % period == 0, "the repeating part must begin at a whole period")
    steps = read_steps(place["steps"], last.stop, system.tail_sides)
    require(steps[-1].stop == last.stop + period, "the repeating part must cover one period")
    kept = system.kept(steps[0])
    require(kept <= system.kept(last), "a bound that was given up comes back")
    require(all(system.kept(step) == kept for step in steps), "a bound is kept on a part of a period only")
    ratio = place["ratio"].number() if place.has("ratio") else None
    require(ratio is None or 0 <= ratio < 1, "the ratio must lie in [0, 1)")
    require(
        (ratio is None) == bool(d.push), "a ratio needs that nothing pushes, and nothing else goes without"
    )
    before: Bounds = {name: pair[1] for name, pair in last.ends.items()}
    sides = _sides(system, steps[0], tail=True)
    require_loose(sides, system.repeats(steps, before, ratio), steps[0], place.path)
    _check_run(system, d, steps, tail=True, scaled=ratio is not None)
    for name, side in sides.items():
        first, end = steps[0].ends[name][0], steps[-1].ends[name][1]
        if name == "E":
            continue
        if name in kept and ratio is not None:
            require(end <= ratio * first, f"{place.path}: {name} does not shrink by the ratio")
        else:
            require(side * (first - end) >= 0, f"{place.path}: {name} does not come back to where it began")
    return steps, ratio


def check_start(data: Node, d: Robust, kappa: Fraction, s: Fraction, y: Fraction) -> None:
    """Check that s and y bound every start of the set: x(0) = Omega + Phi zeta in the metric of the bin."""
    node, k = data["initial_set"], d.constants
    require(y >= 0, "the initial set is not one")
    g = d.profile.shapes[0][0] if d.profile.shapes[0] else Fraction(0)
    zeta = 2 * g * g * kappa * min(Fraction(1), s * NO_BOUND)
    stretch, enough = k.mismatch * zeta, False
    if node.has("max_weighted_rate"):
        reach = abs(node["max_weighted_rate"].number()) + root_above(k.hi) * stretch
        enough = y * y >= k.widening * reach * reach
    if node.has("max_rate") or not node.has("max_weighted_rate"):
        rate = abs(node["max_rate"].number()) if node.has("max_rate") else Fraction(0)
        reach = rate + zeta + stretch
        enough = enough or y * y >= k.widening * k.hi * reach * reach
    require(enough, "y is too small for the rates of the set")


def require_angles(data: Node, bins: list[RobustBin]) -> None:
    """Check that for every body's factor the bins hold every error angle of the set."""
    angle = data["initial_set"]["max_angle_deg"].number()
    require(0 <= angle <= 360, "the initial set is not one")
    scales = {b.constants.scale for b in bins}
    for scale in scales:
        reached = Fraction(0)
        for low, high in sorted(b.angles for b in bins if b.constants.scale == scale):
            require(low <= reached, "no bin holds some error angle of the set")
            reached = max(reached, high)
        enough = reached * reached >= 2 or angle == 0 or reached * reached >= 1 - cosine_below(angle / 2)
        require(enough, "s is too small for the angle")


def describe_set(data: Node) -> str:
    """Return the initial set for people."""
    node = data["initial_set"]
    words = [f"2 acos(b0) <= {show(node['max_angle_deg'].number())} deg"]
    for name, form in (("max_weighted_rate", "sqrt(Omega'J0 Omega) <= {}"), ("max_rate", "|w| <= {} rad/s")):
        if node.has(name):
            require(node[name].number() >= 0, "a bound of the rate must not be negative")
            words.append(form.format(show(node[name].number())))
    return ", ".join(words if len(words) > 1 else [*words, "at rest"])


@kind("robust-floor")
def check_robust_floor(data: Node, certificate: Node) -> list[str]:
    """R >= floor on every body from every start of a set; convergence, or a bound for good."""
    claim, witness = certificate["claim"], certificate["witness"]
    system, u = read_system(data), read_uncertainty(data)
    profile = read_profile(data)
    require_continuous(profile)
    bins = [_check_bin(data, place, u, witness, system, profile) for place in witness["bins"].items()]
    require(bool(bins), "there are no bins")
    require_scales(u, [b.constants.scale for b in bins])
    require_angles(data, bins)
    floor = claim["floor"].number()
    require(floor > 0, "the floor must be positive")
    for proved in bins:
        for step in (*proved.steps, *proved.tail):
            require(step.x["r"].is_at_least(floor), f"r falls below the floor after {show(step.start)} s")
    if claim.has("horizon"):
        horizon = claim["horizon"].number()
        reached = all(b.tail or b.steps[-1].stop >= horizon for b in bins)
        require(horizon > 0 and reached, "a bin ends before the horizon")
        when = f"on [0, {show(horizon)}] s"
    else:
        require(all(b.tail for b in bins), "a bin has no repeating part: no claim for all time")
        when = "for all t >= 0"
    return [
        f"R(t) >= {show(floor)} s {when},",
        f"from every start with {describe_set(data)},",
        *describe_uncertainty(data, u),
        "  J0 the inertia that the controller uses",
        *system.words(),
        f"{describe_profile(profile)},",
        _describe_inertia(data),
        *_check_convergence(claim, bins, profile),
        *_check_settling(claim, bins, profile),
        *_check_bounds(claim, bins, profile),
    ]


def _describe_inertia(data: Node) -> str:
    rows = data["inertia"].matrix(3, 3)
    return "J0 = " + str([[show(x) for x in row] for row in rows]).replace("'", "") + " kg m^2"


def _check_convergence(claim: Node, bins: list[RobustBin], profile: Profile) -> list[str]:
    """Check that sqrt(1 - b0) and |x|_J shrink by the claimed ratio per period, if that is claimed."""
    if not claim.has("ratio"):
        return []
    ratio, start = claim["ratio"].number(), claim["ratio_from"].number()
    require(ratio < 1, "the ratio must be below 1")
    for b in bins:
        shrinks = b.tail and b.ratio is not None and b.ratio <= ratio and b.tail[0].start <= start
        require(bool(shrinks), "a bin does not shrink by the ratio")
    assert profile.period is not None
    return [
        "and the bounds of sqrt(1 - b0) and |x|_J, x = w + J^-1 M J0 2 g^2 kappa bv, shrink by a factor",
        f"{show(ratio)} every {show(profile.period)} s from t = {show(start)} s on:",
        "attitude and rate converge",
    ]


def _check_bounds(claim: Node, bins: list[RobustBin], profile: Profile) -> list[str]:
    """Check bounds of S and |w| that hold from a time on, for good or to the horizon, if they are claimed."""
    if not claim.has("bounds"):
        return []
    lines, end = [], _until(claim)
    for node in claim["bounds"].items():
        start, gap, rate = (node[name].number() for name in ("from", "gap", "rate"))
        require(not end or start < claim["horizon"].number(), "bounds begin after the horizon")
        for b in bins:
            for step, repeats in [*((s, False) for s in b.steps), *((s, True) for s in b.tail)]:
                for stop, S, w in _boxes(b, step, profile, scaled=False):  # the first period's are greatest
                    if repeats or stop > start:
                        require(gap >= S and w <= rate, f"the bounds do not hold before {show(stop)} s")
        words = f"and 1 - b0 <= {show(gap)}, |w| <= {show(rate)} rad/s from t = {show(start)} s on"
        lines.append(words + end)
    return lines


def _until(claim: Node) -> str:
    """What a claim up to a horizon says of its end; nothing is known beyond it."""
    return f" up to {show(claim['horizon'].number())} s" if claim.has("horizon") else ""


def _check_settling(claim: Node, bins: list[RobustBin], profile: Profile) -> list[str]:
    """Check that |bv| and |w| stay within tolerances from a time on, if that is claimed."""
    if not claim.has("settling"):
        return []
    time, attitude, rate = (claim["settling"][name].number() for name in ("time", "attitude", "rate"))
    require(attitude > 0 and rate > 0, "the tolerances must be positive")
    for b in bins:
        for step in b.steps:
            for stop, S, w in _boxes(b, step, profile, scaled=False):
                n = root_above(S * (2 - S)) if S < 1 else Fraction(1)
                require(stop <= time or (n <= attitude and w <= rate), f"not settled before {show(stop)} s")
        if not b.tail:
            require(claim.has("horizon"), "a bin has no repeating part")
            continue
        period, ratio = profile.period, Fraction(1) if b.ratio is None else b.ratio
        assert period is not None
        first = max(int((time - b.tail[0].start) // period), 0)
        require(first <= 10**4, "the settling time is out of range")
        for step in b.tail:
            for stop, S, w in _boxes(b, step, profile, scaled=True):
                for periods in (first, first + 1):
                    scale = ratio**periods
                    within = root_above(2 * S) * scale <= attitude and w * scale <= rate
                    require(stop + periods * period <= time or within, f"not settled before {show(stop)} s")
    end = _until(claim) or " for good"
    require(end == " for good" or time < claim["horizon"].number(), "settled after the horizon")
    return [f"and |bv| <= {show(attitude)}, |w| <= {show(rate)} rad/s from t = {show(time)} s on{end}"]


def _boxes(
    b: RobustBin, step: FloorStep, profile: Profile, *, scaled: bool
) -> list[tuple[Fraction, Fraction, Fraction]]:
    """End, S and |w| on the eighths of a step.

    Where it is scaled down |bv| <= sqrt(2 S) shrinks with s, and a bound of S above 2 counts in full.
    """
    bounds = {name: eighths(p) for name, p in step.x.items()}
    length = (step.stop - step.start) / 8
    result = []
    for i in range(8):
        start = step.start + i * length
        low = {name: pairs[i][0] for name, pairs in bounds.items()}
        high = {name: max(pairs[i][1], Fraction(0)) for name, pairs in bounds.items()}
        S, y, gain = b.system.box(low, high, step)
        S = S if scaled else min(S, Fraction(2))
        n = root_above(2 * S) if scaled else root_above(S * (2 - S)) if S < 1 else Fraction(1)
        g = max(map(abs, bernstein(profile.gain(start, start + length))))
        turn = (1 + b.constants.mismatch) * 2 * g * g * gain * n
        result.append((start + length, S, y * b.root + turn))
    return result
