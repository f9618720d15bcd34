"""The adaptive law's comparison system over a period that repeats for ever.

k is held at its lower bound (k never falls), and (Y, Z) scale down together:

    Y' >= -(1/2) g^2 k (2 - S) Y,   Z' >= c Y - (1/2) g^2 k Z (2 - S),   S = Z^2,
    L' >= 2 gamma g^2 U (Y^2 + 2 a S),

so that over the n-th period L grows by at most theta^(2 n) times what it grows over the first.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from typing import Any, final

from ..flow.inequalities import Slope, StatedSystem
from ..flow.stepping import Modes
from .comparison import ATTITUDE_BOUND_LOST, ROUND_UP, filter_scale
from .tail import PeriodicSystem


@final
class AdaptiveTailSystem(StatedSystem, PeriodicSystem):
    """Components k, r (lower bounds), Y, Z, L, U (upper bounds of y, s, k, R)."""

    names = ("k", "r", "Y", "Z", "L", "U")
    signs = (-1, -1, 1, 1, 1, 1)
    decaying: tuple[tuple[str, ...], ...] = (("Y", "Z"),)
    free: tuple[str, ...] = ("L",)

    def __init__(
        self, *, decay: Fraction, learning_rate: Fraction, weight: Fraction, coupling: float
    ) -> None:
        super().__init__(lam=decay, gamma=learning_rate, a=weight, c=coupling)
        self.decay = decay

    def limits(
        self, start: Mapping[str, float], end: Mapping[str, float], ratios: Mapping[str, float]
    ) -> dict[str, float]:
        """Greatest value of L over all time: a geometric series."""
        theta = ratios["Z"]
        growth = (end["L"] - start["L"]) / (1.0 - theta * theta * ROUND_UP)
        return {"L": (start["L"] + growth * ROUND_UP * ROUND_UP) * ROUND_UP}

    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """One form only."""
        del peak, length
        return (("tail",),) if state[3] ** 2 < ATTITUDE_BOUND_LOST else ()

    def slopes(self, G: Any, x: Sequence[Any], modes: Modes, n: Any) -> dict[str, Slope]:
        """State the module's inequalities."""
        del modes
        k, r, Y, Z, _, U = x
        T = Z * Z
        pull = G * k * (2 - T) / 2
        return {
            "k": 0,
            "r": -n.lam * r + G * (2 - T),
            "Y": -pull * Y,
            "Z": n.c * Y - pull * Z,
            "L": 2 * n.gamma * U * (Y * Y + 2 * n.a * T) * G,
            "U": -n.lam * U + 2 * G,
        }

    def signs_of(self, x: Sequence[Any], modes: Modes, n: Any) -> Iterator[Any]:
        """0 <= s <= sqrt 2, and k, Y, U >= 0."""
        del modes, n
        k, _, Y, Z, _, U = x
        yield from (2 - Z * Z, k, Y, Z, U)

    def pushed(
        self, slopes: Mapping[str, float], state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Push each by `slack` times its own scale."""
        del modes
        _, r, Y, Z, L, U = state
        lam, gamma, a = self.floats.lam, self.floats.gamma, self.floats.a
        scale, above_rounding = slack * peak * (L + lam), 1e-11 * peak * (L + lam)
        intake = 2.0 * gamma * U * (Y * Y + 2.0 * a * (Z * Z))
        return (
            0.0,
            slopes["r"] - slack * filter_scale(lam * r, peak),
            slopes["Y"] + scale * Y,
            slopes["Z"] + scale * Z + slack * 0.1 * self.floats.c * Y,
            slopes["L"] + intake * (slack * peak) + above_rounding,
            slopes["U"] + slack * (lam * U + peak),
        )
