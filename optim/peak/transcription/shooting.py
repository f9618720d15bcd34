"""From a control to where it leads: states, terminal residual, and the residual's derivative.

Both solvers and every check after them look at a control through this one object.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np

from ....models.types import Array
from .mesh import Mesh
from .propagate import Propagator
from .scaling import ScaledProblem
from .terminal import residual, residual_derivative


@final
@dataclass(frozen=True)
class Rollout:
    """A control and the trajectory it makes (solver units).

    Attributes
    ----------
    control : (n open cells, m)
    torque : (n cells, 3)
        Torque before the factor w; zero on closed cells.
    states : (n cells + 1, 7)
    residual : (6,)
        Rotation vector and rate left at the end.
    """

    control: Array
    torque: Array
    states: Array
    residual: Array


@final
@dataclass(frozen=True)
class Sensitivity:
    """Derivatives about one flight.

    Attributes
    ----------
    terminal : (6, n open cells, m)
        Derivative of the residual by each control: the integral over the cell of w times the
        response to a torque impulse.
    response : (6, n cells + 1, m)
        Derivative of the residual by an impulse of control at each edge: the switching function
        is its combination by the multipliers.
    steps, inputs : (n cells, 7, 7), (n cells, 7, 3)
        Derivatives of each step by its state and by its torque.
    adjoint : (n cells + 1, 6, 7)
        Derivative of the residual by the state at each edge.
    """

    terminal: Array
    response: Array
    steps: Array
    inputs: Array
    adjoint: Array

    def flat(self) -> Array:
        """Terminal derivative as a matrix, (6, n m)."""
        return self.terminal.reshape(6, -1)


@final
@dataclass(frozen=True)
class Shooting:
    """One scaled problem on one mesh, for one target sign."""

    scaled: ScaledProblem
    mesh: Mesh
    sign: int

    @cached_property
    def propagator(self) -> Propagator:
        """Steps over the cells."""
        return Propagator(self.scaled, self.mesh)

    @property
    def tolerances(self) -> tuple[float, float]:
        """Largest rotation angle and rate left, solver units; 0 for exactly."""
        return self.scaled.attitude_tolerance, self.scaled.rate_tolerance

    @cached_property
    def cells(self) -> int:
        """Number of open cells."""
        return int(self.mesh.open.sum())

    @cached_property
    def weights(self) -> Array:
        """Share of the window integral in each open cell, (n,), sum 1."""
        share = self.mesh.impulse[self.mesh.open]
        return np.asarray(share / share.sum())

    @np.errstate(over="ignore", invalid="ignore")  # a wild trial may leave the numbers; it is refused
    def fly(self, control: Array) -> Rollout:
        """Trajectory of a control (one-sided thrust is clipped at zero)."""
        control = self.scaled.problem.norm.clipped(control)
        torque = np.zeros((self.mesh.size, 3))
        torque[self.mesh.open] = control @ self.scaled.control_matrix.T
        states = self.propagator.states(torque)
        return Rollout(control, torque, states, residual(states[-1], self.sign))

    @np.errstate(over="ignore", invalid="ignore")
    def sensitivity(self, trajectory: Rollout) -> Sensitivity:
        """Derivative of the terminal residual, by one sweep backwards over the cells."""
        A, B = self.propagator.derivatives(trajectory.states, trajectory.torque)
        E = residual_derivative(trajectory.states[-1], self.sign)
        n = self.mesh.size
        adjoint = np.empty((n + 1, 6, 7))
        adjoint[n] = E
        for k in range(n - 1, -1, -1):
            E = E @ A[k]
            adjoint[k] = E
        is_open = self.mesh.open
        lever = self.scaled.control_matrix
        terminal = (adjoint[1:][is_open] @ B[is_open]) @ lever
        response = adjoint[:, :, 4:] @ (self.scaled.inverse_inertia @ lever)
        return Sensitivity(
            np.ascontiguousarray(terminal.transpose(1, 0, 2)),
            np.ascontiguousarray(response.transpose(1, 0, 2)),
            steps=A,
            inputs=B,
            adjoint=adjoint,
        )

    def violations(self, residual_: Array) -> Array:
        """How far each part of the terminal condition is missed: components, or excess over the balls."""
        parts = []
        for block, tolerance in enumerate(self.tolerances):
            part = residual_[3 * block : 3 * block + 3]
            parts.append(
                np.abs(part) if tolerance == 0 else np.array([max(0.0, np.linalg.norm(part) - tolerance)])
            )
        return np.concatenate(parts)
