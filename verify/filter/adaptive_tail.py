"""The adaptive law's comparison system over a period that repeats for ever.

k is held at its lower bound (k never falls), and (Y, Z) scale down together:

    Y' >= -(1/2) g^2 k (2 - S) Y,   Z' >= c Y - (1/2) g^2 k Z (2 - S),   S = Z^2,
    L' >= 2 gamma g^2 U (Y^2 + 2 a S),

so that over the n-th period L grows by at most theta^(2 n) times what it grows over the first.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import exp
from typing import final

from ..exact.bernstein import Bernstein
from ..exact.rational import rational
from ..flow.stepping import Modes
from .comparison import ATTITUDE_BOUND_LOST, ROUND_UP, TWO, filter_scale
from .tail import PeriodicSystem


@final
class AdaptiveTailSystem(PeriodicSystem):
    """Components k, r (lower bounds), Y, Z, L, U (upper bounds of y, s, k, R)."""

    names = ("k", "r", "Y", "Z", "L", "U")
    signs = (-1, -1, 1, 1, 1, 1)
    decaying: tuple[tuple[str, ...], ...] = (("Y", "Z"),)
    free: tuple[str, ...] = ("L",)

    def __init__(
        self, *, decay: Fraction, learning_rate: Fraction, weight: Fraction, coupling: float
    ) -> None:
        self._lam, self._gamma, self._a = float(decay), float(learning_rate), float(weight)
        self._coupling = coupling
        self._lam_exact, self._c = rational(decay), rational(coupling)
        self._gamma_exact, self._a_exact = rational(learning_rate), rational(weight)
        self._half = Bernstein.constant(Fraction(1, 2))

    def contraction(self, period: float) -> float:
        """exp(-lambda T): what R forgets over a period."""
        return exp(-self._lam * period)

    def limits(
        self, start: Mapping[str, float], end: Mapping[str, float], ratios: Mapping[str, float]
    ) -> dict[str, float]:
        """Greatest value of L over all time: a geometric series."""
        theta = ratios["Z"]
        growth = (end["L"] - start["L"]) / (1.0 - theta * theta * ROUND_UP)
        return {"L": (start["L"] + growth * ROUND_UP * ROUND_UP) * ROUND_UP}

    def choices(self, state: Sequence[float], peak: float) -> Sequence[Modes]:
        """One form only."""
        del peak
        return (("tail",),) if state[3] ** 2 < ATTITUDE_BOUND_LOST else ()

    def rate(
        self, gain_square: float, state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Floats; each bound pushed outwards by `slack` times its own scale."""
        del modes
        k, r, Y, Z, L, U = state
        G, lam, T = gain_square, self._lam, Z * Z
        pull, scale = 0.5 * G * k * (2.0 - T), slack * peak * (L + lam)
        intake = 2.0 * self._gamma * U * (Y * Y + 2.0 * self._a * T)
        return (
            0.0,
            -lam * r + G * (2.0 - T) - slack * filter_scale(lam * r, peak),
            (scale - pull) * Y,
            self._coupling * Y * (1.0 + 0.1 * slack) + (scale - pull) * Z,
            intake * (G + slack * peak) + 1e-11 * peak * (L + lam),
            -lam * U + 2.0 * G + slack * (lam * U + peak),
        )

    def conditions(
        self, gain_square: Bernstein, x: Sequence[Bernstein], dx: Sequence[Bernstein], modes: Modes
    ) -> Iterator[Bernstein]:
        """Polynomials >= 0 iff every bound holds; the signs they rest on among them."""
        del modes
        k, r, Y, Z, _, U = x
        dk, dr, dY, dZ, dL, dU = dx
        G, T = gain_square, Z * Z
        room = TWO - T
        pull = G * k * room * self._half
        yield from (room, k, Y, Z, U, -dk)
        yield G * room - r * self._lam_exact - dr
        yield dY + pull * Y
        yield dZ - Y * self._c + pull * Z
        yield dL - G * U * (Y * Y + T * (2 * self._a_exact)) * (2 * self._gamma_exact)
        yield dU + U * self._lam_exact - G * 2
