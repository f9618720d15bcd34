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

from collections.abc import Iterator, Sequence
from fractions import Fraction
from math import ceil, exp
from typing import final

import numpy as np

from ...models.types import Array
from ..exact.bernstein import Bernstein
from ..exact.rational import rational
from ..exact.rounding import rounded_down, rounded_up
from ..filter.comparison import (
    ATTITUDE_BOUND_LOST,
    NO_BOUND,
    ROUND_UP,
    angle_factor,
    at_least_tiny,
    drives_attitude,
    filter_scale,
)
from ..filter.flowpipe import LawComparison
from ..filter.sets import InitialSet
from ..flow.stepping import Modes
from .constants import CELLS, Constants, cell_end, greatest_n

ONE, TWO = Bernstein.constant(1), Bernstein.constant(2)
WIDER = (1.03, 1.2, 1.7)
"""Factors by which the bound of S at a step's start is taken for the whole step, in turn."""
LAST = CELLS - 1
NO_CASCADE = 1e6
"""A value of v and z that stands for no bound."""
MAX_CASCADE = 1e3
"""Above this bound of S the pair v, z is given up: it grows without end where 1 - B1 outweighs lambda."""
BOTH, ANGLE, CASCADE = "both", "angle", "cascade"
"""Which pairs of bounds are kept: (y, s) and (v, z), the first alone, the second alone."""


