"""The adaptive scaling law, kappa = k: its comparison system.

Lower bounds y, s, k, r and upper bounds Y, Z, L, U of |Omega|_J, sqrt(1 - b0), k and R.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from .bernstein import Form
from .comparison import (
    ONE,
    TWO,
    Bounds,
    Comparison,
    Conditions,
    Setting,
    angle_factor,
    comparison,
    initial_values,
    rate_factor,
)
from .exact_numbers import HALF, Vector, require, show
from .floor_bounds import Box, sliding_command
from .known_laws import FAMILY, gain_numbers, read_scaled
from .reading import Node

LAW = "adaptive-scaling"


@comparison
@dataclass(frozen=True)
class AdaptiveScaling(Comparison):
    """lam, gamma, a and R0, k0: the numbers of the law's equations, and where its states start."""

    name: ClassVar[str] = LAW
    states: ClassVar[tuple[str, ...]] = ("R", "k")
    sides: ClassVar[Mapping[str, int]] = {"y": -1, "s": -1, "k": -1, "r": -1, "Y": 1, "Z": 1, "L": 1, "U": 1}
    floor: ClassVar[str | None] = "r"
    decaying: ClassVar[frozenset[str]] = frozenset({"Y", "Z"})
    free: ClassVar[frozenset[str]] = frozenset({"L"})

    setting: Setting
    lam: Fraction
    R0: Fraction
    gamma: Fraction
    k0: Fraction
    a: Fraction

    @property
    def tail_sides(self) -> Mapping[str, int]:
        """The upper half, with k held."""
        return {"k": -1, "r": -1, "Y": 1, "Z": 1, "L": 1, "U": 1}

    @classmethod
    def read(cls, data: Node, setting: Setting) -> AdaptiveScaling:
        """Read lambda, gamma and a off the program, whose equations are proved to be the law's."""
        scaled = read_scaled(data)
        return cls._with((scaled.lam, *gain_numbers(scaled)), data, setting)

    @classmethod
    def by_name(cls, data: Node, setting: Setting) -> AdaptiveScaling:
        """Read the numbers off the parameters of a file of earlier versions."""
        lam, gamma, a = (data["parameters"][name].number() for name in ("lambda", "gamma", "a"))
        require(min(lam, gamma, a) > 0, "parameters must be positive")
        return cls._with((lam, gamma, a), data, setting)

    @classmethod
    def _with(
        cls, numbers: tuple[Fraction, Fraction, Fraction], data: Node, setting: Setting
    ) -> AdaptiveScaling:
        start, (lam, gamma, a) = initial_values(data, {"R": "R0", "k": "k0"}), numbers
        require(start["R"] > 0 and start["k"] >= 0, "expected R(0) > 0 and k(0) >= 0")
        return cls(setting, lam, start["R"], gamma, start["k"], a)

    def start(self, s: Vector, y: Vector) -> Bounds:
        """R(0) and k(0) from both sides, and the set's own bounds."""
        known = {"k": self.k0, "L": self.k0, "r": self.R0, "U": self.R0}
        return known | {"y": y[0], "Y": y[1], "s": s[0], "Z": s[1]}

    def kappa(self) -> Fraction:
        """k(0)."""
        return self.k0

    def conditions(
        self, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: Sequence[str], *, tail: bool
    ) -> Conditions:
        """Every bound's sign and slope; k's from above in the form that the step names."""
        if tail:
            yield from self._tail_conditions(G, x, dx)
            return
        y, s, k, r = (x[name] for name in ("y", "s", "k", "r"))
        Y, Z, L, U = (x[name] for name in ("Y", "Z", "L", "U"))
        c, lam, gamma, a = self.setting.c, self.lam, self.gamma, self.a
        require(len(modes) in (2, 3) and modes[0] in ("kept", "zero"), "unknown form of the inequalities")
        S, T = s * s, Z * Z
        low_room, high_room = TWO - S, TWO - T
        yield "s^2 <= 2", high_room
        yield from ((f"{name} >= 0", x[name]) for name in x)
        low_pull, high_pull = (G * L * low_room).times(HALF), (G * k * high_room).times(HALF)
        yield "slope of y", -dx["y"] - low_pull * y
        yield "slope of Y", dx["Y"] + high_pull * Y
        if modes[0] == "kept":
            yield "slope of s", -dx["s"] - (Y * angle_factor(S)).times(c) - low_pull * s
        else:
            yield "s = 0", -s
        yield "slope of Z", dx["Z"] - (Y * rate_factor(T, modes)).times(c) + high_pull * Z
        yield "slope of r", G * high_room - r.times(lam) - dx["r"]
        yield "slope of U", dx["U"] + U.times(lam) - G * low_room
        for room, square in ((low_room, S), (high_room, T)):
            yield "slope of k", (G * r * room * (y * y + square.times(2 * a))).times(gamma) - dx["k"]
        square = Y * Y
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
        yield "slope of L", dx["L"] - (G * U * f).times(gamma)

    def _tail_conditions(self, G: Form, x: dict[str, Form], dx: dict[str, Form]) -> Conditions:
        """Repeating part: k held, (Y, Z) may be scaled down together, L grows by what (Y, Z) feed it."""
        k, r, Y, Z, U = (x[name] for name in ("k", "r", "Y", "Z", "U"))
        T = Z * Z
        room = TWO - T
        pull = (G * k * room).times(HALF)
        yield "s^2 <= 2", room
        yield from ((f"{name} >= 0", x[name]) for name in x)
        yield "slope of k", -dx["k"]
        yield "slope of r", G * room - r.times(self.lam) - dx["r"]
        yield "slope of Y", dx["Y"] + pull * Y
        yield "slope of Z", dx["Z"] - Y.times(self.setting.c) + pull * Z
        yield "slope of U", dx["U"] + U.times(self.lam) - G.times(2)
        yield "slope of L", dx["L"] - (G * U * (Y * Y + T.times(2 * self.a))).times(2 * self.gamma)

    def limits(self, first: Bounds, last: Bounds, ratio: Fraction) -> Bounds:
        """L for all later time: over the n-th period it grows by at most ratio^(2 n) times the first's."""
        return {"L": first["L"] + max(last["L"] - first["L"], Fraction(0)) / (1 - ratio**2)}

    def box(
        self, low: Bounds, high: Bounds, modes: Sequence[str], *, repeats: bool, limits: Bounds
    ) -> Mapping[str, Fraction]:
        """Read the bounds off the components."""
        del modes, repeats
        top = limits.get("L", high["L"])
        return {"S": high["Z"] ** 2, "y": high["Y"], "low": low["k"], "high": top, "R": high["U"]}

    def command(self, box: Box) -> Fraction:
        """Use 0 <= kappa' = gamma R g^2 f."""
        g, high, a, zero = box.g, box.high, self.a, Fraction(0)
        slope = [-4 * s * k for s in box.slope for k in (box.low, high)]
        b0, square, y2 = 1 - min(box.S, Fraction(2)), 2 * g**3 * high**2, box.y**2
        intake = min(2 * (y2 + 2 * a * box.S), 2 * a * (1 + y2 / (4 * a)) ** 2)
        low = -2 * g**3 * self.gamma * box.more["R"] * intake + min(square * b0, zero)
        q = (min(slope) + low, max(slope) + square)
        least, greatest = self.setting.least, self.setting.greatest
        return sliding_command(box, q, g * high, least=least, greatest=greatest)

    def start_words(self) -> str:
        """R(0) and k(0)."""
        return f", R(0) = {show(self.R0)} s, k(0) = {show(self.k0)} 1/s"

    def words(self) -> list[str]:
        """The filter and the law."""
        update = "k' = gamma R g^2 [(1 + b0) Omega'J Omega + 2 a |bv|^2]"
        numbers = f"gamma = {show(self.gamma)}, a = {show(self.a)}"
        return [
            f"R' = -lambda R + g^2 (1 + b0), lambda = {show(self.lam)} 1/s,",
            f"law {LAW}: Omega = w + 2 g^2 kappa bv, kappa = k, {update}, {numbers},",
            FAMILY,
        ]
