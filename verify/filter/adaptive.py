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

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import exp
from typing import final

import numpy as np

from ...models.types import Array
from ..exact.bernstein import Bernstein
from ..exact.rational import rational
from ..exact.rounding import rounded_down, rounded_up
from ..flow.stepping import Modes
from .adaptive_tail import AdaptiveTailSystem
from .comparison import (
    ATTITUDE_BOUND_LOST,
    ONE,
    ROUND_UP,
    TWO,
    angle_factor,
    angle_factor_float,
    at_least_tiny,
    drives_attitude,
    filter_scale,
)
from .flowpipe import LawComparison
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
class AdaptiveSystem(LawComparison):
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
        self.decay, self.initial_filter, self.learning_rate = decay, initial_filter, learning_rate
        self.initial_gain, self.weight, self.coupling = initial_gain, weight, coupling
        self._lam, self._gamma, self._a = float(decay), float(learning_rate), float(weight)
        self._lam_exact, self._c = rational(decay), rational(coupling)
        self._gamma_exact, self._a_exact = rational(learning_rate), rational(weight)
        self._half = Bernstein.constant(Fraction(1, 2))

    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """Values at t = 0, on the safe side of the initial set."""
        R0, k0 = self.initial_filter, self.initial_gain
        return (
            initial.y_low, initial.s_low, rounded_down(k0), rounded_down(R0),
            initial.y_high, initial.s_high, rounded_up(k0), rounded_up(R0),
        )  # fmt: skip

    def contraction(self, period: float) -> float:
        """exp(-lambda T): what R forgets over a period."""
        return exp(-self._lam * period)

    def tail(self, state: Sequence[float]) -> tuple[AdaptiveTailSystem, tuple[float, ...]]:
        """Return the upper half of the system with k held at its lower bound."""
        _, _, k, r, Y, Z, L, U = state
        system = AdaptiveTailSystem(
            decay=self.decay, learning_rate=self.learning_rate, weight=self.weight, coupling=self.coupling
        )
        return system, (k, r, Y, Z, L, U)

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

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Give up lower bounds of y and s where they no longer help; keep upper ones off underflow."""
        y, s, k, r, Y, Z, L, U = state
        low = (0.0 if y < MIN_RATE_BOUND_SHARE * Y else y, 0.0 if modes[0] == "zero" else s)
        Z = at_least_tiny(Z)
        return (*low, k, r, drives_attitude(Y, Z, self._lam / self.coupling), Z, L, U)

    def choices(self, state: Sequence[float], peak: float) -> Sequence[Modes]:
        """Whether the lower bound of s is kept; how to bound f from above, best now first; k held last."""
        _, s, k, _, Y, Z, _, _ = state
        a = self._a
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
        learns: list[Modes] = [(), ("held",)] if peak > 0 and k < MIN_GAIN_SHARE * self._lam else [()]
        return tuple((keep, top, *held) for keep in keeps for held in learns for top in tops)

    def _f_top(self, y: float) -> float:
        return 2.0 * self._a * (1.0 + y * y / (4.0 * self._a)) ** 2

    def _f_split(self, s: float, Y: float, Z: float) -> float:
        return (2.0 - s * s) * (Y * Y + 2.0 * self._a * Z * Z)

    def rate(
        self, gain_square: float, state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Floats; each bound pushed outwards by `slack` times its own scale."""
        y, s, k, r, Y, Z, L, U = state
        lam, c, G = self._lam, self.coupling, gain_square
        S, T, a2 = s * s, Z * Z, 2.0 * self._a
        room_low, room_high = 2.0 - S, 2.0 - T
        scale = slack * peak * (L + lam)
        low_pull, high_pull = 0.5 * G * L * room_low, 0.5 * G * k * room_high
        drift, spread = c * Y, slack * 0.1 * c * Y
        s_rate = 0.0
        if modes[0] == "kept":
            s_rate = -drift * angle_factor_float(S) - low_pull * s - scale * s - spread
        square, top = y * y, Y * Y
        f_low = min(room_low * (square + a2 * S), room_high * (square + a2 * T))
        mode = modes[1]
        if mode == "split":
            f_high = room_low * (top + a2 * T)
        elif mode == "rising":
            f_high = room_high * (top + a2 * T)
        elif mode == "falling":
            f_high = room_low * (top + a2 * S)
        else:
            f_high = self._f_top(Y)
        gamma = self._gamma
        gain_scale = slack * peak * gamma * U * 2.0 * (top + a2 * T)
        gain_scale += ABOVE_ROUNDING * peak * (L + lam)
        k_rate = gamma * r * G * f_low - gain_scale
        return (
            -low_pull * y - scale * y,
            s_rate,
            0.0 if "held" in modes else k_rate,
            -lam * r + G * room_high - slack * filter_scale(lam * r, peak),
            -high_pull * Y + scale * Y,
            drift * angle_factor_float(T) - high_pull * Z + scale * Z + spread,
            gamma * U * G * f_high + gain_scale,
            -lam * U + G * room_low + slack * (lam * U + peak),
        )

    def conditions(
        self, gain_square: Bernstein, x: Sequence[Bernstein], dx: Sequence[Bernstein], modes: Modes
    ) -> Iterator[Bernstein]:
        """Polynomials >= 0 iff every bound holds; the signs they rest on among them."""
        y, s, k, r, Y, Z, L, U = x
        dy, ds, dk, dr, dY, dZ, dL, dU = dx
        G, lam, c = gain_square, self._lam_exact, self._c
        S, T = s * s, Z * Z
        room_low, room_high = TWO - S, TWO - T
        yield room_high
        yield from (y, s, k, r, Z)
        low_pull, high_pull = G * L * room_low * self._half, G * k * room_high * self._half
        yield -dy - low_pull * y
        yield dY + high_pull * Y
        if modes[0] == "kept":
            yield -ds - Y * angle_factor(S) * c - low_pull * s
        else:
            yield -s
        yield dZ - Y * angle_factor(T) * c + high_pull * Z
        yield G * room_high - r * lam - dr
        yield dU + U * lam - G * room_low
        a2 = 2 * self._a_exact
        intake = G * r * self._gamma_exact
        for room, square in ((room_low, S), (room_high, T)):
            yield intake * room * (y * y + square * a2) - dk
        yield from self._upper_gain(G, S, T, Y, U, dL, modes[1])

    def _upper_gain(
        self,
        G: Bernstein,
        S: Bernstein,
        T: Bernstein,
        Y: Bernstein,
        U: Bernstein,
        dL: Bernstein,
        mode: str,
    ) -> Iterator[Bernstein]:
        a = self._a_exact
        square = Y * Y
        if mode == "top":
            f = (ONE + square * (1 / (4 * a))) * (ONE + square * (1 / (4 * a))) * (2 * a)
        elif mode == "rising":
            f = (TWO - T) * (square + T * (2 * a))
            yield ONE * (4 * a) - square - T * (4 * a)
        elif mode == "falling":
            f = (TWO - S) * (square + S * (2 * a))
            yield square + S * (4 * a) - ONE * (4 * a)
        else:
            f = (TWO - S) * (square + T * (2 * a))
        yield U
        yield dL - G * U * f * self._gamma_exact
