"""Comparison system of the persistence-filter law on a body that it does not know.

kappa = 1/R lies between K and L, and x = w + F zeta of `constants` takes the place of Omega. The filter
obeys R' = -lambda R + g^2 (2 - S) exactly, whatever the body: only w' is uncertain. With a = g^2 kappa,
y = |x|_J, s = sqrt(S), n = |bv| <= N and a disturbance torque of at most D, d = D/sqrt(Jmin), bounds obey

    y' >= -kappa g^2 (B1 (1 - S/2) - 2 B3 N) y + kappa^2 g^4 m s + d     at kappa = K and kappa = L
    s' >= c A(S) y - K g^2 (1 - phi) s (1 - S/2)
    L' >= lambda L - g^2 L^2 (2 - S)

B1 damping, B3 gyroscopic, phi braking, m forcing. The right side is convex in kappa, so its ends decide.
In z = s sqrt(R/R0), v = y sqrt(R/R0) (R' adds (-lambda/2 + a (1 - S/2)) times them):

    v' >= -(lambda/2) v + L g^2 (max(0, 1 - B1) + 2 B3 N) v + L^2 g^4 m z + W d
    z' >= -(lambda/2) z + c v (1 - R0 K z^2/4) + L g^2 phi z,        S = z^2 R0 kappa <= R0 L z^2

    W' >= -(lambda/2) W + g^2/(R0 W),                                W >= sqrt(R/R0).

N and m are taken at a bound of S that holds throughout a step (its cell).
With nothing uncertain these are the inequalities of `filter.persistence`.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from fractions import Fraction
from math import sqrt
from typing import Any, final

import numpy as np

from ...models.types import Array
from ..exact.rounding import rounded_down, rounded_up
from ..filter.comparison import (
    ATTITUDE_BOUND_LOST,
    NO_BOUND,
    ROUND_UP,
    at_least_tiny,
    drives_attitude,
    factor_near,
    filter_scale,
    rate_factor,
)
from ..filter.sets import InitialSet
from ..filter.tail import MAX_RATIO
from ..flow.inequalities import Slope
from ..flow.stepping import Modes
from .cells import LAST, Cells, cell_of, cells_above
from .constants import Constants
from .system import Repetition, RobustSystem

NO_CASCADE = 1e6
"""A value of v and z that stands for no bound."""
MAX_CASCADE = 1e3
"""Above this bound of S the pair v, z is given up: it grows without end where 1 - B1 outweighs lambda."""
BOTH, ANGLE, CASCADE = "both", "angle", "cascade"
"""Which pairs of bounds are kept: (y, s) and (v, z), the first alone, the second alone."""


@final
class RobustPersistenceSystem(RobustSystem):
    """Components K, L, y, s, v, z, W, r of the module's inequalities.

    Parameters
    ----------
    decay : lambda, 1/s
    initial_filter : R(0), s
    constants : the body's constants
    push : D/sqrt(Jmin), rounded up
    scalable : drop the factors A(S) and 1 - S/4, so that (y, s, v, z) may be scaled down together
    pairs : pairs of bounds of angle and rate that may be used
    """

    names = ("K", "L", "y", "s", "v", "z", "W", "r")
    signs = (-1, 1, 1, 1, 1, 1, 1, -1)
    floor_component = "r"

    def __init__(
        self,
        *,
        decay: Fraction,
        initial_filter: Fraction,
        constants: Constants,
        push: Fraction = Fraction(0),
        scalable: bool = False,
        pairs: str = BOTH,
    ) -> None:
        c = constants
        excess = max(Fraction(0), 1 - c.damping)
        super().__init__(
            lam=decay, R0=initial_filter, c=c.coupling, B1=c.damping, phi=c.braking, push=push, excess=excess
        )
        self.decay, self.initial_filter, self.constants, self.push = decay, initial_filter, constants, push
        self.scalable, self.pairs = scalable, pairs
        held = {BOTH: (("y", "s"), ("v", "z")), ANGLE: (("y", "s"),), CASCADE: (("v", "z"),)}[pairs]
        self.decaying: tuple[tuple[str, ...], ...] = () if push else held
        self.free = tuple({"y", "s", "v", "z"} - {name for pair in held for name in pair})
        self.cells = Cells(constants)

    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """Values at t = 0, on the safe side of the initial set."""
        y, s, R0 = initial.y_high, initial.s_high, self.initial_filter
        return (rounded_down(1 / R0), rounded_up(1 / R0), y, s, y, s, 1.0, rounded_down(R0))

    def repeating(self, pairs: str) -> RobustPersistenceSystem:
        """The system of a part that repeats, with these pairs of bounds alone."""
        return RobustPersistenceSystem(
            decay=self.decay,
            initial_filter=self.initial_filter,
            constants=self.constants,
            push=self.push,
            scalable=not self.push,
            pairs=pairs,
        )

    def repetitions(self, last: Mapping[str, float], first: Mapping[str, float]) -> Iterator[Repetition]:
        """Both pairs of bounds, then each alone, where what must shrink did so over the period before."""
        state = tuple(last[name] for name in self.names)
        for pairs in (BOTH, ANGLE, CASCADE):
            system = self.repeating(pairs)
            if all(last[name] <= MAX_RATIO * first[name] for pair in system.decaying for name in pair):
                yield Repetition(system, state)

    def _kept(self, state: Sequence[float]) -> str:
        """The pairs that still say something in this state."""
        _, L, _, s, _, z, _, _ = state
        if self.pairs != BOTH:
            return self.pairs
        if s * s >= ATTITUDE_BOUND_LOST:
            return CASCADE
        return ANGLE if z >= NO_CASCADE or self.floats.R0 * L * z * z >= MAX_CASCADE else BOTH

    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Take the better of the two bounds of angle and rate, of those that are kept."""
        r = np.maximum(low["r"], 0.0)
        gain = np.minimum(ROUND_UP / r, high["L"])
        share = self.floats.R0 * gain * ROUND_UP
        s, y, z, v = high["s"], high["y"], high["z"], high["v"]
        y = np.where(s < NO_BOUND, y, np.inf)  # given up with s: nothing bounds it on such a step
        z, v = (np.where(high["z"] < NO_CASCADE, x, np.inf) for x in (z, v))
        angle = np.where((s < NO_BOUND) | np.isinf(s), s**2, 2.0)
        return {
            "cosine_gap": np.minimum(angle, z**2 * share) * ROUND_UP,
            "weighted_rate": np.minimum(y, v * np.sqrt(share)) * ROUND_UP,
            "filter_low": r,
            "filter_high": ROUND_UP / low["K"],
            "gain_low": low["K"],
            "gain_high": gain,
        }

    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """Which bound of the angle r and L use, best now first, the cell of S, and the tangent."""
        _, L, y, s, _, z, _, r = state
        if r < 0.0 or (self.pairs == ANGLE and s * s >= ATTITUDE_BOUND_LOST):
            return ()
        pairs = self._kept(state)
        drift = self.floats.c * y * sqrt(max(1.0 - 0.5 * s * s, 0.0))
        tangent = "1" if pairs == CASCADE else factor_near(s, drift, length)
        if not tangent:
            return ()
        if peak == 0.0:
            return ((pairs, "none", f"{LAST}", tangent),)
        bounds = {ANGLE: s * s, CASCADE: self.floats.R0 * L * z * z}
        ways = sorted((way for way in bounds if pairs in (BOTH, way)), key=bounds.__getitem__)
        filters = [way for way in ways if bounds[way] < 2.0] or ["none"]
        filters += [way for way in ways if way not in filters]
        best = ways[0]
        cells = cells_above(bounds[best])
        return tuple(
            (pairs, f, f"{best} {cell}" if cell < LAST else f"{LAST}", tangent)
            for cell in cells
            for f in filters
        )

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Give up s where its bound has reached sqrt 2; keep upper bounds off underflow."""
        K, L, y, s, v, z, W, r = state
        if modes[0] == CASCADE:
            s = NO_BOUND
        elif modes[0] == ANGLE:
            v = z = NO_CASCADE
        s, z, scale = at_least_tiny(s), at_least_tiny(z), self.floats.lam / self.floats.c
        return (K, L, drives_attitude(y, s, scale), s, drives_attitude(v, z, scale), z, W, r)

    def slopes(self, G: Any, x: Sequence[Any], modes: Modes, n: Any) -> dict[str, Slope]:
        """State the module's inequalities."""
        K, L, y, s, v, z, W, r = x
        lam, R0, S, a = n.lam, n.R0, s * s, L * G
        whirl, m = self.cells.of(cell_of(modes))
        sigma = {"none": 2, ANGLE: S, CASCADE: R0 * L * z * z}[modes[1]]
        slopes: dict[str, Slope] = {
            "K": lam * K - 2 * G * K * K,
            "L": lam * L - G * L * L * (2 - sigma),
            "W": -lam * W / 2 + G / R0 / W,
            "r": -lam * r + G * (2 - (R0 * z * z / r if modes[1] == CASCADE else sigma)),
        }
        if modes[1] == "none":
            slopes |= {"L": lam * L, "r": -lam * r}
        if modes[0] != CASCADE:
            room = n.B1 * (1 - S / 2) - whirl
            slopes["y"] = tuple(k * G * (k * G * m * s - room * y) + n.push for k in (K, L))
            drift = n.c * y if self.scalable else n.c * y * rate_factor(S, modes[3])
            slopes["s"] = drift - K * G * (1 - n.phi) * (1 - S / 2) * s
        if modes[0] != ANGLE:
            bend = 1 if self.scalable else 1 - R0 * K * z * z / 4
            slopes["v"] = -lam * v / 2 + a * (n.excess + whirl) * v + a * a * m * z + n.push * W
            slopes["z"] = -lam * z / 2 + n.c * v * bend + a * n.phi * z
        return slopes

    def signs_of(self, x: Sequence[Any], modes: Modes, n: Any) -> Iterator[Any]:
        """Every component >= 0, s <= sqrt 2 or given up, S within the step's cell."""
        K, L, y, s, v, z, W, r = x
        yield from (K, L, y, z, v, W, r)
        if modes[0] == CASCADE:
            yield s - NO_BOUND
        else:
            yield from (2 - s * s, s)
        yield from self.cells.within(
            cell_of(modes), s * s if modes[2].startswith(ANGLE) else z * z * L * n.R0
        )

    def pushed(
        self, slopes: Mapping[str, float], state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Push each by `slack` times its own scale, r and L by what keeps r > 0 after a long off-time."""
        K, L, y, s, v, z, W, r = state
        n, outward = self.floats, slack * peak
        whirl, m = (float(x) for x in self.cells.of(cell_of(modes)))
        scale = n.lam * r if modes[1] == "none" else filter_scale(n.lam * r, peak)
        push = {
            "K": -slack * (n.lam * K + 2.0 * peak * K * K),
            "L": slack * L * L * filter_scale(n.lam / L, peak),
            "y": outward * L * (y + L * peak * m * s) + slack * n.push,
            "s": outward * K * s + slack * 0.1 * n.c * y,
            "v": slack * (0.5 * n.lam * v + n.push * W)
            + outward * L * ((n.excess + whirl) * v + L * peak * m * z),
            "z": slack * 0.5 * (n.lam * z + n.c * v) + outward * L * n.phi * z,
            "W": slack * 0.5 * n.lam * W + outward / (n.R0 * W),
            "r": -slack * scale,
        }
        return tuple(float(slopes[name]) + push[name] if name in slopes else 0.0 for name in self.names)
