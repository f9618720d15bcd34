"""Comparison system of the adaptive-scaling law, kappa = k, on a body that it does not know.

The law learns from measured quantities alone, with the inertia J0 that it believes in:

    k' = gamma R g^2 (2 - S)(e^2 + 2 a S),      e = |w + zeta|_J0,    w + zeta = x - Phi zeta,

so R and k are not perturbed, but e is bounded through y = |x|_J: e <= m1 y + m2 2 L g^2 sqrt(2) s, with m1
the ratio of the metrics and m2 = |J0^1/2 Phi bv| for |bv| = 1. With k <= kappa <= L, s = sqrt(S), and the
constants of `constants`, bounds obey

    y' >= -kappa g^2 (B1 (1 - S/2) - 2 B3 N) y + kappa^2 g^4 m s     at kappa = k and kappa = L
    s' >= c A(S) y - k g^2 (1 - phi) s (1 - S/2)
    q' <= -c A(Q) y - L g^2 (1 + p) q (1 - Q/2),                     q <= sqrt(S), Q = q^2
    k' <= 2 a gamma r g^2 (2 - S') S'                                at S' = Q and S' = s^2 (concave)
    L' >= gamma U g^2 f,      f >= (2 - S')(e^2 + 2 a S') for Q <= S' <= s^2
    r' <= -lambda r + g^2 (2 - S),    U' >= -lambda U + g^2 (2 - Q)

p bounds bv'Phi bv from above. A disturbance never lets k' stop: with one nothing holds for all time.
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
    ROUND_UP,
    angle_factor,
    at_least_tiny,
    drives_attitude,
    factor_near,
    filter_scale,
    rate_factor,
)
from ..filter.sets import InitialSet
from ..filter.tail import MAX_RATIO, PeriodicSystem, Tail
from ..flow.inequalities import Slope, StatedSystem
from ..flow.stepping import Modes
from .cells import LAST, Cells, cell_of, cells_above
from .constants import Constants
from .system import Repetition, RobustSystem

MIN_ANGLE_SHARE = 0.02
"""A lower bound of s below this share of the upper one is given up: it no longer helps."""
MIN_GAIN_SHARE = 0.01
"""A lower bound of k below this share of lambda may be held while g opens."""
ABOVE_ROUNDING = 1e-11
"""Relative slack of k per second, so that its slope is not lost in the rounding of its value."""
LIMITS = (1.01, 1.05, 1.2, 1.6, 2.5, 5.0)
"""Times its start to which the gain's bound for good is tried."""


