"""Comparison system of the persistence-filter law, kappa = 1/R.

With K <= 1/R (from R' <= -lambda R + 2 g^2) and two bounds of the error angle:

a.  y, s: the inequalities of `comparison` with kappa >= K.
b.  In z = s sqrt(R/R0), v = y sqrt(R/R0) the gain cancels:
        v' = -(lambda/2) v,      z' <= -(lambda/2) z + c v (1 - S/4),   S = R0 z^2/R >= R0 K z^2,
    so S <= R0 z^2 / R, exact for a start at rest.

The floor r <= R then obeys r' <= -lambda r + g^2 (2 - sigma), sigma any upper bound of S; a step
uses "angle" (sigma = s^2), "cascade" (sigma = R0 z^2/r, valid where r touches R), or "none"
(sigma = 2).
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
from ..exact.rounding import rounded_down
from ..flow.stepping import Modes
from .comparison import (
    ATTITUDE_BOUND_LOST,
    NO_BOUND,
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


@final
class PersistenceSystem(LawComparison):
    """Components K, y, s, v, z, r of the module's inequalities.

    Parameters
    ----------
    decay : lambda, 1/s
    initial_filter : R(0), s
    coupling : c >= 1/sqrt(8 Jmin)
    scalable : drop the factors A(S) and 1 - S/4, so that (y, s, v, z) may be scaled down together
    """

    names = ("K", "y", "s", "v", "z", "r")
    signs = (-1, 1, 1, 1, 1, -1)
    decaying: tuple[tuple[str, ...], ...] = (("y", "s"), ("v", "z"))

    def __init__(
        self, *, decay: Fraction, initial_filter: Fraction, coupling: float, scalable: bool = False
    ) -> None:
        self.decay, self.initial_filter, self.coupling = decay, initial_filter, coupling
        self.scalable = scalable
        self._lam, self._R0 = float(decay), float(initial_filter)
        half = Bernstein.constant(Fraction(1, 2))
        self._half, self._quarter = half, half * half
        self._lam_exact, self._c = rational(decay), rational(coupling)
        self._R0_exact = rational(initial_filter)

    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """Values at t = 0, on the safe side of the initial set."""
        K = rounded_down(1 / self.initial_filter)
        y, s = initial.y_high, initial.s_high
        return (K, y, s, y, s, rounded_down(self.initial_filter))

    def tail(self, state: Sequence[float]) -> tuple[PersistenceSystem, tuple[float, ...]]:
        """Return the same inequalities without the factors that a scaling would break."""
        system = PersistenceSystem(
            decay=self.decay, initial_filter=self.initial_filter, coupling=self.coupling, scalable=True
        )
        if state[2] * state[2] >= ATTITUDE_BOUND_LOST:
            system.decaying = (("v", "z"),)
            system.free = ("y", "s")
        return system, tuple(state)

    def contraction(self, period: float) -> float:
        """exp(-lambda T): what R forgets over a period."""
        return exp(-self._lam * period)

    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Take the better of the two bounds of angle and rate; s = inf asks for the second alone."""
        r = np.maximum(low["r"], 0.0)
        share = self._R0 / r * ROUND_UP
        s = high["s"]
        angle = np.where((s < NO_BOUND) | np.isinf(s), s**2, 2.0)
        return {
            "cosine_gap": np.minimum(angle, high["z"] ** 2 * share) * ROUND_UP,
            "weighted_rate": np.minimum(high["y"], high["v"] * np.sqrt(share)) * ROUND_UP,
            "filter_low": r,
            "filter_high": ROUND_UP / low["K"],
            "gain_low": low["K"],
            "gain_high": ROUND_UP / r,
        }

    def choices(self, state: Sequence[float], peak: float) -> Sequence[Modes]:
        """Order the bounds of the angle by their value now; none where r < 0, which no step size mends."""
        _, _, s, _, z, r = state
        if r < 0.0:
            return ()
        angle = "angle" if s * s < ATTITUDE_BOUND_LOST else "blind"
        if peak == 0.0:
            return ((angle, "none"),)
        sigma = self._R0 * z * z / r
        filters = ["cascade"] if sigma < 2.0 else ["none", "cascade"]
        if angle == "angle":
            filters.insert(0 if s * s < sigma else 1, "angle")
        return tuple((angle, f) for f in filters)

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Give up s where its bound has reached sqrt 2; keep upper bounds off underflow."""
        K, y, s, v, z, r = state
        s = NO_BOUND if modes[0] == "blind" else s
        s, z, scale = at_least_tiny(s), at_least_tiny(z), self._lam / self.coupling
        return (K, drives_attitude(y, s, scale), s, drives_attitude(v, z, scale), z, r)

    def rate(
        self, gain_square: float, state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Floats; each bound pushed outwards by `slack` times its own scale."""
        K, y, s, v, z, r = state
        lam, c, R0, G = self._lam, self.coupling, self._R0, gain_square
        S = s * s
        pull = 0.5 * G * K * (2.0 - S)
        K_rate = lam * K - 2.0 * G * K * K - slack * (lam * K + 2.0 * peak * K * K)
        if modes[0] == "blind":
            y_rate = s_rate = 0.0
        else:
            factor = 1.0 if self.scalable else angle_factor_float(S)
            y_rate = -pull * y + slack * peak * K * y
            s_rate = c * y * factor - pull * s + slack * (peak * K * s + 0.1 * c * y)
        v_rate = -0.5 * lam * v * (1.0 - slack)
        bend = 1.0 if self.scalable else 1.0 - 0.25 * R0 * K * z * z
        z_rate = -0.5 * lam * z * (1.0 - slack) + c * v * bend + slack * 0.5 * c * v
        if modes[1] == "none":
            r_rate = -lam * r + G * (2.0 - 2.0) - slack * (lam * r)
        else:
            sigma = S if modes[1] == "angle" else R0 * z * z / r
            r_rate = -lam * r + G * (2.0 - sigma) - slack * filter_scale(lam * r, peak)
        return (K_rate, y_rate, s_rate, v_rate, z_rate, r_rate)

    def conditions(
        self, gain_square: Bernstein, x: Sequence[Bernstein], dx: Sequence[Bernstein], modes: Modes
    ) -> Iterator[Bernstein]:
        """Polynomials >= 0 iff every bound holds; the signs r > 0 and S <= 2 among them."""
        K, y, s, v, z, r = x
        dK, dy, ds, dv, dz, dr = dx
        G, lam, c = gain_square, self._lam_exact, self._c
        yield K
        yield K * lam - G * K * K * 2 - dK
        if modes[0] == "angle":
            S = s * s
            room = TWO - S
            pull = G * K * room * self._half
            yield room
            yield s
            yield dy + pull * y
            drift = y if self.scalable else y * angle_factor(S)
            yield ds - drift * c + pull * s
        else:
            yield dy
            yield s - ONE * rational(NO_BOUND)
        yield dv + v * self._half * lam
        bend = ONE if self.scalable else ONE - K * z * z * self._quarter * self._R0_exact
        yield dz + z * self._half * lam - v * bend * c
        yield z
        yield r
        yield from self._floor(gain_square, s, z, r, dr, modes[1])

    def _floor(
        self, G: Bernstein, s: Bernstein, z: Bernstein, r: Bernstein, dr: Bernstein, mode: str
    ) -> Iterator[Bernstein]:
        lam = self._lam_exact
        if mode == "none":
            yield -dr - r * lam
        elif mode == "angle":
            yield G * (TWO - s * s) - r * lam - dr
        else:  # multiplied by r > 0
            yield G * (r * 2 - z * z * self._R0_exact) - r * (r * lam + dr)
