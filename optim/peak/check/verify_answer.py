"""Checks of a torque history, recomputed outside every solver, in the user's units.

The history is integrated again by another method (Dormand and Prince's pair of order 8(5,3),
adaptive, relative tolerance 1e-12 and below) and the terminal state compared with what was asked for. What a
solver said about itself is not used anywhere.
"""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final

import numpy as np

from ....models.schedule import Piece
from ....models.types import Array
from ...problem import TransferProblem
from ..transcription.history import TorqueHistory
from ..transcription.propagate import right_hand_side

TERMINAL_STANDARD = 1e-8
"""Largest terminal excess allowed: rotation angle in rad, rate times the transfer time in rad."""
TERMINAL_SHARE = 1e-6
"""The same as a fraction of the way to go, which is what counts where that is small."""


@final
@dataclass(frozen=True)
class Excess:
    """What a transfer leaves at its end.

    Attributes
    ----------
    attitude_error : float
        Rotation angle left to the target attitude (either quaternion sign), rad.
    rate_error : float
        |w| left, rad/s.
    attitude, rate : float
        What of these exceeds the tolerances asked for; the rate times the transfer time.
    """

    attitude_error: float
    rate_error: float
    attitude: float
    rate: float

    @property
    def worst(self) -> float:
        """Largest of both excesses, rad."""
        return max(self.attitude, self.rate)


def way_to_go(problem: TransferProblem) -> float:
    """Rotation angle to the target and start rate times the transfer time, rad."""
    return problem.angle + float(np.linalg.norm(problem.start_rate)) * float(problem.horizon)


def state_scale(problem: TransferProblem) -> Array:
    """Sizes to which an absolute error of a state (7,) is held: 1 rad, and 1 rad over the transfer time."""
    return np.asarray(np.r_[np.ones(4), np.full(3, 1.0 / float(problem.horizon))])


def terminal_excess(problem: TransferProblem, end: Array) -> Excess:
    """Measure a final state (7,) against the problem's terminal condition."""
    angle = 2.0 * math.atan2(float(np.linalg.norm(end[1:4])), abs(float(end[0])))
    rate = float(np.linalg.norm(end[4:]))
    allowed = 2.0 * math.asin(float(problem.terminal.attitude))
    return Excess(
        attitude_error=angle,
        rate_error=rate,
        attitude=max(0.0, angle - allowed),
        rate=max(0.0, rate - float(problem.terminal.rate)) * float(problem.horizon),
    )


@final
@dataclass(frozen=True)
class ReplayedHistory:
    """A history integrated again.

    Attributes
    ----------
    states : (n + 1, 7)
        Quaternion and rate (rad/s) at the cell edges.
    terminal : Excess
        What is left at the end.
    outside_torque : float
        Largest torque where w = 0, N m.
    effort_excess : float
        How far the peak effort is from covering each cell's torque, relative; <= 0 is right.
    standard : float
        Largest terminal excess allowed, rad.
    """

    states: Array
    terminal: Excess
    outside_torque: float
    effort_excess: float
    evaluations: int
    standard: float = TERMINAL_STANDARD

    @property
    def terminal_excess(self) -> float:
        """Largest of both excesses, rad."""
        return self.terminal.worst

    @property
    def feasible(self) -> bool:
        """Whether the history meets the terminal condition to the standard, inside windows and peak."""
        return not self.faults

    @property
    def faults(self) -> list[str]:
        """What the history fails in, in words; empty if it is feasible."""
        found = []
        if not self.terminal_excess <= self.standard:
            found.append(
                f"the terminal condition is missed by {self.terminal_excess:.1e} rad "
                f"(standard {self.standard:.0e})"
            )
        if self.outside_torque != 0.0:
            found.append(f"there is torque outside the windows, {self.outside_torque:.1e} N m")
        if not self.effort_excess <= 1e-9:
            found.append(f"the torque needs {self.effort_excess:.1e} more than the stated peak")
        return found


def replay(problem: TransferProblem, history: TorqueHistory) -> ReplayedHistory:
    """Integrate a torque history independently and measure what it leaves."""
    pieces = _piece_of_cells(problem, history)
    states, evaluations, _ = _integrate(problem, history, pieces)
    closed = np.array([not piece.shape for piece in pieces])
    peak_needed = problem.norm.peak(history.base_torque[history.open]).max(initial=0.0)
    peak = max(history.peak, 1e-300)
    return ReplayedHistory(
        states=states,
        terminal=terminal_excess(problem, states[-1]),
        outside_torque=float(np.abs(history.base_torque[closed]).max(initial=0.0)),
        effort_excess=float(peak_needed / peak - 1.0) if history.peak > 0 else float(peak_needed),
        evaluations=evaluations,
        standard=min(TERMINAL_STANDARD, TERMINAL_SHARE * way_to_go(problem)) or TERMINAL_STANDARD,
    )


