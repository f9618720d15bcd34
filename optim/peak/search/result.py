"""What `minimum_peak` returns: the history, the checks it passed, and how hard it was searched."""

from __future__ import annotations

from dataclasses import dataclass
from enum import Enum
from typing import final

from ....models.types import Array
from ...problem import TransferProblem
from ..check.verify_answer import ReplayedHistory
from ..transcription.history import TorqueHistory


class Standing(Enum):
    """How far an answer can be relied upon.

    CHECKED: every residual, recomputed outside the solver, meets its standard.
    UNDECIDED: some does not; the answer carries the reason and the next step.
    IMPOSSIBLE: no torque whatever makes this transfer, for the reason given.
    """

    CHECKED = "CHECKED"
    UNDECIDED = "UNDECIDED"
    IMPOSSIBLE = "IMPOSSIBLE"


@final
@dataclass(frozen=True)
class Start:
    """One start of the search and the local optimum it led to, on the coarse mesh.

    Attributes
    ----------
    sign : int
        Target quaternion sign.
    seed : int or None
        Seed of the random bend; None for the plain guess.
    peak : float
        Peak reached, in the norm's unit; inf if the start led nowhere.
    converged : bool
    """

    sign: int
    seed: int | None
    peak: float
    converged: bool
    iterations: int


@final
@dataclass(frozen=True)
class Search:
    """All starts of one search."""

    starts: tuple[Start, ...]

    @property
    def local_optima(self) -> tuple[float, ...]:
        """Distinct peaks the starts converged to, ascending (within a thousandth: one mesh, one optimum)."""
        found: list[float] = []
        for peak in sorted(s.peak for s in self.starts if s.converged):
            if not found or peak > found[-1] * (1 + 1e-3):
                found.append(peak)
        return tuple(found)

    @property
    def spread(self) -> float:
        """Worst over best local optimum, less one; 0 if all starts agree."""
        found = self.local_optima
        return found[-1] / found[0] - 1.0 if found and found[0] > 0 else 0.0


@final
@dataclass(frozen=True)
class Switching:
    """Costates made ready to plot, in the user's units.

    Attributes
    ----------
    times : (n, q)
        Instants, s, on each of n open cells.
    sigma : (n, q, m)
        Switching function: where component j is positive, control j should be at its upper limit.
        Normalised so that the integral of w support(sigma) over the windows is 1 (unit 1/s).
    switch_times : tuple of (float, int)
        Instants, s, at which component j of the best control changes sides (Euclidean: the
        direction swings round; j = -1).
    costate_times : (c + 1,)
        Cell edges, s.
    costate : (c + 1, 7)
        Derivative of -(multiplier . terminal residual) by the state (quaternion, rate in rad/s) at the
        edges, in the same normalisation; free of any choice of units but the second and radian.
    residual : float
        Integral of w (p support(sigma) - sigma . control) / p: 0 where Pontryagin's condition holds.
    """

    times: Array
    sigma: Array
    switch_times: tuple[tuple[float, int], ...]
    costate_times: Array
    costate: Array
    residual: float


@final
@dataclass(frozen=True)
class PeakAnswer:
    """Least peak found for a transfer, with everything that was checked about it.

    Attributes
    ----------
    peak : float
        Peak of the returned history (the norm's unit): an upper bound on the least peak, not a
        proof that none lower exists (a certified lower bound is a separate computation).
    optimality_gap : float
        Relative duality gap of the problem linearised about the answer: stationarity and
        complementarity in one number, >= 0, recomputed from the answer.
    mesh_gap : float
        Estimated fraction by which infinitely fine cells would still lower the peak.
    """

    problem: TransferProblem
    standing: Standing
    peak: float
    sign: int
    history: TorqueHistory | None
    flown: ReplayedHistory | None
    switching: Switching | None
    optimality_gap: float
    mesh_gap: float
    defect: float
    solver: str
    iterations: int
    rounds: int
    search: Search
    reason: str = ""
    next_step: str = ""

    @property
    def impulse(self) -> float:
        """Integral of the consumption of the returned history: length, sum of axes or of forces."""
        return self.history.impulse if self.history is not None else float("nan")

    @property
    def cells(self) -> int:
        """Number of open cells of the returned history."""
        return int(self.history.open.sum()) if self.history is not None else 0
