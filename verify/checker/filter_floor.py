"""Kinds filter-floor and comparison: R above a floor, convergence, settling, torque over an initial set."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from .body import describe_inertia, inertia_vertices
from .comparison import NO_BOUND, Bounds, Comparison, Found, Setting, find_system
from .exact_numbers import Vector, require, show
from .floor_boxes import FloorBin, all_boxes, check_settling, check_torque
from .floor_steps import FloorStep, check_step, read_steps, require_loose
from .kinds import Proof, kind
from .matrices import is_positive_semidefinite
from .reading import Node
from .schedules import describe_profile, read_profile, require_continuous


def read_setting(data: Node, witness: Node) -> Setting:
    """Read g, and check c >= 1/sqrt(8 Jmin) and greatest >= Jmax for every inertia."""
    c, greatest = witness["coupling"].number(), witness["greatest_inertia"].number()
    require(c > 0, "the coupling must be positive")
    for J in inertia_vertices(data):  # convex in J: the vertices suffice
        gap = [[8 * c * c * J[i][j] - (1 if i == j else 0) for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "the coupling is below 1/sqrt(8 Jmin)")
        gap = [[(greatest if i == j else 0) - J[i][j] for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "the greatest inertia is too small")
    profile = read_profile(data)
    require_continuous(profile)
    return Setting(c, greatest, profile)


PI_HIGH = Fraction(31415926535897932384626433832795028842, 10**37)
"""Above pi, by less than 1e-37."""


def cosine_below(degrees: Fraction) -> Fraction:
    """Return a rational <= cos(degrees), 0 <= degrees <= 180, by an alternating series cut while it falls."""
    x = degrees * PI_HIGH / 180
    term, total_, k = Fraction(1), Fraction(1), 0
    while k % 2 == 0 or abs(term) > Fraction(1, 10**40):
        k += 1
        term = -term * x * x / ((2 * k - 1) * (2 * k))
        total_ += term
    return total_


def check_initial_set(data: Node, system: Comparison, setting: Setting, witness: Node) -> str:
    """Check that the witness's box [0, s] x [0, y] holds the initial set; return the set for people."""
    node, box = data["initial_set"], witness["box"]
    s, y = box["s"].number(), box["y"].number()
    angle = node["max_angle_deg"].number()
    require(0 <= angle <= 360 and s >= 0 and y >= 0, "the initial set is not one")
    require(s * s >= 2 or angle == 0 or s * s >= 1 - cosine_below(angle / 2), "s is too small for the angle")
    words = [f"2 acos(b0) <= {show(angle)} deg"]
    enough = False
    if node.has("max_weighted_rate"):
        weighted = node["max_weighted_rate"].number()
        require(weighted >= 0, "a bound of the rate must not be negative")
        words.append(f"sqrt(Omega'J Omega) <= {show(weighted)}")
        enough = y >= weighted
    if node.has("max_rate") or not node.has("max_weighted_rate"):
        rate = node["max_rate"].number() if node.has("max_rate") else Fraction(0)
        require(rate >= 0, "a bound of the rate must not be negative")
        words.append(f"|w| <= {show(rate)} rad/s" if node.has("max_rate") else "at rest")
        g = setting.profile.shapes[0][0] if setting.profile.shapes[0] else Fraction(0)
        reach = abs(rate) + 2 * g * g * system.kappa() * min(Fraction(1), s * NO_BOUND)  # |bv| <= s sqrt 2
        enough = enough or y * y >= setting.greatest * reach * reach
    require(enough, "y is too small for the rates of the set")
    return ", ".join(words)


def require_cover(bins: list[tuple[Vector, Vector]], s: Fraction, y: Fraction) -> None:
    """Check that rectangles cover [0, s] x [0, y]."""
    s_edges = sorted({Fraction(0), s, *(e for b, _ in bins for e in b if 0 < e < s)})
    y_edges = sorted({Fraction(0), y, *(e for _, b in bins for e in b if 0 < e < y)})
    for a, b in list(pairwise(s_edges)) or [(s, s)]:
        for c, e in list(pairwise(y_edges)) or [(y, y)]:
            held = any(p[0] <= a and b <= p[1] and q[0] <= c and e <= q[1] for p, q in bins)
            require(held, f"no bin holds s in [{show(a)}, {show(b)}], y in [{show(c)}, {show(e)}]")


def check_bin(system: Comparison, setting: Setting, place: Node, s: Vector, y: Vector) -> FloorBin:
    """Check one bin: its start, its steps, and its repeating part if it has one."""
    steps = read_steps(place["steps"], Fraction(0), system.sides)
    known = system.start(s, y)
    require(known.keys() == system.sides.keys(), "the system leaves the start of a component open")
    require_loose(system.sides, known, steps[0], place.path)
    for step in steps:
        check_step(system, setting.profile, step, tail=False)
    ends = {name: pair[1] for name, pair in steps[-1].ends.items()}
    if not place.has("tail"):
        return FloorBin(steps, [], Fraction(1), ends)
    tail, ratio = check_tail(system, setting, place["tail"], steps[-1].stop, ends)
    return FloorBin(steps, tail, ratio, ends)


