"""Comparison system of the adaptive scaling law, kappa = k.

Lower and upper copies of (y, s, R, k), each bounded with the others anywhere in between:

    k' = gamma R g^2 f(S, y),   f(S, y) = (2 - S)(y^2 + 2 a S)

f rises with y and is concave in S, so on [S_low, S_high] it is least at an end point, and at
most, in the step's own choice: "rising" f(S_high, y) where 4 a - y^2 - 4 a S_high >= 0,
"falling" f(S_low, y) where 4 a - y^2 - 4 a S_low <= 0, "top" 2 a (1 + y^2/(4 a))^2 always, or
"split" (2 - S_low)(y^2 + 2 a S_high) always.
The lower bound of s ends ("zero") where it would reach 0.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import sqrt
from typing import Any, final

import numpy as np

from ...models.closed_loop import ClosedLoop
from ...models.laws import Expression, Law
from ...models.types import Array
from ..exact.rounding import rounded_down, rounded_up
from ..flow.inequalities import Slope
from ..flow.stepping import Modes
from .adaptive_tail import AdaptiveTailSystem
from .boxes import BoxColumns, Interval
from .comparison import (
    ATTITUDE_BOUND_LOST,
    ROUND_UP,
    BodyBounds,
    angle_factor,
    at_least_tiny,
    drives_attitude,
    factor_near,
    filter_scale,
    rate_factor,
)
from .law_system import LawSystem
from .proofs import CASCADE, ComparisonProof, attitude_measures
from .recognise import NoComparisonError, compared_law, law_words
from .sets import InitialSet

MIN_ANGLE_BOUND_SHARE = 0.02
"""A lower bound of s below this share of the upper one is given up: it no longer helps."""


MIN_RATE_BOUND_SHARE = 1e-3
"""Likewise for y, which enters as its square."""


MIN_GAIN_SHARE = 0.01
"""A lower bound of k below this share of lambda may be held for a step: as g opens it learns less
than the slack takes, and it must not fall below zero."""


ABOVE_ROUNDING = 1e-11
"""Relative slack of k per second, so that its slope is not lost in the rounding of its value."""


@final
class AdaptiveSystem(LawSystem):
    """Components y, s, k, r and their upper twins Y, Z, L, U (Z bounds s, L bounds k, U bounds R).

    Parameters
    ----------
    decay : lambda, 1/s
    initial_filter : R(0), s
    learning_rate : gamma
    initial_gain : k(0), 1/s
    weight : a, kg m^2/s^2
    coupling : c >= 1/sqrt(8 Jmin)
    """

    names = ("y", "s", "k", "r", "Y", "Z", "L", "U")
    signs = (-1, -1, -1, -1, 1, 1, 1, 1)
    decaying: tuple[tuple[str, ...], ...] = ()
    floor_component = "r"
    is_binned = True
    why_it_converges = CASCADE

    def __init__(
        self,
        *,
        decay: Fraction,
        initial_filter: Fraction,
        learning_rate: Fraction,
        initial_gain: Fraction,
        weight: Fraction,
        coupling: float,
    ) -> None:
        super().__init__(lam=decay, gamma=learning_rate, a=weight, c=coupling)
        self.decay, self.initial_filter, self.learning_rate = decay, initial_filter, learning_rate
        self.initial_gain, self.weight, self.coupling = initial_gain, weight, coupling

    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """Values at t = 0, on the safe side of the initial set."""
        R0, k0 = self.initial_filter, self.initial_gain
        return (
            initial.y_low, initial.s_low, rounded_down(k0), rounded_down(R0),
            initial.y_high, initial.s_high, rounded_up(k0), rounded_up(R0),
        )  # fmt: skip

    def tail(self, state: Sequence[float]) -> tuple[AdaptiveTailSystem, tuple[float, ...]]:
        """Return the upper half of the system with k held at its lower bound."""
        _, _, k, r, Y, Z, L, U = state
        system = AdaptiveTailSystem(
            decay=self.decay, learning_rate=self.learning_rate, weight=self.weight, coupling=self.coupling
        )
        return system, (k, r, Y, Z, L, U)

    def why_stuck(self, initial: InitialSet) -> tuple[str, str] | None:
        """k(0) = 0 learns nothing near the target."""
        if self.initial_gain != 0 or initial.s_low > 0 or initial.y_low > 0:
            return None
        reason = (
            "k(0) = 0: the nearer a start is to the target, the less its gain learns; no decay is certified "
            "for all of them at once"
        )
        return reason, "take k0 > 0"

    def measures(self, loop: ClosedLoop) -> dict[str, Expression]:
        """What each component bounds, as functions of the state."""
        y, s = attitude_measures(loop)
        k, R = loop.controller_states["k"], loop.controller_states["R"]
        return {"y": y, "Y": y, "s": s, "Z": s, "k": k, "L": k, "r": R, "U": R}

    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Read the bounds off the components."""
        return {
            "cosine_gap": np.minimum(high["Z"] ** 2 * ROUND_UP, 2.0),
            "weighted_rate": high["Y"],
            "filter_low": low["r"],
            "filter_high": high["U"],
            "gain_low": low["k"],
            "gain_high": high["L"],
        }

    def torque_terms(self, c: BoxColumns) -> tuple[list[Interval], Array]:
        """With 0 <= kappa' = gamma R g^2 f."""
        gamma, a = rounded_up(self.learning_rate), rounded_up(self.weight)
        square = 2 * c.g**3 * c.high**2
        intake = np.minimum(2 * (c.y**2 + 2 * a * c.S), 2 * a * (1 + c.y**2 / (4 * a)) ** 2)
        return [
            (-2 * c.g**3 * gamma * c.R * intake, np.zeros_like(c.g)),
            (np.minimum(square * c.b0_low, 0.0), square),
        ], c.g * c.high

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Give up lower bounds of y and s where they no longer help; keep upper ones off underflow."""
        y, s, k, r, Y, Z, L, U = state
        low = (0.0 if y < MIN_RATE_BOUND_SHARE * Y else y, 0.0 if modes[0] == "zero" else s)
        Z = at_least_tiny(Z)
        return (*low, k, r, drives_attitude(Y, Z, self.floats.lam / self.coupling), Z, L, U)

    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """Whether the lower bound of s is kept; how to bound f from above, best now first; k held last."""
        _, s, k, _, Y, Z, _, _ = state
        a = self.floats.a
        if Z * Z >= ATTITUDE_BOUND_LOST:
            return ()
        tops = ["top", "split"] if self._f_top(Y) < self._f_split(s, Y, Z) else ["split", "top"]
        if 4 * a - Y * Y - 4 * a * Z * Z >= 0:
            tops.insert(0, "rising")
        if 4 * a - Y * Y - 4 * a * s * s <= 0:
            tops.insert(0, "falling")
        if peak == 0.0:
            tops = ["split"]
        keeps = ("kept", "zero") if s > MIN_ANGLE_BOUND_SHARE * Z else ("zero",)
        learns: list[Modes] = [(), ("held",)] if peak > 0 and k < MIN_GAIN_SHARE * self.floats.lam else [()]
        t = factor_near(Z, self.coupling * Y * sqrt(1.0 - 0.5 * Z * Z), length)
        if not t:
            return ()
        return tuple((keep, top, t, *held) for keep in keeps for held in learns for top in tops)

    def _f_top(self, y: float) -> float:
        return 2.0 * float(self.floats.a) * (1.0 + y * y / (4.0 * float(self.floats.a))) ** 2

    def _f_split(self, s: float, Y: float, Z: float) -> float:
        return (2.0 - s * s) * (Y * Y + 2.0 * float(self.floats.a) * Z * Z)

    def slopes(self, G: Any, x: Sequence[Any], modes: Modes, n: Any) -> dict[str, Slope]:
        """State the module's inequalities."""
        y, s, k, r, Y, Z, L, U = x
        lam, gamma, a, c = n.lam, n.gamma, n.a, n.c
        S, T, top = s * s, Z * Z, Y * Y
        room_low, room_high = 2 - S, 2 - T
        low_pull, high_pull = G * L * room_low / 2, G * k * room_high / 2
        if modes[1] == "top":
            crest = 1 + top / (4 * a)
            f = 2 * a * (crest * crest)
        else:
            room = room_high if modes[1] == "rising" else room_low
            f = room * (top + 2 * a * (S if modes[1] == "falling" else T))
        slopes = {
            "y": -low_pull * y,
            "k": tuple(
                gamma * r * G * (room * (y * y + 2 * a * square))
                for room, square in ((room_low, S), (room_high, T))
            ),
            "r": -lam * r + G * room_high,
            "Y": -high_pull * Y,
            "Z": c * Y * rate_factor(T, modes[2]) - high_pull * Z,
            "L": gamma * U * G * f,
            "U": -lam * U + G * room_low,
        }
        if modes[0] == "kept":
            slopes["s"] = -c * Y * angle_factor(S) - low_pull * s
        return slopes

    def signs_of(self, x: Sequence[Any], modes: Modes, n: Any) -> Iterator[Any]:
        """Every component >= 0, s <= sqrt 2, the lower bound of s zero or kept, and where f is greatest."""
        y, s, k, r, Y, Z, _, U = x
        yield 2 - Z * Z
        yield from (y, s, k, r, Z, U)
        if modes[0] == "zero":
            yield -s
        if modes[1] == "rising":
            yield 4 * n.a - Y * Y - Z * Z * (4 * n.a)
        elif modes[1] == "falling":
            yield Y * Y + s * s * (4 * n.a) - 4 * n.a

    def pushed(
        self, slopes: Mapping[str, float], state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Push each by `slack` times its own scale; k may be held."""
        y, s, _, r, Y, Z, L, U = state
        lam, c, gamma, a2 = self.floats.lam, self.coupling, self.floats.gamma, 2.0 * self.floats.a
        scale, spread = slack * peak * (L + lam), slack * 0.1 * c * Y
        gain_scale = slack * peak * gamma * U * 2.0 * (Y * Y + a2 * (Z * Z))
        gain_scale += ABOVE_ROUNDING * peak * (L + lam)
        return (
            slopes["y"] - scale * y,
            slopes["s"] - scale * s - spread if "s" in slopes else 0.0,
            0.0 if "held" in modes else slopes["k"] - gain_scale,
            slopes["r"] - slack * filter_scale(lam * r, peak),
            slopes["Y"] + scale * Y,
            slopes["Z"] + scale * Z + spread,
            slopes["L"] + gain_scale,
            slopes["U"] + slack * (lam * U + peak),
        )


@final
class AdaptiveProof(ComparisonProof):
    """Laws whose equations are those of adaptive scaling, whatever they are called."""

    name = "adaptive-scaling"

    def system(self, law: Law, bounds: BodyBounds) -> AdaptiveSystem:
        """Read lambda, gamma, a, R(0) and k(0) off the law's equations and states."""
        known = compared_law(law)
        if not known.adaptive:
            raise NoComparisonError(f"{law_words(law)} has no gain of its own")
        return AdaptiveSystem(
            decay=known.decay,
            initial_filter=known.initial_filter,
            learning_rate=known.learning_rate,
            initial_gain=known.initial_gain,
            weight=known.weight,
            coupling=bounds.coupling,
        )