@final
class RobustAdaptiveSystem(RobustSystem):
    """Components k, L, y, s, q, r, U of the module's inequalities.

    Parameters
    ----------
    decay, initial_filter : lambda, 1/s, and R(0), s
    learning_rate, weight, initial_gain : gamma, a and k(0)
    constants : the body's constants
    push : D/sqrt(Jmin), rounded up
    """

    names = ("k", "L", "y", "s", "q", "r", "U")
    signs = (-1, 1, 1, 1, -1, -1, 1)
    decaying: tuple[tuple[str, ...], ...] = ()
    floor_component = "r"
    is_binned = True

    def __init__(
        self,
        *,
        decay: Fraction,
        initial_filter: Fraction,
        learning_rate: Fraction,
        weight: Fraction,
        initial_gain: Fraction,
        constants: Constants,
        push: Fraction = Fraction(0),
    ) -> None:
        super().__init__(lam=decay, gamma=learning_rate, a=weight, push=push, **adaptive_numbers(constants))
        self.decay, self.initial_filter, self.constants, self.push = decay, initial_filter, constants, push
        self.learning_rate, self.weight, self.initial_gain = learning_rate, weight, initial_gain
        self.cells = Cells(constants)

    def start(self, initial: InitialSet) -> tuple[float, ...]:
        """Values at t = 0, on the safe side of the initial set."""
        k0, R0 = self.initial_gain, self.initial_filter
        return (
            rounded_down(k0), rounded_up(k0), initial.y_high, initial.s_high, initial.s_low,
            rounded_down(R0), rounded_up(R0),
        )  # fmt: skip

    def repeating(self, gain_limit: float) -> RobustAdaptiveTail:
        """What repeats while k stays below a limit."""
        return RobustAdaptiveTail(
            decay=self.decay,
            learning_rate=self.learning_rate,
            weight=self.weight,
            constants=self.constants,
            gain_limit=gain_limit,
        )

    @staticmethod
    def repeated_state(state: Sequence[float]) -> tuple[float, ...]:
        """Where it begins: k, s and the filter's bounds as they are, no growth of the gain yet."""
        k, _, y, s, _, r, U = state
        return (k, 0.0, y, s, r, U)

    def repetitions(self, last: Mapping[str, float], first: Mapping[str, float]) -> Iterator[Repetition]:
        """Gain limits in turn; none where a disturbance keeps the gain growing, or nothing shrank."""
        if self.push or any(last[name] > MAX_RATIO * first[name] for name in ("y", "s")):
            return
        state = self.repeated_state([last[name] for name in self.names])
        for factor in LIMITS:
            limit = last["L"] * factor

            def accepts(tail: Tail, limit: float = limit) -> bool:
                return (last["L"] + tail.limits["E"]) * ROUND_UP <= limit

            yield Repetition(self.repeating(limit), state, accepts)

    def bounds(self, low: dict[str, Array], high: dict[str, Array]) -> dict[str, Array]:
        """Read the bounds off the components."""
        gain = high["L"] if "L" in high else np.full_like(high["y"], np.inf)
        return {
            "cosine_gap": np.minimum(high["s"] ** 2 * ROUND_UP, 2.0),
            "weighted_rate": high["y"],
            "filter_low": low["r"],
            "filter_high": high["U"],
            "gain_low": low["k"],
            "gain_high": gain,
        }

    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """Whether the lower bound of s is kept; how to bound f; the cell of S and the factor; k held last."""
        k, L, y, s, q, _, _ = state
        if s * s >= ATTITUDE_BOUND_LOST:
            return ()
        tangent = factor_near(s, self.floats.c * y * sqrt(1.0 - 0.5 * s * s), length)
        if not tangent:
            return ()
        keeps = ("kept", "zero") if q > MIN_ANGLE_SHARE * s else ("zero",)
        if peak == 0.0:
            return tuple((keep, "split", f"{LAST}", tangent) for keep in keeps)
        n = self.floats
        square = (n.m1 * y + n.m2 * 2.8285 * L * peak * s) ** 2
        top, split = 2 * n.a * (1 + square / (4 * n.a)) ** 2, (2 - q * q) * (square + 2 * n.a * s * s)
        tops = ["top", "split"] if top < split else ["split", "top"]
        cells = cells_above(s * s)
        learns: list[Modes] = [(), ("held",)] if k < MIN_GAIN_SHARE * n.lam else [()]
        return tuple(
            (keep, f, f"{cell}", tangent, *held)
            for cell in cells
            for keep in keeps
            for held in learns
            for f in tops
        )

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Give up the lower bound of s where it no longer helps; keep upper ones off underflow."""
        k, L, y, s, q, r, U = state
        s = at_least_tiny(s)
        y = drives_attitude(y, s, self.floats.lam / self.floats.c)
        return (k, L, y, s, 0.0 if modes[0] == "zero" else q, r, U)

    def slopes(self, G: Any, x: Sequence[Any], modes: Modes, n: Any) -> dict[str, Slope]:
        """State the module's inequalities."""
        k, L, y, s, q, r, U = x
        S, Q = s * s, q * q
        whirl, m = self.cells.of(cell_of(modes))
        square = measured_square(G, L, y, s, n)
        if modes[1] == "top":
            crest = 1 + square / (4 * n.a)
            f = 2 * n.a * (crest * crest)
        else:
            f = (2 - Q) * (square + 2 * n.a * S)
        learnt = 2 * n.a * n.gamma * r * G
        slopes: dict[str, Slope] = {
            "k": tuple(learnt * (2 - T) * T for T in (Q, S)),
            "L": n.gamma * U * G * f,
            "y": pushed_rates(G, (k, L), y, s, whirl, m, n),
            "s": n.c * y * rate_factor(S, modes[3]) - k * G * (1 - n.phi) * (1 - S / 2) * s,
            "r": -n.lam * r + G * (2 - S),
            "U": -n.lam * U + G * (2 - Q),
        }
        if modes[0] == "kept":
            slopes["q"] = -n.c * y * angle_factor(Q) - L * G * (1 + n.p) * (1 - Q / 2) * q
        return slopes

    def signs_of(self, x: Sequence[Any], modes: Modes, n: Any) -> Iterator[Any]:
        """Every component >= 0, s <= sqrt 2, the lower bound of s zero or kept, S within the step's cell."""
        del n
        k, L, y, s, q, r, U = x
        yield from (k, L, y, s, q, r, U, 2 - s * s)
        if modes[0] == "zero":
            yield -q
        yield from self.cells.within(cell_of(modes), s * s)

    def pushed(
        self, slopes: Mapping[str, float], state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Push each by `slack` times its own scale; k may be held."""
        k, L, y, s, q, r, U = state
        n, outward = self.floats, slack * peak
        _, m = (float(v) for v in self.cells.of(cell_of(modes)))
        square = measured_square(peak, L, y, s, n)
        learning = n.gamma * U * 2.0 * (square + 2 * n.a * s * s)
        rise = outward * learning + ABOVE_ROUNDING * peak * (L + n.lam)
        fall = outward * 2 * n.a * n.gamma * r * 2.0 * s * s + ABOVE_ROUNDING * peak * (k + n.lam)
        return (
            0.0 if "held" in modes else slopes["k"] - fall,
            slopes["L"] + rise,
            slopes["y"] + outward * (L + n.lam) * (y + L * peak * m * s) + slack * n.push,
            slopes["s"] + outward * (L + n.lam) * s + slack * 0.1 * n.c * y,
            slopes["q"] - outward * (L + n.lam) * q - slack * 0.1 * n.c * y if "q" in slopes else 0.0,
            slopes["r"] - slack * filter_scale(n.lam * r, peak),
            slopes["U"] + slack * (n.lam * U + peak),
        )


@final
class RobustAdaptiveTail(StatedSystem, PeriodicSystem):
    """A period that repeats: k held, (y, s) scaled down together, E what the gain grows over the first.

    The gain stays below a limit that the caller holds E/(1 - theta^2) against.
    """

    names = ("k", "E", "y", "s", "r", "U")
    signs = (-1, 1, 1, 1, -1, 1)
    decaying: tuple[tuple[str, ...], ...] = (("y", "s"),)
    free: tuple[str, ...] = ("E",)

    def __init__(
        self,
        *,
        decay: Fraction,
        learning_rate: Fraction,
        weight: Fraction,
        constants: Constants,
        gain_limit: float,
    ) -> None:
        super().__init__(
            lam=decay, gamma=learning_rate, a=weight, push=0, L=gain_limit, **adaptive_numbers(constants)
        )
        self.decay, self.gain_limit, self.cells = decay, gain_limit, Cells(constants)

    def limits(
        self, start: Mapping[str, float], end: Mapping[str, float], ratios: Mapping[str, float]
    ) -> dict[str, float]:
        """What the gain grows over all later time, a geometric series, and its limit."""
        del start
        theta = ratios["s"]
        growth = end["E"] * ROUND_UP / (1.0 - theta * theta * ROUND_UP)
        return {"E": growth, "L": self.gain_limit}

    def choices(self, state: Sequence[float], peak: float, length: float = 0.0) -> Sequence[Modes]:
        """The cell of S alone."""
        del length
        s = state[3]
        if s * s >= ATTITUDE_BOUND_LOST:
            return ()
        cells = cells_above(s * s)
        return tuple(("tail", "split", f"{cell}") for cell in (cells if peak else [LAST]))

    def loosened(self, state: Sequence[float], modes: Modes) -> tuple[float, ...]:
        """Keep upper bounds off underflow."""
        del modes
        k, E, y, s, r, U = state
        s = at_least_tiny(s)
        return (k, E, drives_attitude(y, s, self.floats.lam / self.floats.c), s, r, U)

    def slopes(self, G: Any, x: Sequence[Any], modes: Modes, n: Any) -> dict[str, Slope]:
        """State the module's inequalities, with A(S) = 1, Q = 0 and the gain between k and its limit."""
        k, _, y, s, r, U = x
        S = s * s
        whirl, m = self.cells.of(cell_of(modes))
        return {
            "k": 0,
            "E": 2 * n.gamma * U * G * (measured_square(G, n.L, y, s, n) + 2 * n.a * S),
            "y": pushed_rates(G, (k, n.L), y, s, whirl, m, n),
            "s": n.c * y - k * G * (1 - n.phi) * (1 - S / 2) * s,
            "r": -n.lam * r + G * (2 - S),
            "U": -n.lam * U + 2 * G,
        }

    def signs_of(self, x: Sequence[Any], modes: Modes, n: Any) -> Iterator[Any]:
        """Every component >= 0, s <= sqrt 2, S within the step's cell, the gain's limit above k."""
        k, E, y, s, r, U = x
        yield from (k, E, y, s, r, U, 2 - s * s, n.L - k)
        yield from self.cells.within(cell_of(modes), s * s)

    def pushed(
        self, slopes: Mapping[str, float], state: Sequence[float], modes: Modes, peak: float, slack: float
    ) -> tuple[float, ...]:
        """Push each by `slack` times its own scale."""
        _, E, y, s, r, U = state
        n, outward = self.floats, slack * peak
        _, m = (float(v) for v in self.cells.of(cell_of(modes)))
        intake = 2.0 * n.gamma * U * (measured_square(peak, n.L, y, s, n) + 2 * n.a * s * s)
        return (
            0.0,
            slopes["E"] + outward * intake + ABOVE_ROUNDING * peak * (E + n.lam),
            slopes["y"] + outward * (n.L + n.lam) * (y + n.L * peak * m * s),
            slopes["s"] + outward * (n.L + n.lam) * s + slack * 0.1 * n.c * y,
            slopes["r"] - slack * filter_scale(n.lam * r, peak),
            slopes["U"] + slack * (n.lam * U + peak),
        )


def adaptive_numbers(c: Constants) -> dict[str, Fraction]:
    """The constants that both systems take."""
    return {
        "c": c.coupling, "B1": c.damping, "phi": c.braking, "p": c.accelerating,
        "m1": c.metric_ratio, "m2": c.measured_mismatch,
    }  # fmt: skip


def measured_square(G: Any, L: Any, y: Any, s: Any, n: Any) -> Any:
    """Bound of e^2 = |w + zeta|^2 in the believed inertia: 2 sqrt 2 < 2.8285."""
    e = n.m1 * y + n.m2 * DOUBLE_ROOT * L * G * s
    return e * e


DOUBLE_ROOT = Fraction(28285, 10000)
"""At least 2 sqrt 2."""


def pushed_rates(
    G: Any, gains: tuple[Any, Any], y: Any, s: Any, whirl: Fraction, m: Fraction, n: Any
) -> tuple[Any, Any]:
    """The greatest y' at both ends of the gain: it is convex in it."""
    room = n.B1 * (1 - s * s / 2) - whirl
    first, last = (k * G * (k * G * m * s - room * y) + n.push for k in gains)
    return first, last
