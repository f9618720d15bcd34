"""Adaptive scaling on an unknown body: its differential inequalities.

Variables as in `robust_persistence`, kappa = k in [k, L]. The law learns from what it measures, with its J0:
k' = gamma R g^2 (2 - S)(e^2 + 2 a S), e = |w + zeta|_J0 <= m1 y + m2 2 sqrt 2 L g^2 s, m1 the ratio of the
metrics, m2 = |J0^1/2 Phi bv| for |bv| = 1. With q <= sqrt(S) <= s, Q = q^2, p >= bv'Phi bv/|bv|^2:

    y' : -kappa g^2 (B1 (1 - S/2) - 2 B3 N) y + kappa^2 g^4 m s + d, at kappa = k and at kappa = L (convex)
    s' : c A(S) y - k g^2 (1 - phi) s (1 - S/2)
    q' : -c A(Q) y - L g^2 (1 + p) q (1 - Q/2)                  from below
    k' : 2 a gamma r g^2 (2 - S') S', at S' = Q and S' = s^2     from below (concave in S')
    L' : gamma U g^2 f, f >= (2 - S')(e^2 + 2 a S') for Q <= S' <= s^2
    r' : -lambda r + g^2 (2 - s^2) from below;  U' : -lambda U + g^2 (2 - Q)

A part that repeats holds k, takes Q = 0 and A = 1, and keeps kappa below a stated limit: E, what the gain
grows over its first period, shrinks with the square of the ratio, so L + E/(1 - ratio^2) must not exceed it.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

from .adaptive import LAW
from .bernstein import Form
from .comparison import ONE, TWO, Bounds, Conditions, angle_factor, rate_factor
from .exact_numbers import HALF, Vector, require, show
from .floor_steps import FloorStep
from .reading import Node
from .robust_steps import LAST, Robust, RobustSystem, cell_end, read_cell

DOUBLE_ROOT = Fraction(28285, 10000)
"""At least 2 sqrt 2."""
KEPT = frozenset({"y", "s"})


@dataclass(frozen=True)
class RobustAdaptive(RobustSystem):
    """The law's numbers as they stand in its equations; `limit` of kappa in a part that repeats."""

    sides: ClassVar[Mapping[str, int]] = {"k": -1, "L": 1, "y": 1, "s": 1, "q": -1, "r": -1, "U": 1}
    tail_sides: ClassVar[Mapping[str, int]] = {"k": -1, "E": 1, "y": 1, "s": 1, "r": -1, "U": 1}

    lam: Fraction
    R0: Fraction
    gamma: Fraction
    a: Fraction
    k0: Fraction
    limit: Fraction | None = None

    def with_limit(self, place: Node) -> RobustAdaptive:
        """The system with the limit of kappa that a part that repeats states."""
        return replace(self, limit=place["gain_limit"].number())

    def kappa(self) -> Fraction:
        """k(0)."""
        return self.k0

    def start(self, s: Vector, y: Fraction) -> Bounds:
        """K = L = k(0), r = U = R(0), and the bin's bounds."""
        return {"k": self.k0, "L": self.k0, "y": y, "s": s[1], "q": s[0], "r": self.R0, "U": self.R0}

    def kept(self, step: FloorStep) -> frozenset[str]:
        """Angle and rate are always bounded."""
        del step
        return KEPT

    def conditions(
        self, d: Robust, G: Form, step: FloorStep, dx: dict[str, Form], *, tail: bool, scaled: bool
    ) -> Conditions:
        """Every bound's sign and slope."""
        require(not tail or scaled, "a gain that keeps growing has no part that repeats")
        x, k = step.x, d.constants
        low, y, s, r, U = (x[name] for name in ("k", "y", "s", "r", "U"))
        require(len(step.modes) == (3 if tail else 4), "unknown form of the inequalities")
        S, cell = s * s, read_cell(step.modes[2])
        for name in x:
            yield f"{name} >= 0", x[name]
        yield "s^2 <= 2", TWO - S
        if cell != LAST:
            yield "S within the step's bound", Form.constant(cell_end(cell)) - S
        whirl, m = d.cell(cell)
        high = Form.constant(self._limit()) if tail else x["L"]
        free = ONE - S.times(HALF)
        room = free.times(k.damping) - Form.constant(whirl)
        for kappa in (low, high):
            g = kappa * G
            yield "slope of y", dx["y"] + g * room * y - (g * g * s).times(m) - Form.constant(d.push)
        drift = y if tail else y * rate_factor(S, [*step.modes[:2], step.modes[3]])
        yield "slope of s", dx["s"] - drift.times(d.c) + (low * G * free * s).times(1 - k.braking)
        yield "slope of r", G * (TWO - S) - r.times(self.lam) - dx["r"]
        e = y.times(k.metric_ratio) + (high * G * s).times(k.measured_mismatch * DOUBLE_ROOT)
        square = e * e
        if tail:
            yield "the limit of the gain", high - low
            yield "slope of k", -dx["k"]
            yield "slope of U", dx["U"] + U.times(self.lam) - G.times(2)
            grown = (G * U * (square + S.times(2 * self.a))).times(2 * self.gamma)
            yield "slope of E", dx["E"] - grown
            return
        yield from self._learning(d, G, step, dx, square)

    def _learning(self, d: Robust, G: Form, step: FloorStep, dx: dict[str, Form], square: Form) -> Conditions:
        x, a = step.x, self.a
        L, y, s, q, r, U = (x[name] for name in ("L", "y", "s", "q", "r", "U"))
        S, Q = s * s, q * q
        if step.modes[0] == "kept":
            pulled = (L * G * (ONE - Q.times(HALF)) * q).times(1 + d.constants.accelerating)
            yield "slope of q", -dx["q"] - (y * angle_factor(Q)).times(d.c) - pulled
        else:
            require(step.modes[0] == "zero", "unknown form of the inequalities")
            yield "q = 0", -q
        yield "slope of U", dx["U"] + U.times(self.lam) - G * (TWO - Q)
        for T in (Q, S):
            yield "slope of k", (G * r * (TWO - T) * T).times(2 * a * self.gamma) - dx["k"]
        if step.modes[1] == "top":
            crest = ONE + square.times(1 / (4 * a))
            f = (crest * crest).times(2 * a)
        else:
            require(step.modes[1] == "split", "unknown form of the inequalities")
            f = (TWO - Q) * (square + S.times(2 * a))
        yield "slope of L", dx["L"] - (G * U * f).times(self.gamma)

    def _limit(self) -> Fraction:
        require(self.limit is not None, "the part that repeats states no limit of the gain")
        assert self.limit is not None
        return self.limit

    def repeats(self, steps: Sequence[FloorStep], before: Bounds, ratio: Fraction | None) -> Bounds:
        """The gain stays below its limit: E shrinks with the square of the ratio from period to period."""
        require(ratio is not None, "a gain that keeps growing has no part that repeats")
        assert ratio is not None
        grown = steps[-1].ends["E"][1] / (1 - ratio**2)
        require(before["L"] + grown <= self._limit(), "the gain may exceed its limit")
        return {**before, "E": Fraction(0)}

    def box(self, low: Bounds, high: Bounds, step: FloorStep) -> tuple[Fraction, Fraction, Fraction]:
        """S, y and kappa's upper bound, or its limit where the step repeats."""
        del low, step
        return high["s"] ** 2, high["y"], high["L"] if "L" in high else self._limit()

    def words(self) -> list[str]:
        """The law and what it learns by."""
        return [
            f"R(0) = {show(self.R0)} s, k(0) = {show(self.k0)} 1/s,",
            f"law {LAW} with J0: kappa = k, R' = -lambda R + g^2 (1 + b0), lambda = {show(self.lam)} 1/s,",
            f"k' = gamma R g^2 [(1 + b0) Omega'J0 Omega + 2 a |bv|^2], gamma = {show(self.gamma)}, "
            f"a = {show(self.a)},",
        ]
