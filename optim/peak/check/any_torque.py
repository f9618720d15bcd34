"""Feasibility of a torque history from anywhere: a law's own, say, against the transfer it made.

If it is feasible with some peak then the least peak is at most that: the optimum and the law are
judged on the same windows, start, terminal set and time.
"""

from __future__ import annotations

import math
from collections.abc import Callable, Iterable
from dataclasses import dataclass
from itertools import pairwise
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from ....models.types import Array
from ...problem import TransferProblem
from .verify_answer import Excess, rate_function, state_scale, terminal_excess

Torque = Callable[[Array], Array]
"""Times (n,) in s -> torques (n, 3), N m, body frame."""


@final
@dataclass(frozen=True)
class ReplayedTorque:
    """What a torque history does in a transfer.

    Attributes
    ----------
    terminal : Excess
        What is left at the end, and by how much it exceeds the tolerances.
    peak : float
        Largest effort over w, sampled inside the windows: the p it needs.
    outside_torque : float
        Largest |torque| sampled where w = 0, N m.
    """

    terminal: Excess
    peak: float
    outside_torque: float

    def feasible(self, *, terminal: float = 1e-8, torque: float = 1e-12) -> bool:
        """Whether terminal excess (rad) and torque outside the windows (of the peak) are negligible."""
        return self.terminal.worst <= terminal and self.outside_torque <= torque * max(self.peak, 1e-300)


def replay_torque(
    problem: TransferProblem, torque: Torque, *, knots: Iterable[float] = (), samples: int = 400
) -> ReplayedTorque:
    """Integrate a torque history over a transfer.

    Parameters
    ----------
    problem : TransferProblem
        The transfer.
    torque : callable
        Torque at given times.
    knots : iterable of float
        Instants, s, at which the torque is not smooth; those of the windows are known.
    samples : int
        Instants sampled between two knots for the peak.
    """
    from scipy.integrate import solve_ivp

    keep, (state, applied, out, run) = rate_function(problem)
    pieces = list(problem.window.pieces)
    ends = np.array([float(piece.end) for piece in pieces])
    inner = [t for t in knots if 0.0 < t < float(problem.horizon)]
    edges = np.unique(np.concatenate([[float(k) for k in problem.window.knots], inner]))
    atol = 1e-13 * state_scale(problem)
    x, peak, outside = np.r_[problem.unit_attitude, problem.start_rate], 0.0, 0.0
    for start, end in pairwise(edges):

        def field(t: float, x: Array) -> ArrayLike:
            state[:] = x
            applied[:] = torque(np.array([t]))[0]
            run()
            return out.copy()

        x = solve_ivp(field, (start, end), x, method="DOP853", rtol=1e-11, atol=atol).y[:, -1]
        times = start + (end - start) * np.linspace(1e-6, 1 - 1e-6, samples)
        values = np.asarray(torque(times), dtype=float)
        piece = pieces[int(np.searchsorted(ends, (start + end) / 2))]
        if not piece.shape:
            outside = max(outside, float(np.linalg.norm(values, axis=1).max()))
            continue
        s = (times - float(piece.start)) / float(piece.length)
        w = np.polynomial.polynomial.polyval(s, [float(c) for c in piece.shape])
        peak = max(peak, float((problem.norm.peak(values) / w).max()))
    del keep
    return ReplayedTorque(terminal_excess(problem, x), peak if math.isfinite(peak) else math.inf, outside)
