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

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import sqrt
from typing import Any, final

import casadi as ca
import numpy as np

from ...models.closed_loop import ClosedLoop
from ...models.laws import Expression, Law
from ...models.types import Array
from ..exact.rounding import rounded_down, rounded_up
from ..flow.inequalities import Slope
from ..flow.stepping import Modes
from .boxes import OUTWARD, BoxColumns, Interval
from .comparison import (
    ATTITUDE_BOUND_LOST,
    NO_BOUND,
    ROUND_UP,
    BodyBounds,
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


@final
class PersistenceSystem(LawSystem):
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
    floor_component = "r"
    why_it_converges = CASCADE

    def __init__(
        self, *, decay: Fraction, initial_filter: Fraction, coupling: float, scalable: bool = False
    ) -> None:
        super().__init__(lam=decay, R0=initial_filter, c=coupling)
        self.decay, self.initial_filter, self.coupling = decay, initial_filter, coupling
        self.scalable = scalable

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

    def measures(self, loop: ClosedLoop) -> dict[str, Expression]:
        """What each component bounds, as functions of the state."""
        R, R0 = loop.controller_states["R"], float(self.initial_filter)
        y, s = attitude_measures(loop)
        root = ca.sqrt(R / R0)
        return {"K": 1 / R, "y": y, "s": s, "v": y * root, "z": s * root, "r": R}

    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Take the better of the two bounds of angle and rate; s = inf asks for the second alone."""
        r = np.maximum(low["r"], 0.0)
        share = self.floats.R0 / r * ROUND_UP
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

    def torque_terms(self, c: BoxColumns) -> tuple[list[Interval], Array]:
        """With kappa' = lambda kappa - g^2 kappa^2 (1 + b0):

        -2 g kappa' + 2 g^3 kappa^2 b0 = -2 g lambda kappa + 2 g^3 kappa^2 (1 + 2 b0).
        """
        lam, square = rounded_up(self.decay), 2 * c.g**3 * c.high**2
        return [
            (-2 * c.g * lam * c.high, np.zeros_like(c.g)),
            (np.minimum(square * (1 + 2 * c.b0_low), 0.0), 3 * square),
        ], c.g * c.high

    def coefficient(self, c: BoxColumns) -> Interval:
        """Q = -(4 g' + 2 g lambda) kappa + 2 g^3 kappa^2 (1 + 2 b0), whose terms cancel: kappa as one number.

        From above it is convex in kappa; from below too where b0 > -1/2, and its vertex may lie inside.
        """
        lam_low, lam = rounded_down(self.decay), rounded_up(self.decay)
        share = 1 + 2 * c.b0_low
        bend = 2 * share * np.where(share >= 0, c.g_low, c.g) ** 3
        fall, rise = 4 * c.slope_high + 2 * c.g * lam, 4 * c.slope_low + 2 * c.g_low * lam_low
        vertex = np.divide(fall, 2 * bend, out=np.array(c.high), where=bend > 0)
        inside = np.clip(vertex, c.low, c.high)
        lower = np.minimum.reduce([k * (bend * k - fall) for k in (c.low, c.high, inside)])
        upper = np.maximum.reduce([k * (6 * c.g**3 * k - rise) for k in (c.low, c.high)])
        size = c.high * (6 * c.g**3 * c.high + np.maximum(np.abs(fall), np.abs(rise)))
        return lower - size * (OUTWARD - 1), upper + size * (OUTWARD - 1)

    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """Order the bounds of the angle by their value now; none where r < 0, which no step size mends."""
        _, y, s, _, z, r = state
        if r < 0.0:
            return ()
        angle = "angle" if s * s < ATTITUDE_BOUND_LOST else "blind"
        drift = self.coupling * y * sqrt(max(1.0 - 0.5 * s * s, 0.0))
        tangent = () if angle == "blind" else (factor_near(s, drift, length),)
        if tangent == ("",):
            return ()
        if peak == 0.0:
            return ((angle, "none", *tangent),)
        sigma = self.floats.R0 * z * z / r
        filters = ["cascade"] if sigma < 2.0 else ["none", "cascade"]
        if angle == "angle":
            filters.insert(0 if s * s < sigma else 1, "angle")
        return tuple((angle, f, *tangent) for f in filters)

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Give up s where its bound has reached sqrt 2; keep upper bounds off underflow."""
        K, y, s, v, z, r = state
        s = NO_BOUND if modes[0] == "blind" else s
        s, z, scale = at_least_tiny(s), at_least_tiny(z), self.floats.lam / self.coupling
        return (K, drives_attitude(y, s, scale), s, drives_attitude(v, z, scale), z, r)

    def slopes(self, G: Any, x: Sequence[Any], modes: Modes, n: Any) -> dict[str, Slope]:
        """State the module's inequalities."""
        K, y, s, v, z, r = x
        lam, c, R0 = n.lam, n.c, n.R0
        S = s * s
        pull = G * K * (2 - S) / 2
        bend = 1 if self.scalable else 1 - R0 * K * z * z / 4
        slopes = {
            "K": lam * K - 2 * G * K * K,
            "v": -lam * v / 2,
            "z": -lam * z / 2 + c * v * bend,
        }
        if modes[0] == "angle":
            drift = c * y if self.scalable else c * y * rate_factor(S, modes[2])
            slopes |= {"y": -pull * y, "s": drift - pull * s}
        else:
            slopes["y"] = 0
        if modes[1] == "none":
            return slopes | {"r": -lam * r}
        sigma = S if modes[1] == "angle" else R0 * z * z / r
        return slopes | {"r": -lam * r + G * (2 - sigma)}

    def signs_of(self, x: Sequence[Any], modes: Modes, n: Any) -> Iterator[Any]:
        """K, z, r >= 0 and 0 <= s <= sqrt 2, or s given up."""
        del n
        K, _, s, _, z, r = x
        yield from (K, z, r)
        if modes[0] == "angle":
            yield from (2 - s * s, s)
        else:
            yield s - NO_BOUND

    def pushed(
        self, slopes: Mapping[str, float], state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Push each by `slack` times its own scale, r by what keeps it positive after a long off-time."""
        K, y, s, v, z, r = state
        lam, c = self.floats.lam, self.coupling
        K_rate = slopes["K"] - slack * (lam * K + 2.0 * peak * K * K)
        y_rate = s_rate = 0.0
        if modes[0] == "angle":
            y_rate = slopes["y"] + slack * peak * K * y
            s_rate = slopes["s"] + slack * (peak * K * s + 0.1 * c * y)
        v_rate = slopes["v"] * (1.0 - slack)
        z_rate = slopes["z"] + slack * 0.5 * (lam * z + c * v)
        scale = lam * r if modes[1] == "none" else filter_scale(lam * r, peak)
        return (K_rate, y_rate, s_rate, v_rate, z_rate, slopes["r"] - slack * scale)


@final
class PersistenceProof(ComparisonProof):
    """Laws whose equations are the persistence filter's, whatever they are called."""

    name = "persistence-filter"

    def system(self, law: Law, bounds: BodyBounds) -> PersistenceSystem:
        """Read lambda and R(0) off the law's equations and states."""
        known = compared_law(law)
        if known.adaptive:
            raise NoComparisonError(f"{law_words(law)} has a gain of its own")
        return PersistenceSystem(
            decay=known.decay, initial_filter=known.initial_filter, coupling=bounds.coupling
        )
