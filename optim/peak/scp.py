"""The fast solver: a sequence of convex programs, each about the last flight, kept honest by a merit.

Every iterate is a real flight (states are integrated, not variables), so that only six terminal
rows are linearised. A proximal term holds the step where the linearisation is trusted; the
merit peak + penalty * violation decides acceptance. At convergence the step is zero, so the
term leaves no trace in the answer.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from .optimality import dual_value
from .shooting import Flight, Sensitivity, Shooting
from .subproblem import ConeProgram, Linearisation

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class LocalAnswer:
    """What a local solver hands over (solver units); nothing in it is evidence before it is checked.

    Attributes
    ----------
    multiplier : (6,)
        Of the terminal residual, normalised as in `optimality`.
    gap : float
        Relative duality gap of the linearised problem at the flight.
    reason : str
        Empty if converged by the solver's own criteria, else why it stopped.
    """

    shooting: Shooting
    flight: Flight
    sensitivity: Sensitivity
    multiplier: Array
    peak: float
    gap: float
    iterations: int
    reason: str = ""

    @property
    def converged(self) -> bool:
        """Whether the solver met its own criteria."""
        return not self.reason

    @property
    def violation(self) -> float:
        """Largest terminal violation, solver units."""
        return float(self.shooting.violations(self.flight.residual).max())


@final
@dataclass(frozen=True, kw_only=True)
class SequentialConvex:
    """Options of the fast solver.

    Attributes
    ----------
    tolerance : float
        On the relative duality gap and on the terminal violation (rad, and rad per transfer time).
    max_iterations : int
        Convex programs at most.
    damping : float
        First proximal weight, relative to the peak.
    """

    tolerance: float = 1e-9
    max_iterations: int = 60
    damping: float = 0.1

    @property
    def name(self) -> str:
        """Name in the record."""
        return "sequential convex program"

    def __post_init__(self) -> None:
        if not 0 < self.tolerance < 1:
            raise ValueError(f"tolerance must be in (0, 1), received {self.tolerance:g}")
        if self.max_iterations < 1:
            raise ValueError(f"max_iterations must be >= 1, received {self.max_iterations}")

    def solve(self, shooting: Shooting, control: Array, *, tolerance: float | None = None) -> LocalAnswer:
        """Improve a control until it is feasible and locally optimal, or say why not."""
        tolerance = self.tolerance if tolerance is None else tolerance
        norm = shooting.scaled.problem.norm
        flight = shooting.fly(control)
        reference = reference_control(shooting, flight)
        program = ConeProgram(norm, shooting.cells, shooting.weights, shooting.tolerances)
        sensitivity = shooting.sensitivity(flight)
        peak, damping, penalty = float(norm.effort(flight.control).max()), self.damping, 10.0
        multiplier, gap, reason = (
            np.zeros(6),
            np.inf,
            f"no convergence in {self.max_iterations} convex programs",
        )
        rejected = 0
        iteration = 0
        while iteration < self.max_iterations:
            iteration += 1
            at = Linearisation(flight.control / reference, flight.residual, sensitivity.flat() * reference)
            step = program.solve(at, penalty=penalty, damping=damping)
            if not np.all(np.isfinite(step.control)):
                reason = "the convex program failed"
                break
            penalty = max(2.0, 3.0 * float(np.abs(step.multiplier).max()), 0.3 * penalty)
            trial = shooting.fly(step.control * reference)
            trial_peak = float(norm.effort(trial.control).max())
            before = peak / reference + penalty * shooting.violations(flight.residual).sum()
            after = trial_peak / reference + penalty * shooting.violations(trial.residual).sum()
            predicted = before - step.peak - penalty * step.slack
            ratio = (before - after) / predicted if predicted > 0 else 0.0
            noise = 1e-10 * (1.0 + before)
            if ratio < 0.05 and before - after < -noise:
                damping, rejected = max(8.0 * damping, 1e-3), rejected + 1
                if rejected > 12:
                    reason = "no step of the convex program lowers the merit"
                    break
                continue
            rejected = 0
            flight, peak = trial, trial_peak
            sensitivity = shooting.sensitivity(flight)
            dual, multiplier = dual_value(shooting, flight, sensitivity, step.multiplier)
            gap = abs(peak - dual) / max(peak, 1e-300)
            if gap <= tolerance and shooting.violations(flight.residual).max() <= tolerance:
                reason = ""
                break
            damping = damping * (0.1 if ratio > 0.7 else 1.0 if ratio > 0.25 else 4.0)
        return LocalAnswer(shooting, flight, sensitivity, multiplier, peak, gap, iteration, reason)


def reference_control(shooting: Shooting, flight: Flight) -> float:
    """Size of control that makes peaks near one: what the travel asks for."""
    travel = max(float(np.linalg.norm(flight.residual[:3])), 2.0 * abs(shooting.scaled.problem.angle), 0.1)
    stop = float(np.linalg.norm(shooting.scaled.momentum))
    total = float(shooting.mesh.impulse.sum())
    return (2.0 * travel + stop) / total
