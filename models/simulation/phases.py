"""Phases of a run: stretches of time in which every known signal is one polynomial.

No integration crosses a schedule knot or a law's reset instant: g is only C1 there, and a
high-order method that steps over a kink loses its order, or the whole window.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import lru_cache
from itertools import pairwise
from typing import Any, final

import casadi as ca
import numpy as np

from ..apart import apart
from ..closed_loop import ClosedLoop
from ..laws import Law
from ..schedule import Schedule
from ..schedule.polynomial import ZERO, Coefficients
from ..types import Array


@final
@dataclass(frozen=True)
class Phase:
    """One phase.

    Attributes
    ----------
    start, end : Fraction, s
    origin : Fraction, s; the signals' local time is tau = t - origin
    coefficients : tuple of (g, signals...) coefficient tuples in tau, lowest power first
    resets : whether the law decides anew at `start`
    """

    start: Fraction
    end: Fraction
    origin: Fraction
    coefficients: tuple[Coefficients, ...]
    resets: bool = False

    @property
    def is_torque_free(self) -> bool:
        """Whether g is identically zero in the phase."""
        return self.coefficients[0] == ZERO

    def coefficient_array(self, degree: int) -> Array:
        """Coefficients as floats, padded to the given degree, (signals, degree + 1)."""
        table = np.zeros((len(self.coefficients), degree + 1))
        for row, values in zip(table, self.coefficients, strict=True):
            row[: len(values)] = [float(v) for v in values]
        return table


def phases_between(schedule: Schedule, law: Law, start: Fraction, stop: Fraction) -> tuple[Phase, ...]:
    """Split [start, stop] at the schedule's knots and the law's reset instants.

    Raises
    ------
    ValueError
        If stop <= start.
    """
    if stop <= start:
        began, ended = apart(start, stop)
        raise ValueError(f"a run must end after it starts: start {began} s, end {ended} s")
    instants = sorted(set(law.reset_instants(schedule, start, stop)))
    result: list[Phase] = []
    for piece in schedule.pieces_between(start, stop):
        signals = (piece.local_coefficients(), *(s.on_piece(schedule, piece) for s in law.signals))
        first, last = max(piece.start, start), min(piece.end, stop)
        cuts = [first, *(t for t in instants if first < t < last), last]
        for a, b in pairwise(cuts):
            result.append(Phase(a, b, piece.start, signals, resets=a in instants))
    return tuple(result)


def signal_degree(phases: tuple[Phase, ...]) -> int:
    """Largest degree of any signal in any phase."""
    return max((len(c) - 1 for phase in phases for c in phase.coefficients), default=0)


def phase_arguments(loop: ClosedLoop, degree: int) -> tuple[Any, Any, Any]:
    """Symbols (tau, coefficients) and the loop's time vector as polynomials of tau.

    `coefficients` is SX (signals, degree + 1); the third value replaces `loop.time`.
    """
    tau = ca.SX.sym("tau")
    count = loop.time.shape[0] // 2
    coefficients = ca.SX.sym("c", count, degree + 1)
    entries = []
    for i in range(count):
        value, rate = ca.SX(0), ca.SX(0)
        for j in range(degree, -1, -1):
            rate = rate * tau + value
            value = value * tau + coefficients[i, j]
        entries += [value, rate]
    return tau, coefficients, ca.vertcat(*entries)


@lru_cache(maxsize=64)
def phase_field(loop: ClosedLoop, degree: int) -> Any:
    """CasADi function (tau, state, coefficients, parameters, body) -> state rate."""
    tau, coefficients, time = phase_arguments(loop, degree)
    (rate,) = ca.substitute([loop.state_rate], [loop.time], [time])
    arguments = [tau, loop.state, coefficients, loop.parameters, loop.body]
    return ca.Function("phase_field", arguments, [rate])