@final
class RobustPersistenceSystem(LawComparison):
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
        self.decay, self.initial_filter, self.constants, self.push = decay, initial_filter, constants, push
        self.scalable, self.pairs = scalable, pairs
        held = {BOTH: (("y", "s"), ("v", "z")), ANGLE: (("y", "s"),), CASCADE: (("v", "z"),)}[pairs]
        self.decaying: tuple[tuple[str, ...], ...] = () if push else held
        self.free = tuple({"y", "s", "v", "z"} - {name for pair in held for name in pair})
        self._lam, self._R0 = float(decay), float(initial_filter)
        c = constants
        self._c_float, self._push_float = float(c.coupling), float(push)
        self._B1, self._phi = float(c.damping), float(c.braking)
        self._excess = max(Fraction(0), 1 - c.damping)
        self._cells: dict[int, tuple[float, float, float]] = {}
        self._lam_exact, self._R0_exact = rational(decay), rational(initial_filter)

    def _floats(self, cell: int) -> tuple[float, float, float]:
        """2 B3 N, m and the excess of v's rate at a cell, in floats."""
        if cell not in self._cells:
            whirl = 2 * self.constants.gyroscopic * greatest_n(cell_end(cell))
            self._cells[cell] = (
                float(whirl), float(self.constants.forcing(cell)), float(self._excess + whirl)
            )  # fmt: skip
        return self._cells[cell]

    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """Values at t = 0, on the safe side of the initial set."""
        y, s, R0 = initial.y_high, initial.s_high, self.initial_filter
        return (rounded_down(1 / R0), rounded_up(1 / R0), y, s, y, s, 1.0, rounded_down(R0))

    def tail(self, state: Sequence[float]) -> tuple[RobustPersistenceSystem, tuple[float, ...]]:
        """Return the same inequalities without the factors that a scaling would break."""
        return self.repeating(self._kept(state)), tuple(state)

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

    def _kept(self, state: Sequence[float]) -> str:
        """The pairs that still say something in this state."""
        _, L, _, s, _, z, _, _ = state
        if self.pairs != BOTH:
            return self.pairs
        if s * s >= ATTITUDE_BOUND_LOST:
            return CASCADE
        return ANGLE if self._R0 * L * z * z >= MAX_CASCADE else BOTH

    def contraction(self, period: float) -> float:
        """exp(-lambda T): what R forgets over a period."""
        return exp(-self._lam * period)

    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Take the better of the two bounds of angle and rate; s = inf asks for the second alone."""
        r = np.maximum(low["r"], 0.0)
        gain = np.minimum(ROUND_UP / r, high["L"])
        share = self._R0 * gain * ROUND_UP
        s = high["s"]
        angle = np.where((s < NO_BOUND) | np.isinf(s), s**2, 2.0)
        return {
            "cosine_gap": np.minimum(angle, high["z"] ** 2 * share) * ROUND_UP,
            "weighted_rate": np.minimum(high["y"], high["v"] * np.sqrt(share)) * ROUND_UP,
            "filter_low": r,
            "filter_high": ROUND_UP / low["K"],
            "gain_low": low["K"],
            "gain_high": gain,
        }

    def choices(self, state: Sequence[float], peak: float) -> Sequence[Modes]:
        """Which bound of the angle r and L use, best now first, and the cell of S for the whole step."""
        _, L, _, s, _, z, _, r = state
        if r < 0.0 or (self.pairs == ANGLE and s * s >= ATTITUDE_BOUND_LOST):
            return ()
        pairs = self._kept(state)
        if peak == 0.0:
            return ((pairs, "none", f"{LAST}"),)
        bounds = {ANGLE: s * s, CASCADE: self._R0 * L * z * z}
        ways = sorted((way for way in bounds if pairs in (BOTH, way)), key=bounds.__getitem__)
        filters = [way for way in ways if bounds[way] < 2.0] or ["none"]
        filters += [way for way in ways if way not in filters]
        best = ways[0]
        cells = {min(LAST, max(0, ceil(bounds[best] * wider * CELLS / 2))) for wider in WIDER} | {LAST}
        return tuple(
            (pairs, f, f"{best} {cell}" if cell < LAST else f"{LAST}")
            for cell in sorted(cells)
            for f in filters
        )

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Give up s where its bound has reached sqrt 2; keep upper bounds off underflow."""
        K, L, y, s, v, z, W, r = state
        if modes[0] == CASCADE:
            s = NO_BOUND
        elif modes[0] == ANGLE:
            v = z = NO_CASCADE
        s, z, scale = at_least_tiny(s), at_least_tiny(z), self._lam / self._c_float
        return (K, L, drives_attitude(y, s, scale), s, drives_attitude(v, z, scale), z, W, r)

    def rate(
        self, gain_square: float, state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Floats; each bound pushed outwards by `slack` times its own scale."""
        K, L, y, s, v, z, W, r = state
        lam, c, R0, G, push = self._lam, self._c_float, self._R0, gain_square, self._push_float
        whirl, m, excess = self._floats(cell_of(modes))
        S = s * s
        outward = slack * peak
        K_rate = lam * K - 2.0 * G * K * K - slack * (lam * K + 2.0 * peak * K * K)
        sigma = {"none": 2.0, "angle": S, "cascade": R0 * L * z * z}[modes[1]]
        L_rate = lam * L - G * L * L * (2.0 - sigma) + slack * L * L * filter_scale(lam / L, peak)
        if modes[0] == CASCADE:
            y_rate = s_rate = 0.0
        else:
            room = self._B1 * (1.0 - 0.5 * S) - whirl
            y_rate = max(-k * G * room * y + (k * G) ** 2 * m * s for k in (K, L)) + push
            y_rate += outward * L * (y + L * peak * m * s) + slack * push
            factor = 1.0 if self.scalable else angle_factor(S)
            pull = K * G * (1.0 - self._phi) * (1.0 - 0.5 * S)
            s_rate = c * y * factor - pull * s + outward * K * s + slack * 0.1 * c * y
        if modes[0] == ANGLE:
            v_rate = z_rate = 0.0
        else:
            v_rate = -0.5 * lam * v * (1.0 - slack) + L * G * excess * v + (L * G) ** 2 * m * z
            v_rate += outward * L * (excess * v + L * peak * m * z)
            if push:
                v_rate += (1.0 + slack) * push * W
            bend = 1.0 if self.scalable else 1.0 - 0.25 * R0 * K * z * z
            z_rate = -0.5 * lam * z * (1.0 - slack) + c * v * bend + L * G * self._phi * z
            z_rate += slack * 0.5 * c * v + outward * L * self._phi * z
        W_rate = -0.5 * lam * W * (1.0 - slack) + (G + outward) / (R0 * W)
        sigma = {"none": 2.0, "angle": S, "cascade": R0 * z * z / r}[modes[1]]
        r_rate = -lam * r + G * (2.0 - sigma) - slack * filter_scale(lam * r, peak)
        if modes[1] == "none":
            r_rate = -lam * r * (1.0 + slack)
        return (K_rate, L_rate, y_rate, s_rate, v_rate, z_rate, W_rate, r_rate)

    def conditions(
        self, gain_square: Bernstein, x: Sequence[Bernstein], dx: Sequence[Bernstein], modes: Modes
    ) -> Iterator[Bernstein]:
        """Polynomials >= 0 iff every bound holds; the signs and the cell of S among them."""
        K, L, y, s, v, z, W, r = x
        dK, dL, dy, ds, dv, dz, dW, dr = dx
        G, lam, c = gain_square, self._lam_exact, rational(self.constants.coupling)
        cell = cell_of(modes)
        m = rational(self.constants.forcing(cell))
        whirl = rational(2 * self.constants.gyroscopic * greatest_n(cell_end(cell)))
        phi, push = rational(self.constants.braking), rational(self.push)
        half = rational(Fraction(1, 2))
        yield K
        yield L
        yield y
        yield z
        yield v
        yield r
        yield K * lam - G * K * K * 2 - dK
        yield W
        yield W * (dW + W * half * lam) - G * (1 / self._R0_exact)
        yield from self._cell(cell, s, z, L, modes)
        if modes[0] != CASCADE:
            S = s * s
            yield TWO - S
            yield s
            room = (ONE - S * half) * rational(self.constants.damping) - ONE * whirl
            for kappa in (K, L):
                a = kappa * G
                yield dy + a * room * y - a * a * s * m - ONE * push
            drift = y if self.scalable else y * angle_factor(S)
            yield ds - drift * c + K * G * (ONE - S * half) * s * (1 - phi)
        else:
            yield dy
            yield s - ONE * rational(NO_BOUND)
        if modes[0] == ANGLE:
            yield dv
            yield dz
        else:
            excess = rational(self._excess) + whirl
            a = L * G
            forced = v * half * lam * -1 + a * v * excess + a * a * z * m
            bend = ONE if self.scalable else ONE - K * z * z * self._R0_exact * rational(Fraction(1, 4))
            if push:
                forced = forced + W * push
            yield dv - forced
            yield dz + z * half * lam - v * bend * c - a * z * phi
        yield from self._filter(G, s, z, L, r, (dL, dr), modes[1])

    def _cell(self, cell: int, s: Bernstein, z: Bernstein, L: Bernstein, modes: Modes) -> Iterator[Bernstein]:
        """S <= the upper end of the cell throughout the step; the last cell's is 2."""
        if cell == LAST:
            return
        end = ONE * rational(cell_end(cell))
        yield end - (s * s if modes[2].startswith("angle") else z * z * L * self._R0_exact)

    def _filter(
        self,
        G: Bernstein,
        s: Bernstein,
        z: Bernstein,
        L: Bernstein,
        r: Bernstein,
        slopes: tuple[Bernstein, Bernstein],
        mode: str,
    ) -> Iterator[Bernstein]:
        dL, dr = slopes
        lam, R0 = self._lam_exact, self._R0_exact
        if mode == "none":
            yield -dr - r * lam
            yield dL - L * lam
        elif mode == "angle":
            intake = G * (TWO - s * s)
            yield intake - r * lam - dr
            yield dL - L * lam + intake * L * L
        else:
            yield G * (r * 2 - z * z * R0) - r * (r * lam + dr)  # multiplied by r > 0
            yield dL - L * lam + G * (TWO - z * z * L * R0) * L * L


def cell_of(modes: Modes) -> int:
    """The cell of S whose upper end bounds it throughout a step in these modes."""
    return int(modes[2].split()[-1])
