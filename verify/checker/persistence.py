"""The persistence-filter law, kappa = 1/R: its comparison system.

Components: K <= 1/R; y, s; v = |Omega|_J sqrt(R/R0), z = sqrt(1 - b0) sqrt(R/R0), in which the gain cancels,
v' = -(lambda/2) v, z' <= -(lambda/2) z + c v (1 - S/4) and S <= R0 z^2/R; and the floor r <= R.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from .bernstein import Form
from .comparison import (
    NO_BOUND,
    ONE,
    TWO,
    Bounds,
    Comparison,
    Conditions,
    Setting,
    comparison,
    initial_values,
    rate_factor,
)
from .exact_numbers import HALF, Vector, require, show
from .floor_bounds import Box, root_above, sliding_command
from .known_laws import FAMILY, read_scaled
from .reading import Node

LAW = "persistence-filter"


@comparison
@dataclass(frozen=True)
class PersistenceFilter(Comparison):
    """lam, R0: lambda, 1/s, and R(0), s, as they stand in the law's equations and states."""

    name: ClassVar[str] = LAW
    states: ClassVar[tuple[str, ...]] = ("R",)
    sides: ClassVar[Mapping[str, int]] = {"K": -1, "y": 1, "s": 1, "v": 1, "z": 1, "r": -1}
    floor: ClassVar[str | None] = "r"
    decaying: ClassVar[frozenset[str]] = frozenset({"y", "s", "v", "z"})

    setting: Setting
    lam: Fraction
    R0: Fraction

    @classmethod
    def read(cls, data: Node, setting: Setting) -> PersistenceFilter:
        """Read lambda off the program, whose equations are proved to be the law's, and R(0) off the start."""
        return cls._with(read_scaled(data).lam, data, setting)

    @classmethod
    def by_name(cls, data: Node, setting: Setting) -> PersistenceFilter:
        """Read lambda off the parameters of a file of earlier versions."""
        lam = data["parameters"]["lambda"].number()
        require(lam > 0, "parameters must be positive")
        return cls._with(lam, data, setting)

    @classmethod
    def _with(cls, lam: Fraction, data: Node, setting: Setting) -> PersistenceFilter:
        start = initial_values(data, {"R": "R0"})
        require(start["R"] > 0, "expected R(0) > 0 and k(0) >= 0")
        return cls(setting, lam, start["R"])

    def start(self, s: Vector, y: Vector) -> Bounds:
        """K = 1/R(0), r = R(0), and the set's own bounds."""
        return {"K": 1 / self.R0, "r": self.R0, "y": y[1], "v": y[1], "s": s[1], "z": s[1]}

    def kappa(self) -> Fraction:
        """1/R(0)."""
        return 1 / self.R0

    def conditions(
        self, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: Sequence[str], *, tail: bool
    ) -> Conditions:
        """Every bound's sign and slope; the floor in the form that the step names."""
        K, y, s, v, z, r = (x[name] for name in ("K", "y", "s", "v", "z", "r"))
        c, lam, R0 = self.setting.c, self.lam, self.R0
        require(len(modes) in (2, 3) and modes[0] in ("angle", "blind"), "unknown form of the inequalities")
        yield "K >= 0", K
        yield "slope of K", K.times(lam) - (G * K * K).times(2) - dx["K"]
        if modes[0] == "angle":
            S = s * s
            pull = (G * K * (TWO - S)).times(HALF)
            yield "s^2 <= 2", TWO - S
            yield "s >= 0", s
            yield "slope of y", dx["y"] + pull * y
            drift = y if tail else y * rate_factor(S, modes)
            yield "slope of s", dx["s"] - drift.times(c) + pull * s
        else:
            yield "slope of y", dx["y"]
            yield "s above sqrt 2", s - Form.constant(NO_BOUND)
        yield "v >= 0", v
        yield "y >= 0", y
        yield "slope of v", dx["v"] + v.times(lam / 2)
        bend = ONE if tail else ONE - (K * z * z).times(R0 / 4)
        yield "slope of z", dx["z"] + z.times(lam / 2) - (v * bend).times(c)
        yield "z >= 0", z
        yield "r >= 0", r
        if modes[1] == "none":
            yield "slope of r", -dx["r"] - r.times(lam)
        elif modes[1] == "angle":
            require(modes[0] == "angle", "the angle is not bounded on this step")
            yield "slope of r", G * (TWO - s * s) - r.times(lam) - dx["r"]
        else:
            require(modes[1] == "cascade", "unknown form of the inequalities")
            require(min(r.plain()[0]) > 0, "the floor is not positive")
            yield "slope of r", G * (r.times(2) - (z * z).times(R0)) - r * (r.times(lam) + dx["r"])

    def given_up(self, modes: Sequence[str]) -> frozenset[str]:
        """Y and s where a step bounds angle and rate by z and v alone."""
        return frozenset({"y", "s"}) if modes[:1] == ["blind"] else frozenset()

    def box(
        self, low: Bounds, high: Bounds, modes: Sequence[str], *, repeats: bool, limits: Bounds
    ) -> Mapping[str, Fraction]:
        """Take the better of both bounds of angle and rate, where both may be used."""
        del limits
        require(low["r"] > 0 and low["K"] > 0, "the floor is not positive")
        share = self.R0 / low["r"]
        S, y = high["z"] ** 2 * share, high["v"] * root_above(share)
        if not self.given_up(modes):
            S, y = min(S, high["s"] ** 2), min(y, high["y"])
        elif not repeats:
            S, y = min(S, Fraction(2)), min(y, high["y"])
        return {"S": S, "y": y, "low": low["K"], "high": 1 / low["r"]}

    def command(self, box: Box) -> Fraction:
        """With kappa' = lambda kappa - g^2 kappa^2 (1 + b0).

        q = -(4 g' + 2 g lambda) kappa + 2 g^3 kappa^2 (1 + 2 b0), whose terms cancel: from above it is convex
        in kappa; from below too where b0 > -1/2, and its vertex may lie inside.
        """
        g, high, share = box.g, box.high, 1 + 2 * (1 - min(box.S, Fraction(2)))
        bend = 2 * share * (box.g_low if share >= 0 else g) ** 3
        fall, rise = 4 * box.slope[1] + 2 * g * self.lam, 4 * box.slope[0] + 2 * box.g_low * self.lam
        ends = [box.low, high]
        inside = [min(max(fall / (2 * bend), box.low), high)] if bend > 0 else []
        q = (
            min(k * (bend * k - fall) for k in (*ends, *inside)),
            max(k * (6 * g**3 * k - rise) for k in ends),
        )
        least, greatest = self.setting.least, self.setting.greatest
        return sliding_command(box, q, g * high, least=least, greatest=greatest)

    def start_words(self) -> str:
        """R(0)."""
        return f", R(0) = {show(self.R0)} s"

    def words(self) -> list[str]:
        """The filter and the law."""
        return [
            f"R' = -lambda R + g^2 (1 + b0), lambda = {show(self.lam)} 1/s,",
            f"law {LAW}: Omega = w + 2 g^2 kappa bv, kappa = 1/R,",
            FAMILY,
        ]
