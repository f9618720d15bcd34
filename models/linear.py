"""The motivating plant: x' = A x + g(t) B u with u = -K x.

Full thrust through windows only: the closed loop is x' = (A - g(t) B K) x, linear with piecewise
polynomial coefficients. Its transition matrix is a Taylor series with an exact recurrence, so no
step-size control is needed and no knot is crossed. Whether the schedule excites persistently is
`intermit.verify.schedule.excitation`'s question, for g is the same.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field
from fractions import Fraction
from itertools import pairwise
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from .floquet import Floquet
from .schedule import Piece, Schedule
from .schedule.polynomial import Coefficients, compose_affine
from .types import Array

TERMS = 24
"""Terms of a step's Taylor series; with |M| h <= 1/2 the remainder is below 1e-30."""


Table = Sequence[Sequence[Fraction | int | float | str]]
Rows = tuple[tuple[Fraction, ...], ...]


@final
@dataclass(frozen=True, eq=False)
class LinearPlant:
    """x' = A x + g(t) B u, u = -K x.

    Attributes
    ----------
    A : (n, n), 1/s
    B : (n, m)
    K : (m, n)
    schedule : Schedule
        Its g is the gain of the input.
    exact : mapping of "A", "B", "K" to rows of fractions
        What proofs take; the floats themselves unless `from_rows` was given other numbers.
    """

    A: Array
    B: Array
    K: Array
    schedule: Schedule
    exact: Mapping[str, Rows] = field(default_factory=dict, kw_only=True)

    @classmethod
    def from_rows(cls, A: Table, B: Table, K: Table, schedule: Schedule) -> LinearPlant:
        """Build from rows of numbers; strings and fractions stay exact."""
        exact = {
            name: tuple(tuple(Fraction(x) for x in row) for row in table)
            for name, table in (("A", A), ("B", B), ("K", K))
        }
        for name, rows in exact.items():
            if not rows or len({len(row) for row in rows}) != 1:
                raise ValueError(f"{name} must have rows of one length, received {[len(r) for r in rows]}")
        first, second, third = (
            np.array([[float(x) for x in row] for row in rows]) for rows in exact.values()
        )
        return cls(first, second, third, schedule, exact=exact)

    def __post_init__(self) -> None:
        for name in ("A", "B", "K"):
            value = np.asarray(getattr(self, name), dtype=float)
            if value.ndim != 2 or not np.isfinite(value).all():
                raise ValueError(f"{name} must be a matrix of finite numbers, received shape {value.shape}")
            object.__setattr__(self, name, value)
        n, m = self.B.shape
        if self.A.shape != (n, n) or self.K.shape != (m, n):
            raise ValueError(
                f"A (n, n), B (n, m) and K (m, n) do not fit: {self.A.shape}, {self.B.shape}, {self.K.shape}"
            )
        if not self.exact:
            rows = {
                name: tuple(tuple(Fraction(x) for x in row) for row in getattr(self, name).tolist())
                for name in ("A", "B", "K")
            }
            object.__setattr__(self, "exact", rows)

    def transition(self, start: Fraction, stop: Fraction) -> Array:
        """Matrix (n, n) that takes x(start) to x(stop), start <= stop, s."""
        total = np.eye(len(self.A))
        if stop == start:
            return total
        for piece in self.schedule.pieces_between(start, stop):
            first, last = max(piece.start, start), min(piece.end, stop)
            total = self._within(piece, first, last) @ total
        return total

    def simulate(self, initial_state: ArrayLike, times: ArrayLike) -> Array:
        """States (n, T) at ascending times (T,), s, from x(times[0])."""
        state = np.asarray(initial_state, dtype=float)
        instants = [Fraction(t) for t in np.asarray(times, dtype=float)]
        if state.shape != (len(self.A),):
            raise ValueError(f"the initial state must have shape ({len(self.A)},), received {state.shape}")
        if any(b < a for a, b in pairwise(instants)):
            raise ValueError("times must ascend")
        states = [state]
        for a, b in pairwise(instants):
            states.append(self.transition(a, b) @ states[-1])
        return np.stack(states, axis=1)

    def floquet(self) -> Floquet:
        """Multipliers and exponents over one period of the schedule.

        Raises
        ------
        ValueError
            If the schedule is not periodic.
        """
        if self.schedule.period is None:
            raise ValueError("Floquet multipliers need a periodic schedule: give it a period")
        period = self.schedule.period
        return Floquet(float(period), self.transition(Fraction(0), period))

    def _within(self, piece: Piece, first: Fraction, last: Fraction) -> Array:
        """Transition within one piece of g, in steps short enough for the series."""
        feedback = self.B @ self.K
        local = piece.local_coefficients()
        gains = sum(abs(float(c)) * float(piece.length) ** j for j, c in enumerate(local))
        size = float(np.linalg.norm(self.A, 2) + gains * np.linalg.norm(feedback, 2))
        count = max(1, int(np.ceil(2 * size * float(last - first))))
        step, total = (last - first) / count, np.eye(len(self.A))
        for i in range(count):
            shifted = compose_affine(local, first + i * step - piece.start, Fraction(1))
            total = _taylor_step(self.A, feedback, shifted, float(step)) @ total
        return total


def _taylor_step(A: Array, feedback: Array, gain: Coefficients, h: float) -> Array:
    """Transition over h of X' = (A - g(tau) F) X: (k+1) X_{k+1} = A X_k - sum_j g_j F X_{k-j}."""
    coefficients = [float(c) for c in gain]
    terms = [np.eye(len(A))]
    for k in range(TERMS):
        forcing = sum(
            (c * terms[k - j] for j, c in enumerate(coefficients) if j <= k), start=np.zeros_like(A)
        )
        terms.append((A @ terms[k] - feedback @ forcing) / (k + 1))
    total = np.zeros_like(A)
    for term in reversed(terms):
        total = total * h + term
    return total