def check_tail(
    system: Comparison, setting: Setting, place: Node, start: Fraction, known: Bounds
) -> tuple[list[FloorStep], Fraction]:
    """Check a part that repeats for ever: lower bounds end no lower, upper bounds no higher than they began.

    Those of angle and rate end at most `ratio` times where they began.
    """
    period, ratio = setting.profile.period, place["ratio"].number()
    require(period is not None, "a finite schedule has no repeating part")
    assert period is not None
    require(start % period == 0, "the repeating part must begin at a whole period")
    require(0 <= ratio < 1, "the ratio must lie in [0, 1)")
    sides = system.tail_sides
    steps = read_steps(place["steps"], start, sides)
    require(steps[-1].stop == start + period, "the repeating part must cover one period")
    require(
        sides.keys() <= known.keys(), "the repeating part has a component that the steps before it have not"
    )
    require_loose(sides, known, steps[0], place.path)
    for step in steps:
        check_step(system, setting.profile, step, tail=True)
    given_up = system.given_up(steps[0].modes)
    same = all(system.given_up(step.modes) == given_up for step in steps)
    require(same, "the angle is bounded on a part of a period only")
    for name, side in sides.items():
        first, last = steps[0].ends[name][0], steps[-1].ends[name][1]
        if name in given_up or name in system.free:
            continue
        if name in system.decaying:
            require(last <= ratio * first, f"{place.path}: {name} does not shrink by the ratio")
        else:
            require(side * (first - last) >= 0, f"{place.path}: {name} does not come back to where it began")
    return steps, ratio


@kind("filter-floor")
def check_filter_floor(data: Node, certificate: Node) -> Proof:
    """R >= floor from every start of a set, for all time or up to a horizon; and convergence."""
    claim, witness = certificate["claim"], certificate["witness"]
    setting = read_setting(data, witness)
    found = find_system(data, witness, setting)
    system = found.system
    require(system.floor is not None, f"the comparison system {system.name} bounds no filter state")
    words = check_initial_set(data, system, setting, witness)
    bins = _bins(system, setting, witness)
    floor = claim["floor"].number()
    require(floor > 0, "the floor must be positive")
    for proved in bins:
        for step in (*proved.steps, *proved.tail):
            assert system.floor is not None
            held = step.x[system.floor].is_at_least(floor)
            require(held, f"r falls below the floor after {show(step.start)} s")
    lines = [
        f"R(t) >= {show(floor)} s {_when(claim, bins)},",
        f"from every start with {words}{system.start_words()},",
    ]
    return _proof(data, claim, found, bins, setting, lines)


@kind("comparison")
def check_comparison(data: Node, certificate: Node) -> Proof:
    """Convergence, settling and torque of a law without filter, from every start of a set."""
    claim, witness = certificate["claim"], certificate["witness"]
    setting = read_setting(data, witness)
    found = find_system(data, witness, setting)
    words = check_initial_set(data, found.system, setting, witness)
    bins = _bins(found.system, setting, witness)
    require(any(claim.has(name) for name in ("ratio", "settling", "torque")), "nothing is claimed")
    lines = [f"{_when(claim, bins)}, from every start with {words}{found.system.start_words()},"]
    return _proof(data, claim, found, bins, setting, lines)


def _bins(system: Comparison, setting: Setting, witness: Node) -> list[FloorBin]:
    """Check every bin of the witness, and that together they cover its box."""
    places = witness["bins"].items()
    rectangles = [(p["s"].vector(2), p["y"].vector(2)) for p in places]
    require_cover(rectangles, witness["box"]["s"].number(), witness["box"]["y"].number())
    return [check_bin(system, setting, p, s, y) for p, (s, y) in zip(places, rectangles, strict=True)]


def _when(claim: Node, bins: list[FloorBin]) -> str:
    """Check that every bin covers the time of the claim, and say it."""
    if not claim.has("horizon"):
        require(all(b.tail for b in bins), "a bin has no repeating part: no claim for all time")
        return "for all t >= 0"
    horizon = claim["horizon"].number()
    require(horizon > 0, "the horizon must be positive")
    require(all(b.tail or b.steps[-1].stop >= horizon for b in bins), "a bin ends before the horizon")
    return f"on [0, {show(horizon)}] s"


def _proof(
    data: Node, claim: Node, found: Found, bins: list[FloorBin], setting: Setting, lines: list[str]
) -> Proof:
    """Add the law, the data, and what else is claimed."""
    system = found.system
    lines = [*lines, *system.words(), f"{describe_profile(setting.profile)},", describe_inertia(data)]
    lines += check_convergence(claim, bins, setting)
    if claim.has("settling") or claim.has("torque"):
        covered = [all_boxes(system, setting, proved) for proved in bins]
        lines += check_settling(claim, bins, covered, setting) + check_torque(claim, covered, system)
    return Proof(lines, found.part)


def check_convergence(claim: Node, bins: list[FloorBin], setting: Setting) -> list[str]:
    """Check that sqrt(1 - b0) and |Omega|_J shrink by the claimed ratio per period, if that is claimed."""
    if not claim.has("ratio"):
        return []
    ratio, start = claim["ratio"].number(), claim["ratio_from"].number()
    require(ratio < 1, "the ratio must be below 1")
    shrinks = all(b.tail and b.ratio <= ratio and b.tail[0].start <= start for b in bins)
    require(shrinks, "a bin does not shrink by the ratio")
    assert setting.profile.period is not None
    return [
        f"and the bounds of sqrt(1 - b0) and |Omega|_J shrink by a factor {show(ratio)} every "
        f"{show(setting.profile.period)} s from t = {show(start)} s on: attitude and rate converge"
    ]
