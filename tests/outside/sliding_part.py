"""The checker's part of the sliding law: its equations and its inequalities, once more, in exact rationals.

python -I -S checker --with sliding_part.py FILE
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar

from checker import (
    RATE,
    Bounds,
    Box,
    Comparison,
    Conditions,
    Form,
    Node,
    Setting,
    Vector,
    angle_factor,
    apply,
    augmented,
    comparison,
    cross,
    move,
    on_sphere,
    read_loop,
    require,
    show,
    sliding_command,
)

HALF, TWO = Fraction(1, 2), Form.constant(2)


def numbers_of(data: Node) -> tuple[Fraction, Fraction]:
    """Return kappa and delta of the law's program, proved to be the sliding law for every inertia."""
    law = data["law"]
    loop = read_loop(data, Node({}, "storage"), symbolic=False, J=None)
    kappa, delta = loop.symbols.get("kappa"), loop.symbols.get("delta")
    require(kappa is not None and delta is not None, "it has no parameters kappa and delta")
    assert kappa is not None
    assert delta is not None
    motion = move(loop, law, augmented(loop, kappa))
    y, g = [loop.ring.symbol(name) for name in RATE], loop.ring.symbol("g")
    gyro, Jy = cross(y, apply(loop.J, motion.rate, loop.ring)), apply(loop.J, y, loop.ring)
    rest = [on_sphere(motion.momentum[i] + gyro[i] + g * g * delta * Jy[i]) for i in range(3)]
    require(
        not any(p.terms for p in rest),
        "its torque does not give J Omega' = -Omega x J w - delta g^2 J Omega, Omega = w + 2 kappa g^2 bv",
    )
    values = [data["parameters"][name].number() for name in ("kappa", "delta")]
    require(min(values) > 0, "kappa and delta must be positive")
    return values[0], values[1]


@comparison
@dataclass(frozen=True)
class Sliding(Comparison):
    """Upper bounds y of |Omega|_J and s of sqrt(1 - b0)."""

    name: ClassVar[str] = "sliding"
    sides: ClassVar[Mapping[str, int]] = {"y": 1, "s": 1}
    decaying: ClassVar[frozenset[str]] = frozenset({"y", "s"})

    setting: Setting
    slope: Fraction
    delta: Fraction

    @classmethod
    def read(cls, data: Node, setting: Setting) -> Sliding:
        """Prove that the program is the law, and take its numbers."""
        if data.has("initial"):
            require(data["initial"].keys() == [], "the law has no states")
        return cls(setting, *numbers_of(data))

    def start(self, s: Vector, y: Vector) -> Bounds:
        """The set's own bounds."""
        return {"y": y[1], "s": s[1]}

    def kappa(self) -> Fraction:
        """The constant gain."""
        return self.slope

    def conditions(
        self, G: Form, x: dict[str, Form], dx: dict[str, Form], modes: Sequence[str], *, tail: bool
    ) -> Conditions:
        """Every bound's sign and slope."""
        y, s = x["y"], x["s"]
        S = s * s
        yield "y >= 0", y
        yield "s >= 0", s
        yield "s^2 <= 2", TWO - S
        yield "slope of y", dx["y"] + (G * y).times(self.delta)
        drift = y if tail else y * angle_factor(S)
        yield (
            "slope of s",
            dx["s"] - drift.times(self.setting.c) + (G * s * (TWO - S)).times(self.slope * HALF),
        )

    def box(
        self, low: Bounds, high: Bounds, modes: Sequence[str], *, repeats: bool, limits: Bounds
    ) -> Mapping[str, Fraction]:
        """Read the bounds off y and s."""
        return {"S": high["s"] ** 2, "y": high["y"], "low": self.slope, "high": self.slope}

    def command(self, box: Box) -> Fraction:
        """kappa' = 0, and delta g J Omega damps."""
        corners = [-4 * slope * self.slope for slope in box.slope]
        square = 2 * box.g**3 * box.high**2
        b0 = 1 - min(box.S, Fraction(2))
        q = (min(corners) + min(square * b0, Fraction(0)), max(corners) + square)
        least, greatest = self.setting.least, self.setting.greatest
        return sliding_command(box, q, self.delta * box.g, least=least, greatest=greatest)

    def words(self) -> list[str]:
        """The law."""
        numbers = f"kappa = {show(self.slope)}, delta = {show(self.delta)} 1/s"
        return [
            f"law sliding: Omega = w + 2 kappa g^2 bv, {numbers},",
            "whose torque gives J Omega' = -Omega x J w - delta g^2 J Omega,",
        ]
