"""Kind filter-floor: R above a floor, convergence, settling and torque over an initial set."""

from __future__ import annotations

from fractions import Fraction
from itertools import pairwise

from .body import describe_inertia, inertia_vertices
from .exact_numbers import Vector, require, show
from .floor_boxes import FloorBin, all_boxes, check_settling, check_torque
from .floor_steps import (
    NO_BOUND,
    Bounds,
    FloorData,
    FloorStep,
    check_step,
    components,
    is_blind,
    read_steps,
    require_loose,
)
from .kinds import kind
from .known_laws import LOOPS, Compared, compared_law
from .matrices import is_positive_semidefinite
from .reading import Node
from .schedules import describe_profile, read_profile, require_continuous


def read_floor_data(data: Node, witness: Node) -> FloorData:
    """Read the loop's data; check c >= 1/sqrt(8 Jmin) and greatest >= Jmax for every inertia."""
    law = read_compared(data)
    names = {"R": "R0", "k": "k0"} if law.gain == "adaptive-scaling" else {"R": "R0"}
    if data.has("initial"):
        require(set(data["initial"].keys()) == set(names), "expected the initial value of every state")
        start = {name: data["initial"][name].number() for name in names}
    else:  # files of earlier versions give them among the parameters
        start = {name: data["parameters"][old].number() for name, old in names.items()}
    require(start["R"] > 0 and start.get("k", Fraction(0)) >= 0, "expected R(0) > 0 and k(0) >= 0")
    c, greatest = witness["coupling"].number(), witness["greatest_inertia"].number()
    require(c > 0, "the coupling must be positive")
    for J in inertia_vertices(data):  # convex in J: the vertices suffice
        gap = [[8 * c * c * J[i][j] - (1 if i == j else 0) for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "the coupling is below 1/sqrt(8 Jmin)")
        gap = [[(greatest if i == j else 0) - J[i][j] for j in range(3)] for i in range(3)]
        require(is_positive_semidefinite(gap), "the greatest inertia is too small")
    profile = read_profile(data)
    require_continuous(profile)
    k0 = start.get("k", Fraction(0))
    return FloorData(law.gain, law.lam, start["R"], law.gamma, k0, law.a, c, greatest, profile)


def read_compared(data: Node) -> Compared:
    """Return the law of the data: its program, or in files of earlier versions the equations by a name.

    Such a file holds no program: its claim is about the equations that are printed with it.
    """
    if data["law"].has("program"):
        return compared_law(data)
    law = data["law"]["name"].text()
    require(law in LOOPS, f"no comparison system is known for the law {law!r}")
    names = ("lambda", "gamma", "a") if law == "adaptive-scaling" else ("lambda",)
    values = {name: data["parameters"][name].number() for name in names}
    require(all(v > 0 for v in values.values()), "parameters must be positive")
    zero = Fraction(0)
    return Compared(law, values["lambda"], values.get("gamma", zero), values.get("a", zero))


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


def check_initial_set(data: Node, d: FloorData, witness: Node) -> str:
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
        g = d.profile.shapes[0][0] if d.profile.shapes[0] else Fraction(0)
        kappa = 1 / d.R0 if d.law == "persistence-filter" else d.k0
        reach = abs(rate) + 2 * g * g * kappa * min(Fraction(1), s * NO_BOUND)  # |bv| <= s sqrt 2
        enough = enough or y * y >= d.greatest * reach * reach
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


def check_bin(d: FloorData, place: Node, s: Vector, y: Vector) -> FloorBin:
    """Check one bin: its start, its steps, and its repeating part if it has one."""
    sides = components(d.law, tail=False)
    steps = read_steps(place["steps"], Fraction(0), sides)
    if d.law == "persistence-filter":
        known = {"K": 1 / d.R0, "r": d.R0, "y": y[1], "v": y[1], "s": s[1], "z": s[1]}
    else:
        known = {"k": d.k0, "L": d.k0, "r": d.R0, "U": d.R0, "y": y[0], "Y": y[1], "s": s[0], "Z": s[1]}
    require_loose(sides, known, steps[0], place.path)
    for step in steps:
        check_step(d, step, tail=False)
    ends = {name: pair[1] for name, pair in steps[-1].ends.items()}
    if not place.has("tail"):
        return FloorBin(steps, [], Fraction(1), ends)
    tail, ratio = check_tail(d, place["tail"], steps[-1].stop, ends)
    return FloorBin(steps, tail, ratio, ends)


def check_tail(d: FloorData, place: Node, start: Fraction, known: Bounds) -> tuple[list[FloorStep], Fraction]:
    """Check a part that repeats for ever: lower bounds end no lower, upper bounds no higher than they began.

    Those of angle and rate end at most `ratio` times where they began.
    """
    period, ratio = d.profile.period, place["ratio"].number()
    require(period is not None, "a finite schedule has no repeating part")
    assert period is not None
    require(start % period == 0, "the repeating part must begin at a whole period")
    require(0 <= ratio < 1, "the ratio must lie in [0, 1)")
    sides = components(d.law, tail=True)
    steps = read_steps(place["steps"], start, sides)
    require(steps[-1].stop == start + period, "the repeating part must cover one period")
    require_loose(sides, known, steps[0], place.path)
    for step in steps:
        check_step(d, step, tail=True)
    blind = is_blind(steps[0])
    require(all(is_blind(step) == blind for step in steps), "the angle is bounded on a part of a period only")
    decaying = {"y", "s", "v", "z", "Y", "Z"} - ({"y", "s"} if blind else set())
    for name, side in sides.items():
        first, last = steps[0].ends[name][0], steps[-1].ends[name][1]
        if name in decaying:
            require(last <= ratio * first, f"{place.path}: {name} does not shrink by the ratio")
        elif name not in ("L", "y", "s"):
            require(side * (first - last) >= 0, f"{place.path}: {name} does not come back to where it began")
    return steps, ratio


@kind("filter-floor")
def check_filter_floor(data: Node, certificate: Node) -> list[str]:
    """R >= floor from every start of a set, for all time or up to a horizon; and convergence."""
    claim, witness = certificate["claim"], certificate["witness"]
    d = read_floor_data(data, witness)
    words = check_initial_set(data, d, witness)
    places = witness["bins"].items()
    rectangles = [(p["s"].vector(2), p["y"].vector(2)) for p in places]
    require_cover(rectangles, witness["box"]["s"].number(), witness["box"]["y"].number())
    bins = [check_bin(d, p, s, y) for p, (s, y) in zip(places, rectangles, strict=True)]
    floor = claim["floor"].number()
    require(floor > 0, "the floor must be positive")
    for proved in bins:
        for step in (*proved.steps, *proved.tail):
            require(step.x["r"].is_at_least(floor), f"r falls below the floor after {show(step.start)} s")
    if claim.has("horizon"):
        horizon = claim["horizon"].number()
        require(horizon > 0, "the horizon must be positive")
        reached = all(b.tail or b.steps[-1].stop >= horizon for b in bins)
        require(reached, "a bin ends before the horizon")
        when = f"on [0, {show(horizon)}] s"
    else:
        require(all(b.tail for b in bins), "a bin has no repeating part: no claim for all time")
        when = "for all t >= 0"
    adaptive = d.law == "adaptive-scaling"
    start = f", k(0) = {show(d.k0)} 1/s" if adaptive else ""
    gains = f", gamma = {show(d.gamma)}, a = {show(d.a)}" if adaptive else ""
    lines = [
        f"R(t) >= {show(floor)} s {when},",
        f"from every start with {words}, R(0) = {show(d.R0)} s{start},",
        f"R' = -lambda R + g^2 (1 + b0), lambda = {show(d.lam)} 1/s,",
        f"law {d.law}: Omega = w + 2 g^2 kappa bv, {LOOPS[d.law]}{gains},",
        "whose torque gives J Omega' = -Omega x J w - (g^2/2) kappa (1 + b0) J Omega,",
        f"{describe_profile(d.profile)},",
        describe_inertia(data),
    ]
    lines += check_convergence(claim, bins, d)
    if claim.has("settling") or claim.has("torque"):
        covered = [all_boxes(d, proved) for proved in bins]
        lines += check_settling(claim, bins, covered, d) + check_torque(claim, covered, d)
    return lines


def check_convergence(claim: Node, bins: list[FloorBin], d: FloorData) -> list[str]:
    """Check that sqrt(1 - b0) and |Omega|_J shrink by the claimed ratio per period, if that is claimed."""
    if not claim.has("ratio"):
        return []
    ratio, start = claim["ratio"].number(), claim["ratio_from"].number()
    require(ratio < 1, "the ratio must be below 1")
    shrinks = all(b.tail and b.ratio <= ratio and b.tail[0].start <= start for b in bins)
    require(shrinks, "a bin does not shrink by the ratio")
    assert d.profile.period is not None
    return [
        f"and the bounds of sqrt(1 - b0) and |Omega|_J shrink by a factor {show(ratio)} every "
        f"{show(d.profile.period)} s from t = {show(start)} s on: attitude and rate converge"
    ]
