"""Steps of a floor's witness: the differential inequalities of each."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction

from .bernstein import Form
from .exact_numbers import HALF, MAX_COUNT, MAX_EXPONENT, require, show
from .reading import Node
from .schedules import Profile


@dataclass(frozen=True)
class FloorData:
    """What the steps of a witness are checked against."""

    law: str
    lam: Fraction
    R0: Fraction
    gamma: Fraction
    k0: Fraction
    a: Fraction
    c: Fraction
    greatest: Fraction
    profile: Profile


@dataclass(frozen=True)
class FloorStep:
    """One step: its interval, the forms used, and the polynomial of each component."""

    start: Fraction
    stop: Fraction
    modes: list[str]
    x: dict[str, Form]
    ends: dict[str, tuple[Fraction, Fraction]]


Bounds = dict[str, Fraction]


def components(law: str, *, tail: bool) -> dict[str, int]:
    """Components with their side: -1 a lower bound, +1 an upper one."""
    if law == "persistence-filter":
        return {"K": -1, "y": 1, "s": 1, "v": 1, "z": 1, "r": -1}
    if tail:
        return {"k": -1, "r": -1, "Y": 1, "Z": 1, "L": 1, "U": 1}
    return {"y": -1, "s": -1, "k": -1, "r": -1, "Y": 1, "Z": 1, "L": 1, "U": 1}


def read_steps(place: Node, start: Fraction, sides: dict[str, int]) -> list[FloorStep]:
    """Read steps that follow each other from `start`, every bound jumping to its loose side only."""
    steps: list[FloorStep] = []
    for node in place.items():
        stop = node["until"].number()
        require(stop > start, f"{node.path}: a step must end after it begins")
        x, ends = {}, {}
        for name in sides:
            numbers = node["bounds"][name].vector()
            require(all(v.denominator == 1 for v in numbers), f"{node.path}: expected integers for {name}")
            exponent, *mantissas = (int(v) for v in numbers)
            require(
                abs(exponent) <= MAX_EXPONENT and 0 < len(mantissas) <= MAX_COUNT,
                f"{node.path}: the polynomial of {name} is out of range",
            )
            unit = Fraction(2) ** exponent
            x[name] = Form.of([m * unit for m in mantissas])
            ends[name] = (mantissas[0] * unit, mantissas[-1] * unit)
        modes = [mode.text() for mode in node["forms"].items()]
        steps.append(FloorStep(start, stop, modes, x, ends))
        if len(steps) > 1:
            require_loose(sides, {n: e[1] for n, e in steps[-2].ends.items()}, steps[-1], node.path)
        start = stop
    require(bool(steps), f"{place.path}: there are no steps")
    return steps


def require_loose(sides: dict[str, int], before: Bounds, step: FloorStep, path: str) -> None:
    """Check that a step begins no tighter than what is known."""
    for name, side in sides.items():
        if name in before:
            gap = side * (step.ends[name][0] - before[name])
            require(gap >= 0, f"{path}: the bound {name} begins tighter than is known")


def check_step(d: FloorData, step: FloorStep, *, tail: bool) -> None:
    """Check every differential inequality on a step."""
    g = d.profile.gain(step.start, step.stop)
    G = g * g
    per_second = 1 / (step.stop - step.start)
    dx = {name: p.derivative().times(per_second) for name, p in step.x.items()}
    if d.law == "persistence-filter":
        conditions = persistence_conditions(d, G, step.x, dx, step.modes, tail=tail)
    elif tail:
        conditions = adaptive_tail_conditions(d, G, step.x, dx)
    else:
        conditions = adaptive_conditions(d, G, step.x, dx, step.modes)
    for name, condition in conditions:
        where = f"on [{show(step.start)}, {show(step.stop)}] s"
        require(condition.is_nonnegative(), f"{name} is not proved {where}")


Conditions = Iterator[tuple[str, Form]]
ONE, TWO = Form.constant(1), Form.constant(2)
NO_BOUND = Fraction(3, 2)


def angle_factor(S: Form) -> Form:
    """A(S) = 1 - S/4 - S^2/32."""
    return ONE - S.times(Fraction(1, 4)) - (S * S).times(Fraction(1, 32))


def persistence_conditions(
    d: FloorData, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: list[str], *, tail: bool
) -> Conditions:
    """K <= 1/R; y, s; v, z with S <= R0 z^2/R; and the floor r.

    In v = y sqrt(R/R0), z = s sqrt(R/R0): v' = -(lambda/2) v, z' <= -(lambda/2) z + c v (1 - S/4).
    """
    K, y, s, v, z, r = (x[name] for name in ("K", "y", "s", "v", "z", "r"))
    require(len(modes) == 2 and modes[0] in ("angle", "blind"), "unknown form of the inequalities")
    yield "K >= 0", K
    yield "slope of K", K.times(d.lam) - (G * K * K).times(2) - dx["K"]
    if modes[0] == "angle":
        S = s * s
        pull = (G * K * (TWO - S)).times(HALF)
        yield "s^2 <= 2", TWO - S
        yield "s >= 0", s
        yield "slope of y", dx["y"] + pull * y
        drift = y if tail else y * angle_factor(S)
        yield "slope of s", dx["s"] - drift.times(d.c) + pull * s
    else:
        yield "slope of y", dx["y"]
        yield "s above sqrt 2", s - Form.constant(NO_BOUND)
    yield "v >= 0", v
    yield "y >= 0", y
    yield "slope of v", dx["v"] + v.times(d.lam / 2)
    bend = ONE if tail else ONE - (K * z * z).times(d.R0 / 4)
    yield "slope of z", dx["z"] + z.times(d.lam / 2) - (v * bend).times(d.c)
    yield "z >= 0", z
    yield "r >= 0", r
    if modes[1] == "none":
        yield "slope of r", -dx["r"] - r.times(d.lam)
    elif modes[1] == "angle":
        require(modes[0] == "angle", "the angle is not bounded on this step")
        yield "slope of r", G * (TWO - s * s) - r.times(d.lam) - dx["r"]
    else:
        require(modes[1] == "cascade", "unknown form of the inequalities")
        require(min(x["r"].plain()[0]) > 0, "the floor is not positive")
        yield "slope of r", G * (r.times(2) - (z * z).times(d.R0)) - r * (r.times(d.lam) + dx["r"])


def adaptive_conditions(
    d: FloorData, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: list[str]
) -> Conditions:
    """Lower bounds y, s, k, r and upper bounds Y, Z, L, U of |Omega|_J, sqrt(S), k, R."""
    y, s, k, r = (x[name] for name in ("y", "s", "k", "r"))
    Y, Z, L, U = (x[name] for name in ("Y", "Z", "L", "U"))
    require(len(modes) == 2 and modes[0] in ("kept", "zero"), "unknown form of the inequalities")
    S, T = s * s, Z * Z
    low_room, high_room = TWO - S, TWO - T
    yield "s^2 <= 2", high_room
    yield from ((f"{name} >= 0", x[name]) for name in x)
    low_pull, high_pull = (G * L * low_room).times(HALF), (G * k * high_room).times(HALF)
    yield "slope of y", -dx["y"] - low_pull * y
    yield "slope of Y", dx["Y"] + high_pull * Y
    if modes[0] == "kept":
        yield "slope of s", -dx["s"] - (Y * angle_factor(S)).times(d.c) - low_pull * s
    else:
        yield "s = 0", -s
    yield "slope of Z", dx["Z"] - (Y * angle_factor(T)).times(d.c) + high_pull * Z
    yield "slope of r", G * high_room - r.times(d.lam) - dx["r"]
    yield "slope of U", dx["U"] + U.times(d.lam) - G * low_room
    for room, square in ((low_room, S), (high_room, T)):
        yield "slope of k", (G * r * room * (y * y + square.times(2 * d.a))).times(d.gamma) - dx["k"]
    a, square = d.a, Y * Y
    if modes[1] == "top":
        crest = ONE + square.times(1 / (4 * a))
        f = (crest * crest).times(2 * a)
    elif modes[1] == "rising":
        f = high_room * (square + T.times(2 * a))
        yield "f rises up to s", Form.constant(4 * a) - square - T.times(4 * a)
    elif modes[1] == "falling":
        f = low_room * (square + S.times(2 * a))
        yield "f falls from s on", square + S.times(4 * a) - Form.constant(4 * a)
    else:
        require(modes[1] == "split", "unknown form of the inequalities")
        f = low_room * (square + T.times(2 * a))
    yield "slope of L", dx["L"] - (G * U * f).times(d.gamma)


def adaptive_tail_conditions(d: FloorData, G: Form, x: dict[str, Form], dx: dict[str, Form]) -> Conditions:
    """Repeating part: k held, (Y, Z) may be scaled down together, L grows by what (Y, Z) feed it."""
    k, r, Y, Z, U = (x[name] for name in ("k", "r", "Y", "Z", "U"))
    T = Z * Z
    room = TWO - T
    pull = (G * k * room).times(HALF)
    yield "s^2 <= 2", room
    yield from ((f"{name} >= 0", x[name]) for name in x)
    yield "slope of k", -dx["k"]
    yield "slope of r", G * room - r.times(d.lam) - dx["r"]
    yield "slope of Y", dx["Y"] + pull * Y
    yield "slope of Z", dx["Z"] - Y.times(d.c) + pull * Z
    yield "slope of U", dx["U"] + U.times(d.lam) - G.times(2)
    yield "slope of L", dx["L"] - (G * U * (Y * Y + T.times(2 * d.a))).times(2 * d.gamma)


def is_blind(step: FloorStep) -> bool:
    """Whether a step gives up the bounds y and s: v and z alone bound rate and angle."""
    return step.modes[:1] == ["blind"]