def sample_flight(
    problem: TransferProblem, history: TorqueHistory, points: int = 1200
) -> tuple[Array, Array]:
    """States on a grid of about `points` instants, for plots: times (n,), s, and states (n, 7).

    Every cell has its two ends, just inside, and its share of the points by its length.
    """
    pieces = _piece_of_cells(problem, history)
    lengths = np.diff(history.edges)
    counts = np.maximum(3, np.ceil(points * lengths / lengths.sum())).astype(int)
    inner = [np.clip(np.linspace(0.0, 1.0, n), 1e-9, 1.0 - 1e-9) for n in counts]
    grids = [a + h * s for a, h, s in zip(history.edges, lengths, inner, strict=False)]
    _, _, states = _integrate(problem, history, pieces, grids)
    return np.concatenate(grids), states


def _piece_of_cells(problem: TransferProblem, history: TorqueHistory) -> list[Piece]:
    """Piece of the problem's own window profile in which each cell lies."""
    pieces = list(problem.window.pieces)
    ends = np.array([float(piece.end) for piece in pieces])
    middle = (history.edges[1:] + history.edges[:-1]) / 2
    return [pieces[i] for i in np.searchsorted(ends, middle)]


def _integrate(
    problem: TransferProblem,
    history: TorqueHistory,
    pieces: list[Piece],
    grids: list[Array] | None = None,
) -> tuple[Array, int, Array]:
    """States at the edges, right-hand sides evaluated, and states at the instants of the grids."""
    from scipy.integrate import solve_ivp

    keep, (state, torque, out, run) = rate_function(problem)
    states = [np.r_[problem.unit_attitude, problem.start_rate]]
    evaluations, sampled = 0, [np.zeros((0, 7))]
    atol = 1e-14 * min(1.0, way_to_go(problem) or 1.0) * state_scale(problem)
    for k, base in enumerate(history.base_torque):
        window = _window_function(pieces[k])

        def field(t: float, x: Array, base: Array = base, window: Callable[[float], float] = window) -> Array:
            state[:] = x
            torque[:] = window(t) * base
            run()
            return out.copy()

        span = (float(history.edges[k]), float(history.edges[k + 1]))
        dense = grids is not None
        part = solve_ivp(field, span, states[-1], method="DOP853", rtol=1e-12, atol=atol, dense_output=dense)
        states.append(part.y[:, -1])
        evaluations += int(part.nfev)
        if grids is not None:
            sampled.append(part.sol(grids[k]).T)
    del keep
    return np.array(states), evaluations, np.concatenate(sampled)


def _window_function(piece: Piece) -> Callable[[float], float]:
    """w(t) on one piece, from the problem's exact coefficients."""
    coefficients = [float(c) for c in reversed(piece.shape)]
    start, length = float(piece.start), float(piece.length)
    if len(coefficients) < 2:
        constant = coefficients[0] if coefficients else 0.0
        return lambda _: constant

    def window(t: float) -> float:
        s, value = (t - start) / length, 0.0
        for c in coefficients:
            value = value * s + c
        return value

    return window


def rate_function(problem: TransferProblem) -> tuple[Any, tuple[Array, Array, Array, Any]]:
    """State rate of the body, evaluated in place through fixed buffers."""
    rate = _symbolic_rate()
    buffer, run = rate.buffer()
    state, torque, out = np.zeros(7), np.zeros(3), np.zeros(7)
    J = problem.body.inertia.ravel(order="F").copy()
    J_inverse = problem.body.inverse_inertia.ravel(order="F").copy()
    for index, array in enumerate((state, torque, J, J_inverse)):
        buffer.set_arg(index, array.data)
    buffer.set_res(0, out.data)
    return (rate, buffer, J, J_inverse), (state, torque, out, run)


@lru_cache(maxsize=1)
def _symbolic_rate() -> Any:
    import casadi as ca

    x, torque = ca.SX.sym("x", 7), ca.SX.sym("torque", 3)
    J, J_inverse = ca.SX.sym("J", 3, 3), ca.SX.sym("Ji", 3, 3)
    return ca.Function("rate", [x, torque, J, J_inverse], [right_hand_side(J, J_inverse, x, torque)])
