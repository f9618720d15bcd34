"""Steps of a robust floor's witness: the differential inequalities of each.

Variables: S = 1 - b0, s = sqrt(S), x = w + J^-1 M J0 zeta, y = |x|_J, zeta = 2 g^2 kappa bv, kappa = 1/R in
[K, L]; z = s sqrt(R/R0), v = y sqrt(R/R0), W >= sqrt(R/R0). R' = -lambda R + g^2 (2 - S) on every body. With
B1 (damping), B3 (gyroscopic), phi (braking) and m (forcing) of `robust_constants`, N >= |bv| and the
disturbance's d = D/sqrt(Jmin), upper bounds whose slopes are at least

    y' : -kappa g^2 (B1 (1 - S/2) - 2 B3 N) y + kappa^2 g^4 m s + d, at kappa = K and at kappa = L (convex)
    s' : c A(S) y - K g^2 (1 - phi) s (1 - S/2),                 c = 1/sqrt(8 Jmin)
    L' : lambda L - g^2 L^2 (2 - S)
    v' : -(lambda/2) v + L g^2 (max(0, 1 - B1) + 2 B3 N) v + L^2 g^4 m z + W d
    z' : -(lambda/2) z + c v (1 - R0 K z^2/4) + L g^2 phi z,     S <= R0 L z^2
    W' : -(lambda/2) W + g^2/(R0 W)

where they are touched are never crossed. N and m are taken at a bound of S that holds on the whole step.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction

from .bernstein import Form
from .comparison import NO_BOUND, ONE, TWO, Conditions, rate_factor
from .exact_numbers import HALF, Vector, require, show
from .floor_bounds import root_above
from .floor_steps import FloorStep
from .robust_constants import CELLS, RobustConstants
from .schedules import Profile

SIDES = {"K": -1, "L": 1, "y": 1, "s": 1, "v": 1, "z": 1, "W": 1, "r": -1}
PAIRS = {"both": {"y", "s", "v", "z"}, "angle": {"y", "s"}, "cascade": {"v", "z"}}
NO_CASCADE = 10**6
LAST = CELLS - 1


@dataclass(frozen=True)
class Robust:
    """What every step is checked against."""

    lam: Fraction
    R0: Fraction
    profile: Profile
    constants: RobustConstants
    forcings: Vector
    c: Fraction
    push: Fraction


def check_step(d: Robust, step: FloorStep, *, scaled: bool) -> None:
    """Check every differential inequality on a step; `scaled`: without terms that a scaling would break."""
    g = d.profile.gain(step.start, step.stop)
    per_second = 1 / (step.stop - step.start)
    dx = {name: p.derivative().times(per_second) for name, p in step.x.items()}
    for name, condition in _conditions(d, g * g, step, dx, scaled=scaled):
        where = f"on [{show(step.start)}, {show(step.stop)}] s"
        require(condition.is_nonnegative(), f"{name} is not proved {where}")


def _conditions(d: Robust, G: Form, step: FloorStep, dx: dict[str, Form], *, scaled: bool) -> Conditions:
    x, pairs = step.x, pairs_of(step)
    K, L, y, s, v, z, W = (x[name] for name in ("K", "L", "y", "s", "v", "z", "W"))
    for name in SIDES:
        yield f"{name} >= 0", x[name]
    yield "slope of K", K.times(d.lam) - (G * K * K).times(2) - dx["K"]
    yield "slope of W", W * (dx["W"] + W.times(d.lam / 2)) - G.times(1 / d.R0)
    require(min(W.plain()[0]) > 0, "W is not positive")
    cell, bound = _cell(d, step)
    if bound is not None:
        yield "S within the step's bound", bound
    high = Fraction(2 * cell + 2, CELLS)
    n = root_above(high * (2 - high)) if high < 1 else Fraction(1)
    k, m = d.constants, d.forcings[cell]
    whirl = 2 * k.gyroscopic * n
    if "s" in pairs:
        S = s * s
        free = ONE - S.times(HALF)
        yield "s^2 <= 2", TWO - S
        room = free.times(k.damping) - Form.constant(whirl)
        for kappa in (K, L):
            a = kappa * G
            yield "slope of y", dx["y"] + a * room * y - (a * a * s).times(m) - Form.constant(d.push)
        drift = y if scaled else y * rate_factor(S, [*step.modes[:2], step.modes[3]])
        require(k.braking <= 1, "the braking may be lost")
        yield "slope of s", dx["s"] - drift.times(d.c) + (K * G * free * s).times(1 - k.braking)
    else:
        yield "slope of y", dx["y"]
        yield "s above sqrt 2", s - Form.constant(NO_BOUND)
    if "z" in pairs:
        a = L * G
        excess = max(Fraction(0), 1 - k.damping) + whirl
        forced = (a * v).times(excess) + (a * a * z).times(m) + W.times(d.push)
        yield "slope of v", dx["v"] + v.times(d.lam / 2) - forced
        bend = ONE if scaled else ONE - (K * z * z).times(d.R0 / 4)
        yield "slope of z", dx["z"] + z.times(d.lam / 2) - (v * bend).times(d.c) - (a * z).times(k.braking)
    yield from _filter(d, G, step, dx)


def _filter(d: Robust, G: Form, step: FloorStep, dx: dict[str, Form]) -> Conditions:
    x, mode, pairs = step.x, step.modes[1], pairs_of(step)
    L, s, z, r = (x[name] for name in ("L", "s", "z", "r"))
    if mode == "none":
        yield "slope of r", -dx["r"] - r.times(d.lam)
        yield "slope of L", dx["L"] - L.times(d.lam)
    elif mode == "angle":
        require("s" in pairs, "the angle is not bounded on this step")
        intake = G * (TWO - s * s)
        yield "slope of r", intake - r.times(d.lam) - dx["r"]
        yield "slope of L", dx["L"] - L.times(d.lam) + intake * L * L
    else:
        require(mode == "cascade" and "z" in pairs, "unknown form of the inequalities")
        require(min(r.plain()[0]) > 0, "the floor is not positive")
        yield "slope of r", G * (r.times(2) - (z * z).times(d.R0)) - r * (r.times(d.lam) + dx["r"])
        yield "slope of L", dx["L"] - L.times(d.lam) + G * (TWO - (z * z * L).times(d.R0)) * L * L


def pairs_of(step: FloorStep) -> set[str]:
    """Which bounds of angle and rate a step keeps."""
    require(len(step.modes) == 4 and step.modes[0] in PAIRS, "unknown form of the inequalities")
    return PAIRS[step.modes[0]]


def _cell(d: Robust, step: FloorStep) -> tuple[int, Form | None]:
    """The cell of S that a step claims, and the polynomial >= 0 that says so."""
    *by, number = step.modes[2].split()
    require(number.isdecimal() and int(number) <= LAST, "unknown bound of S")
    cell = int(number)
    if cell == LAST:
        return cell, None
    end, x = Form.constant(Fraction(2 * cell + 2, CELLS)), step.x
    if by == ["angle"] and "s" in pairs_of(step):
        return cell, end - x["s"] * x["s"]
    require(by == ["cascade"] and "z" in pairs_of(step), "unknown bound of S")
    return cell, end - (x["z"] * x["z"] * x["L"]).times(d.R0)
