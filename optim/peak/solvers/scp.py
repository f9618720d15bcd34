"""The fast solver: a sequence of convex programs, each about the last flight, kept honest by a merit.

Every iterate is a real flight (states are integrated, not variables), so that only six terminal
rows are linearised. A proximal term holds the step where the linearisation is trusted; the
merit value + penalty * violation decides acceptance. At convergence the step is zero, so the
term leaves no trace in the answer.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import final

import numpy as np

from ....models.types import Array
from ..transcription.shooting import Rollout, Sensitivity, Shooting
from .curvature import Curvature, lagrangian_curvature
from .goal import Goal, LeastPeak
from .subproblem import ConeProgram, ConvexStep, Linearisation

SLOW = 8
"""Accepted steps after which second derivatives are worth their cost."""
SLOW_SLACK = 100.0
"""Factor on the gap's tolerance once a run is slow: the checks' own standard is far above it."""


@final
@dataclass(frozen=True)
class LocalAnswer:
    """What a local solver hands over (solver units); nothing in it is evidence before it is checked.

    Attributes
    ----------
    multiplier : (6,)
        Of the terminal residual, normalised as in `optimality`.
    value : float
        What was made least: the peak, or the mean consumption over the window time.
    gap : float
        Relative duality gap of the linearised problem at the flight.
    reason : str
        Empty if converged by the solver's own criteria, else why it stopped.
    """

    shooting: Shooting
    trajectory: Rollout
    sensitivity: Sensitivity
    multiplier: Array
    value: float
    gap: float
    iterations: int
    reason: str = ""
    goal: Goal = field(default_factory=LeastPeak)

    @property
    def peak(self) -> float:
        """Largest effort of the control."""
        return float(self.shooting.scaled.problem.norm.effort(self.trajectory.control).max())

    @property
    def level(self) -> float:
        """Effort of a control that pushes as hard as it may."""
        return self.goal.level(self.value)

    @property
    def converged(self) -> bool:
        """Whether the solver met its own criteria."""
        return not self.reason

    @property
    def violation(self) -> float:
        """Largest terminal violation, solver units."""
        return float(self.shooting.violations(self.trajectory.residual).max())


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

    def solve(
        self,
        shooting: Shooting,
        control: Array,
        *,
        tolerance: float | None = None,
        goal: Goal | None = None,
    ) -> LocalAnswer:
        """Improve a control until it is feasible and locally optimal, or say why not.

        The goal is the least peak unless another is given.
        """
        loop = _Loop(shooting, control, self.damping, goal or LeastPeak())
        standard = self.tolerance if tolerance is None else tolerance
        reason = f"no convergence in {self.max_iterations} convex programs"
        while loop.iterations < self.max_iterations:
            if not loop.advance():
                reason = "no step of the convex program lowers the merit"
                break
            slack = SLOW_SLACK if loop.iterations > 3 * SLOW else 1.0
            if loop.gap <= slack * standard and loop.violation <= standard:
                reason = ""
                break
        return loop.answer(reason)


@final
class _Loop:
    """State of one run: the flight, its sensitivity, and how far the linearisation is trusted."""

    def __init__(self, shooting: Shooting, control: Array, damping: float, goal: Goal) -> None:
        self.shooting, self.goal, norm = shooting, goal, shooting.scaled.problem.norm
        self.trajectory = shooting.fly(control)
        self.size = reference_control(shooting, self.trajectory)
        self.program = ConeProgram(goal, self.size, norm, shooting.weights, shooting.tolerances)
        self.sensitivity = shooting.sensitivity(self.trajectory)
        self.value = goal.value(shooting, self.trajectory.control)
        self.damping, self.penalty = damping, 10.0
        self.multiplier, self.gap = np.zeros(6), np.inf
        self.curvature: Curvature | None = None
        self.iterations = self.accepted = 0

    @property
    def violation(self) -> float:
        """Largest terminal violation of the current flight."""
        return float(self.shooting.violations(self.trajectory.residual).max())

    def advance(self) -> bool:
        """Make one accepted step; False if none lowers the merit."""
        for _ in range(12):
            at = Linearisation(
                self.trajectory.control / self.size,
                self.trajectory.residual,
                self.sensitivity.flat() * self.size,
            )
            step = self._program(at)
            trial = self.shooting.fly(step.control * self.size)
            predicted = self._merit(self.trajectory) - step.value - step.bend - self.penalty * step.slack
            if self.curvature is not None:
                step, trial = self._corrected(at, step, trial)
            ratio = -self._loss(trial) / predicted if predicted > 0 else 0.0
            if ratio >= 0.05 or self._loss(trial) <= 1e-10 * (1.0 + self.penalty * self.violation):
                self._accept(step, trial, ratio)
                return True
            self.damping = max(8.0 * self.damping, 1e-4)
            if self.curvature is None and self.accepted > 1:
                self._bend(step.multiplier)
        return False

    def _program(self, at: Linearisation) -> ConvexStep:
        self.iterations += 1
        return self.program.solve(at, penalty=self.penalty, damping=self.damping, curvature=self.curvature)

    def _corrected(self, at: Linearisation, step: ConvexStep, trial: Rollout) -> tuple[ConvexStep, Rollout]:
        """Second-order correction: the same program with the residual the trial really had."""
        shift = trial.residual - at.derivative @ (step.control - at.control).ravel()
        other = self._program(Linearisation(at.control, shift, at.derivative))
        trajectory = self.shooting.fly(other.control * self.size)
        return (other, trajectory) if self._merit(trajectory) < self._merit(trial) else (step, trial)

    def _merit(self, trajectory: Rollout) -> float:
        value = self.goal.value(self.shooting, trajectory.control) / self.size
        return value + self.penalty * float(self.shooting.violations(trajectory.residual).sum())

    def _loss(self, trial: Rollout) -> float:
        """How much a trial raises the merit."""
        return self._merit(trial) - self._merit(self.trajectory)

    def _accept(self, step: ConvexStep, trial: Rollout, ratio: float) -> None:
        self.trajectory, self.accepted = trial, self.accepted + 1
        self.value = self.goal.value(self.shooting, trial.control)
        self.sensitivity = self.shooting.sensitivity(trial)
        dual, self.multiplier = self.goal.dual(
            self.shooting, trial, self.sensitivity, self.size * step.multiplier
        )
        self.gap = abs(self.value - dual) / max(self.value, 1e-300)
        self.penalty = max(2.0, 3.0 * float(np.abs(step.multiplier).max()), 0.3 * self.penalty)
        self.damping = max(self.damping * (0.1 if ratio > 0.7 else 1.0 if ratio > 0.25 else 4.0), 1e-9)
        if self.curvature is not None or self.accepted > SLOW:
            self._bend(step.multiplier)

    def _bend(self, multiplier: Array) -> None:
        self.curvature = lagrangian_curvature(
            self.shooting, self.trajectory, self.sensitivity, multiplier, self.size
        )

    def answer(self, reason: str) -> LocalAnswer:
        """Hand over the current flight."""
        return LocalAnswer(
            self.shooting,
            self.trajectory,
            self.sensitivity,
            self.multiplier,
            self.value,
            self.gap,
            self.iterations,
            reason,
            self.goal,
        )


def reference_control(shooting: Shooting, trajectory: Rollout) -> float:
    """Size of control that makes peaks near one: what the travel asks for."""
    travel = max(
        float(np.linalg.norm(trajectory.residual[:3])), 2.0 * abs(shooting.scaled.problem.angle), 0.1
    )
    stop = float(np.linalg.norm(shooting.scaled.momentum))
    total = float(shooting.mesh.impulse.sum())
    return (2.0 * travel + stop) / total
