"""A law with its own proof: sliding variable Omega = w + 2 kappa g^2 bv, constant gain, its own damping.

    u = -2 kappa g bv x J w - 4 kappa g' J bv - 2 kappa g J bv' - delta g J Omega

makes J Omega' = -Omega x J w - delta g^2 J Omega, so that with y = |Omega|_J and s = sqrt(1 - b0), S = s^2,

    y' = -delta g^2 y,        s' <= c A(S) y - (kappa/2) g^2 s (2 - S),

c = 1/sqrt(8 Jmin), A(S) = 1 - S/4 - S^2/32 >= sqrt(1 - S/2). The law needs no filter: its gain is known.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from pathlib import Path
from typing import Any, ClassVar, final

import casadi as ca
import numpy as np
from intermit.models.closed_loop import ClosedLoop
from intermit.models.laws import Control, Equation, Expression, Law, PlantSymbols, TimeSymbols, known
from intermit.models.types import Array
from intermit.verify import checker
from intermit.verify.exact.rounding import rounded_down, rounded_up
from intermit.verify.filter.boxes import BoxColumns, Interval
from intermit.verify.filter.comparison import ROUND_UP, BodyBounds, angle_factor
from intermit.verify.filter.law_system import LawSystem
from intermit.verify.filter.proofs import ComparisonProof, attitude_measures
from intermit.verify.filter.recognise import checked_law
from intermit.verify.filter.sets import InitialSet

_SOURCE = Path(__file__).with_name("sliding_part.py")
PART = checker.read_part(_SOURCE.read_text(encoding="utf-8"), _SOURCE.name)
"""The law's part of the stand-alone checker."""


@final
@dataclass(frozen=True)
class SlidingLaw(Law):
    """The law of the module."""

    name: ClassVar[str] = "sliding"
    equations: ClassVar[tuple[Equation, ...]] = (
        Equation(
            "Sliding law",
            r"vb(Omega) &= vb(omega) + 2 kappa g^2 vb(beta)_v, \ "
            r"vb(J) dot(vb(Omega)) &= -vb(Omega) times vb(J) vb(omega) - delta g^2 vb(J) vb(Omega)",
            r"\begin{aligned}\bm\Omega&=\bm\omega+2\kappa g^2\bm\beta_v,\\"
            r"\bm J\dot{\bm\Omega}&=-\bm\Omega\times\bm J\bm\omega-\delta g^2\bm J\bm\Omega\end{aligned}",
        ),
    )

    kappa: Fraction = field(metadata=known("1/s", "> 0", "slope of the sliding variable"))
    delta: Fraction = field(metadata=known("1/s", "> 0", "damping"))

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Torque of the module's formula; `gain` tells the rest of the package what Omega is."""
        kappa, delta, g, J, bv = parameters["kappa"], parameters["delta"], time.g, plant.J, plant.bv
        Omega = plant.w + 2 * kappa * g**2 * bv
        torque = (
            -2 * kappa * g * ca.cross(bv, J @ plant.w)
            - 4 * kappa * time.g_rate * (J @ bv)
            - 2 * kappa * g * (J @ plant.bv_rate)
            - delta * g * (J @ Omega)
        )
        return Control(torque, {}, gain=kappa, gain_rate=ca.SX(0))

    def proofs(self) -> tuple[object, ...]:
        """The proof of this file."""
        return (SlidingProof(),)


@final
class SlidingSystem(LawSystem):
    """Upper bounds y of |Omega|_J and s of sqrt(1 - b0); `scalable` drops A(S), so that both may shrink."""

    names = ("y", "s")
    signs = (1, 1)
    decaying = (("y", "s"),)
    why_it_converges = "|Omega|_J decays as exp(-delta int g^2), and the attitude follows in cascade"
    system_name = "sliding"
    part = PART

    def __init__(self, *, kappa: Fraction, delta: Fraction, coupling: float, scalable: bool = False) -> None:
        super().__init__(kappa=kappa, delta=delta, c=coupling)
        self.kappa, self.delta, self.coupling, self.scalable = kappa, delta, coupling, scalable

    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """The set's own bounds."""
        return (initial.y_high, initial.s_high)

    def tail(self, state: Sequence[float]) -> tuple[SlidingSystem, tuple[float, ...]]:
        """The same inequalities, linear in (y, s) but for what only helps."""
        system = SlidingSystem(kappa=self.kappa, delta=self.delta, coupling=self.coupling, scalable=True)
        return system, tuple(state)

    def measures(self, loop: ClosedLoop) -> Mapping[str, Expression]:
        """What y and s bound."""
        y, s = attitude_measures(loop)
        return {"y": y, "s": s}

    def slopes(self, G: Any, x: Sequence[Any], modes: tuple[str, ...], n: Any) -> Mapping[str, Any]:
        """State the module's inequalities: in floats they search, in polynomials they prove."""
        y, s = x
        S = s * s
        drift = n.c * y if self.scalable else n.c * y * angle_factor(S)
        return {"y": -n.delta * G * y, "s": drift - n.kappa * G * s * (2 - S) / 2}

    def signs_of(self, x: Sequence[Any], modes: tuple[str, ...], n: Any) -> Iterator[Any]:
        """y, s >= 0 and s <= sqrt 2."""
        y, s = x
        yield from (y, s, 2 - s * s)

    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Read the bounds off y and s; the gain is known."""
        one = np.ones_like(high["s"])
        return {
            "cosine_gap": high["s"] ** 2 * ROUND_UP,
            "weighted_rate": high["y"],
            "gain_low": rounded_down(self.kappa) * one,
            "gain_high": rounded_up(self.kappa) * one,
        }

    def torque_terms(self, c: BoxColumns) -> tuple[list[Interval], Array]:
        """kappa' = 0, and d = delta g."""
        square = 2 * c.g**3 * c.high**2
        return [(np.minimum(square * c.b0_low, 0.0), square)], rounded_up(self.delta) * c.g


@final
class SlidingProof(ComparisonProof):
    """Laws whose equations are those of the module: the checker's part reads them."""

    name = "sliding"

    def system(self, law: Law, bounds: BodyBounds) -> SlidingSystem:
        """Read kappa and delta off the law's program."""
        with checked_law(law) as data:
            kappa, delta = PART.module.numbers_of(data)
        return SlidingSystem(kappa=kappa, delta=delta, coupling=bounds.coupling)
