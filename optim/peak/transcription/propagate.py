"""One step over a cell, exact to the eighth order, with its derivatives: the equality constraints.

The right-hand side is the rigid body's own expressions; the step is the eleven-stage explicit
Runge-Kutta method of order 8 of Cooper and Verner (SIAM J. Numer. Anal. 9, 1972, 389-405),
so that a torque-free arc costs a few steps and the answer survives an independent integration.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property, lru_cache
from typing import Any, final

import numpy as np

from ....models.rigid_body import attitude_rate, momentum_rate
from ....models.types import Array
from .mesh import Mesh
from .scaling import ScaledProblem

R = math.sqrt(21.0)
STAGES: tuple[tuple[float, ...], ...] = (
    (),
    (1 / 2,),
    (1 / 4, 1 / 4),
    (1 / 7, -(7 + 3 * R) / 98, (21 + 5 * R) / 49),
    ((11 + R) / 84, 0, (18 + 4 * R) / 63, (21 - R) / 252),
    ((5 + R) / 48, 0, (9 + R) / 36, (-231 + 14 * R) / 360, (63 - 7 * R) / 80),
    (
        (10 - R) / 42,
        0,
        (-432 + 92 * R) / 315,
        (633 - 145 * R) / 90,
        (-504 + 115 * R) / 70,
        (63 - 13 * R) / 35,
    ),
    (1 / 14, 0, 0, 0, (14 - 3 * R) / 126, (13 - 3 * R) / 63, 1 / 9),
    (1 / 32, 0, 0, 0, (91 - 21 * R) / 576, 11 / 72, -(385 + 75 * R) / 1152, (63 + 13 * R) / 128),
    (
        1 / 14,
        0,
        0,
        0,
        1 / 9,
        -(733 + 147 * R) / 2205,
        (515 + 111 * R) / 504,
        -(51 + 11 * R) / 56,
        (132 + 28 * R) / 245,
    ),
    (
        *(0, 0, 0, 0, (-42 + 7 * R) / 18, (-18 + 28 * R) / 45, -(273 + 53 * R) / 72),
        *((301 + 53 * R) / 72, (28 - 28 * R) / 45, (49 - 7 * R) / 18),
    ),
)
"""Row i: weights of the earlier slopes in stage i."""
NODES: tuple[float, ...] = (
    *(0, 1 / 2, 1 / 2, (7 + R) / 14, (7 + R) / 14, 1 / 2),
    *((7 - R) / 14, (7 - R) / 14, 1 / 2, (7 + R) / 14, 1),
)
WEIGHTS: tuple[float, ...] = (1 / 20, 0, 0, 0, 0, 0, 0, 49 / 180, 16 / 45, 49 / 180, 1 / 20)


def right_hand_side(J: Any, J_inverse: Any, x: Any, torque: Any) -> Any:
    """State rate (b0', bv', w') as one CasADi column, for a torque in the body frame."""
    import casadi as ca

    b0_rate, bv_rate = attitude_rate(x[0], x[1:4], x[4:7])
    return ca.vertcat(b0_rate, bv_rate, J_inverse @ momentum_rate(J, x[4:7], torque))


@lru_cache(maxsize=8)
def step_functions(degree: int) -> tuple[Any, Any]:
    """CasADi functions (state, torque, length, profile, J, J^-1) -> next state, and with derivatives.

    Built once for each degree of the window profile: the inertia is an argument.
    """
    import casadi as ca

    x, torque, h = ca.SX.sym("x", 7), ca.SX.sym("torque", 3), ca.SX.sym("h")
    w = ca.SX.sym("w", degree + 1)
    J, J_inverse = ca.SX.sym("J", 3, 3), ca.SX.sym("Ji", 3, 3)
    slopes: list[Any] = []
    for row, node in zip(STAGES, NODES, strict=True):
        gain: Any = 0
        for i in reversed(range(degree + 1)):
            gain = gain * node + w[i]
        slopes.append(right_hand_side(J, J_inverse, x + h * _combine(row, slopes), gain * torque))
    end = x + h * _combine(WEIGHTS, slopes)
    arguments = [x, torque, h, w, J, J_inverse]
    derivatives = [ca.densify(ca.jacobian(end, x)), ca.densify(ca.jacobian(end, torque))]
    return ca.Function("step", arguments, [end]), ca.Function("linear_step", arguments, derivatives)


def _combine(weights: tuple[float, ...], slopes: list[Any]) -> Any:
    total: Any = 0
    for a, k in zip(weights, slopes, strict=True):
        if a != 0:
            total = total + a * k
    return total


@final
@dataclass(frozen=True)
class Propagator:
    """The scaled body on one mesh: states and derivatives for a torque on each cell."""

    scaled: ScaledProblem
    mesh: Mesh

    @cached_property
    def _shared(self) -> tuple[Any, ...]:
        import casadi as ca

        n = self.mesh.size
        J, J_inverse = ca.DM(self.scaled.inertia), ca.DM(self.scaled.inverse_inertia)
        lengths, profile = ca.DM(self.mesh.lengths).T, ca.DM(self.mesh.profile.T)
        return lengths, profile, ca.repmat(J, 1, n), ca.repmat(J_inverse, 1, n)

    @cached_property
    def _functions(self) -> tuple[Any, Any]:
        step, linear = step_functions(self.mesh.profile.shape[1] - 1)
        return step.mapaccum(self.mesh.size), linear.map(self.mesh.size)

    def states(self, torque: Array) -> Array:
        """States at the edges, (n + 1, 7), from the start, for torque (n, 3) before the factor w."""
        chain = self._functions[0](self.scaled.start, torque.T, *self._shared)
        return np.vstack([self.scaled.start, chain.full().T])

    def derivatives(self, states: Array, torque: Array) -> tuple[Array, Array]:
        """Derivatives of each step by its state (n, 7, 7) and its torque (n, 7, 3)."""
        A, B = self._functions[1](states[:-1].T, torque.T, *self._shared)
        n = self.mesh.size
        return (
            np.ascontiguousarray(A.full().reshape(7, n, 7).transpose(1, 0, 2)),
            np.ascontiguousarray(B.full().reshape(7, n, 3).transpose(1, 0, 2)),
        )

    def map_with_body(self, function: Any, *columns: Array) -> Array:
        """Value of a function (columns..., length, profile, J, J^-1) on every cell, side by side."""
        return np.asarray(function.map(self.mesh.size)(*columns, *self._shared).full())

    def step_errors(self, states: Array, torque: Array) -> Array:
        """Largest difference, cell by cell, between one step and two half steps, (n,)."""
        first, second = (Propagator(self.scaled, half) for half in self.mesh.halves())
        ends = second._single_steps(first._single_steps(states[:-1], torque), torque)
        return np.asarray(np.abs(ends - states[1:]).max(axis=1))

    def _single_steps(self, states: Array, torque: Array) -> Array:
        """End of each cell from the given state at its beginning, (n, 7): cells independent."""
        step, _ = step_functions(self.mesh.profile.shape[1] - 1)
        ends = step.map(self.mesh.size)(states.T, torque.T, *self._shared)
        return np.asarray(ends.full().T)
