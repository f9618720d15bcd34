"""The persistence filter on an unknown body: its differential inequalities.

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

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from .bernstein import Form
from .comparison import NO_BOUND, ONE, TWO, Bounds, Conditions, rate_factor
from .exact_numbers import HALF, Vector, require, show
from .floor_bounds import root_above
from .floor_steps import FloorStep
from .persistence import LAW
from .robust_steps import LAST, Robust, RobustSystem, cell_end, read_cell

PAIRS = {
    "both": frozenset({"y", "s", "v", "z"}),
    "angle": frozenset({"y", "s"}),
    "cascade": frozenset({"v", "z"}),
}


@dataclass(frozen=True)
class RobustPersistence(RobustSystem):
    """lam, R0: lambda, 1/s, and R(0), s, as they stand in the law's equations and states."""

    sides: ClassVar[Mapping[str, int]] = {"K": -1, "L": 1, "y": 1, "s": 1, "v": 1, "z": 1, "W": 1, "r": -1}
    tail_sides: ClassVar[Mapping[str, int]] = sides

    lam: Fraction
    R0: Fraction

    def kappa(self) -> Fraction:
        """1/R(0)."""
        return 1 / self.R0

    def start(self, s: Vector, y: Fraction) -> Bounds:
        """K = L = 1/R(0), r = R(0), W = 1, and the set's own bounds."""
        one = Fraction(1)
        known = {"K": one / self.R0, "L": one / self.R0, "W": one, "r": self.R0}
        return known | {"y": y, "s": s[1], "v": y, "z": s[1]}

    def kept(self, step: FloorStep) -> frozenset[str]:
        """The pairs of bounds that the step's first word names."""
        require(len(step.modes) == 4 and step.modes[0] in PAIRS, "unknown form of the inequalities")
        return PAIRS[step.modes[0]]

    def conditions(
        self, d: Robust, G: Form, step: FloorStep, dx: dict[str, Form], *, tail: bool, scaled: bool
    ) -> Conditions:
        """Every bound's sign and slope."""
        del tail
        x, kept, k = step.x, self.kept(step), d.constants
        K, L, y, s, v, z, W = (x[name] for name in ("K", "L", "y", "s", "v", "z", "W"))
        for name in self.sides:
            yield f"{name} >= 0", x[name]
        yield "slope of K", K.times(self.lam) - (G * K * K).times(2) - dx["K"]
        yield "slope of W", W * (dx["W"] + W.times(self.lam / 2)) - G.times(1 / self.R0)
        require(min(W.plain()[0]) > 0, "W is not positive")
        cell, bound = self._cell(step)
        if bound is not None:
            yield "S within the step's bound", bound
        whirl, m = d.cell(cell)
        if "s" in kept:
            S = s * s
            free = ONE - S.times(HALF)
            yield "s^2 <= 2", TWO - S
            room = free.times(k.damping) - Form.constant(whirl)
            for kappa in (K, L):
                a = kappa * G
                yield "slope of y", dx["y"] + a * room * y - (a * a * s).times(m) - Form.constant(d.push)
            drift = y if scaled else y * rate_factor(S, [*step.modes[:2], step.modes[3]])
            yield "slope of s", dx["s"] - drift.times(d.c) + (K * G * free * s).times(1 - k.braking)
        else:
            yield "slope of y", dx["y"]
            yield "s above sqrt 2", s - Form.constant(NO_BOUND)
        if "z" in kept:
            a = L * G
            excess = max(Fraction(0), 1 - k.damping) + whirl
            forced = (a * v).times(excess) + (a * a * z).times(m) + W.times(d.push)
            yield "slope of v", dx["v"] + v.times(self.lam / 2) - forced
            bend = ONE if scaled else ONE - (K * z * z).times(self.R0 / 4)
            turned = (v * bend).times(d.c) + (a * z).times(k.braking)
            yield "slope of z", dx["z"] + z.times(self.lam / 2) - turned
        yield from self._filter(G, step, dx)

    def _filter(self, G: Form, step: FloorStep, dx: dict[str, Form]) -> Conditions:
        x, mode, kept = step.x, step.modes[1], self.kept(step)
        L, s, z, r = (x[name] for name in ("L", "s", "z", "r"))
        if mode == "none":
            yield "slope of r", -dx["r"] - r.times(self.lam)
            yield "slope of L", dx["L"] - L.times(self.lam)
        elif mode == "angle":
            require("s" in kept, "the angle is not bounded on this step")
            intake = G * (TWO - s * s)
            yield "slope of r", intake - r.times(self.lam) - dx["r"]
            yield "slope of L", dx["L"] - L.times(self.lam) + intake * L * L
        else:
            require(mode == "cascade" and "z" in kept, "unknown form of the inequalities")
            require(min(r.plain()[0]) > 0, "the floor is not positive")
            square = (z * z).times(self.R0)
            yield "slope of r", G * (r.times(2) - square) - r * (r.times(self.lam) + dx["r"])
            yield "slope of L", dx["L"] - L.times(self.lam) + G * (TWO - square * L) * L * L

    def _cell(self, step: FloorStep) -> tuple[int, Form | None]:
        """The cell of S that a step claims, and the polynomial >= 0 that says so."""
        *by, word = step.modes[2].split()
        cell = read_cell(word)
        if cell == LAST:
            return cell, None
        end, x = Form.constant(cell_end(cell)), step.x
        if by == ["angle"] and "s" in self.kept(step):
            return cell, end - x["s"] * x["s"]
        require(by == ["cascade"] and "z" in self.kept(step), "unknown bound of S")
        return cell, end - (x["z"] * x["z"] * x["L"]).times(self.R0)

    def box(self, low: Bounds, high: Bounds, step: FloorStep) -> tuple[Fraction, Fraction, Fraction]:
        """The better of both pairs, where both are kept."""
        kept = self.kept(step)
        gain = min(high["L"], 1 / low["r"]) if low["r"] > 0 else high["L"]
        Ss, ys = [], []
        if "s" in kept:
            Ss, ys = [high["s"] ** 2], [high["y"]]
        if "z" in kept:
            Ss.append(self.R0 * gain * high["z"] ** 2)
            ys.append(high["v"] * root_above(self.R0 * gain))
        return min(Ss), min(ys), gain

    def words(self) -> list[str]:
        """The filter and the law."""
        return [
            f"R(0) = {show(self.R0)} s,",
            f"law {LAW} with J0: kappa = 1/R, R' = -lambda R + g^2 (1 + b0), lambda = {show(self.lam)} 1/s,",
        ]
