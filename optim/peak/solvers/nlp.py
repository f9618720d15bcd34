"""The reference solver: direct collocation of the whole transfer, solved by IPOPT with exact derivatives.

Everything is different from the fast solver on purpose: states are variables, each cell carries
a collocation polynomial at three Gauss points (order 6, and the quaternion's norm is kept
exactly), and the effort limit is a smooth constraint. Only the mesh and the body are shared.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from ....models.norms import Norm
from ....models.types import Array
from ....verify.solver_status import SolverStatus, ipopt_status
from ..transcription.propagate import right_hand_side
from ..transcription.shooting import Rollout, Shooting
from ..transcription.terminal import residual_derivative
from .optimality import dual_value
from .scp import LocalAnswer, reference_control

POINTS = 3
"""Gauss points in a cell."""


@final
@dataclass(frozen=True, kw_only=True)
class NonlinearProgram:
    """Options of the reference solver.

    Attributes
    ----------
    tolerance : float
        IPOPT's tolerance, in solver units.
    max_iterations : int
        Interior-point iterations at most.
    """

    tolerance: float = 1e-10
    max_iterations: int = 400

    def __post_init__(self) -> None:
        if not 0 < self.tolerance < 1:
            raise ValueError(f"tolerance must be in (0, 1), received {self.tolerance:g}")
        if self.max_iterations < 1:
            raise ValueError(f"max_iterations must be >= 1, received {self.max_iterations}")

    @property
    def name(self) -> str:
        """Name in the record."""
        return "nonlinear program"

    def solve(self, shooting: Shooting, control: Array, *, tolerance: float | None = None) -> LocalAnswer:
        """Local optimum near the flight of a control, or the reason for there being none."""
        trajectory = shooting.fly(control)
        size = reference_control(shooting, trajectory)
        transcription = _Transcription(shooting, size)
        z, multiplier, status, iterations = transcription.solve(
            trajectory, tolerance=min(self.tolerance, tolerance or 1.0), max_iterations=self.max_iterations
        )
        landed = shooting.fly(transcription.control(z))
        landed = _landed(shooting, landed)
        sensitivity = shooting.sensitivity(landed)
        peak = float(shooting.scaled.problem.norm.effort(landed.control).max())
        multiplier = transcription.terminal_multiplier(multiplier, landed)
        dual, multiplier = dual_value(shooting, landed, sensitivity, multiplier)
        gap = abs(peak - dual) / max(peak, 1e-300)
        reason = "" if status.is_usable else f"IPOPT {status.value}"
        return LocalAnswer(shooting, landed, sensitivity, multiplier, peak, gap, iterations, reason)


def _landed(shooting: Shooting, trajectory: Rollout) -> Rollout:
    """Remove the collocation error left at the terminal by Newton steps of least weighted size."""
    exact = np.repeat([t == 0.0 for t in shooting.tolerances], 3)
    for _ in range(3):
        if not exact.any() or np.abs(trajectory.residual[exact]).max() < 1e-11:
            break
        G = shooting.sensitivity(trajectory).flat()[exact]
        weight = np.repeat(1.0 / shooting.weights, trajectory.control.shape[1])
        change = weight * (
            G.T @ np.linalg.lstsq((G * weight) @ G.T, trajectory.residual[exact], rcond=None)[0]
        )
        trajectory = shooting.fly(trajectory.control - change.reshape(trajectory.control.shape))
    return trajectory


def _gauss() -> tuple[Array, Array, Array]:
    """Nodes (s,) of Gauss collocation on [0, 1], and of the polynomial through 0 and the nodes its
    derivative at the nodes (s, s + 1) and its value at 1 (s + 1,), both by its values.
    """
    nodes = np.polynomial.legendre.leggauss(POINTS)[0] / 2 + 0.5
    power = np.arange(POINTS + 1)
    coefficients = np.linalg.inv(np.r_[0.0, nodes][:, None] ** power)
    slopes = power[1:] * nodes[:, None] ** power[:-1]
    return nodes, slopes @ coefficients[1:], coefficients.sum(axis=0)


def _along(cells: int, block: Array) -> Any:
    """Sparse matrix with a block for every cell on its diagonal."""
    import casadi as ca

    return ca.kron(ca.DM.eye(cells), ca.DM(block))


@final
class _Transcription:
    """The nonlinear program of one shooting problem, in variables scaled to about one.

    A cell's polynomial is carried by the states at its nodes, so that every row is linear but for
    the body's own right-hand side at one node: that keeps the Jacobian and the Hessian as sparse
    as the equations of motion, and a factorisation costs half of what it does in slopes.
    """

    def __init__(self, shooting: Shooting, size: float) -> None:
        import casadi as ca

        self.shooting, self.size = shooting, size
        scaled, mesh = shooting.scaled, shooting.mesh
        n, self.m = mesh.size, scaled.control_matrix.shape[1]
        self.cells = shooting.cells
        X = ca.MX.sym("X", 7, n + 1)
        S = ca.MX.sym("S", 7, POINTS * n)
        V = ca.MX.sym("V", self.m, self.cells)
        p = ca.MX.sym("p")
        self.nodes, slope, last = _gauss()
        defects = X[:, :-1] @ _along(n, slope[:, :1].T) + S @ _along(n, slope[:, 1:].T)
        defects -= self._rates(S, V) @ ca.diag(ca.DM(np.repeat(mesh.lengths, POINTS)))
        ends = X[:, :-1] * last[0] + S @ _along(n, last[1:, None]) - X[:, 1:]
        rows = [ca.vec(defects), ca.vec(ends)]
        lower = [np.zeros(7 * POINTS * n), np.zeros(7 * n)]
        upper = [np.zeros(7 * POINTS * n), np.zeros(7 * n)]
        self.terminal_start = 7 * (POINTS + 1) * n
        for part, low, high in [*self._terminal(X[:, -1]), *_effort_rows(scaled.problem.norm, V, p)]:
            rows.append(part)
            lower.append(low)
            upper.append(high)
        self.lower, self.upper = np.concatenate(lower), np.concatenate(upper)
        self.program = {"x": ca.vertcat(ca.vec(X), ca.vec(S), ca.vec(V), p), "f": p, "g": ca.vertcat(*rows)}
        self.counts = (7 * (n + 1), 7 * POINTS * n, self.m * self.cells)

    def _rates(self, S: Any, V: Any) -> Any:
        """State rates at every node of every cell, (7, POINTS n)."""
        import casadi as ca

        scaled, mesh = self.shooting.scaled, self.shooting.mesh
        x, torque = ca.SX.sym("x", 7), ca.SX.sym("torque", 3)
        J, J_inverse = ca.DM(scaled.inertia), ca.DM(scaled.inverse_inertia)
        rate = ca.Function("rate", [x, torque], [right_hand_side(J, J_inverse, x, torque)])
        window = np.stack([mesh.window_at(float(s)) for s in self.nodes], axis=1)
        place = (
            _selector(mesh.open) @ _along(mesh.size, np.ones((1, POINTS))) @ ca.diag(ca.DM(window.ravel()))
        )
        lever = ca.MX(ca.DM(scaled.control_matrix * self.size))
        return rate.map(POINTS * mesh.size)(S, lever @ V @ place)

    def _terminal(self, end: Any) -> list[tuple[Any, Array, Array]]:
        """Rows for the attitude and the rate at the end: components, or squared lengths."""
        import casadi as ca

        attitude, rate = self.shooting.tolerances
        limits = (np.sin(attitude / 2.0), rate)
        rows = []
        for part, limit in zip((end[1:4], end[4:7]), limits, strict=True):
            if limit == 0.0:
                rows.append((part, np.zeros(3), np.zeros(3)))
            else:
                rows.append((ca.sumsqr(part) / limit**2, np.array([-np.inf]), np.array([1.0])))
        return rows

    def solve(
        self, trajectory: Rollout, *, tolerance: float, max_iterations: int
    ) -> tuple[Array, Array, SolverStatus, int]:
        """Run IPOPT from a flight; returns variables, row multipliers, how it ended, iterations."""
        import casadi as ca

        options: dict[str, Any] = {
            "print_time": False,
            "ipopt": {
                "print_level": 0,
                "sb": "yes",
                "tol": tolerance,
                "constr_viol_tol": 1e-10,
                "compl_inf_tol": 1e-10,
                "acceptable_iter": 0,
                "max_iter": max_iterations,
                "linear_solver": "mumps",
                "mu_strategy": "adaptive",
                "mumps_pivot_order": 0,
            },
        }
        solver = ca.nlpsol("peak", "ipopt", self.program, options)
        total = sum(self.counts) + 1
        low, high = np.full(total, -np.inf), np.full(total, np.inf)
        low[:7] = high[:7] = self.shooting.scaled.start
        low[-1] = 0.0
        answer = solver(x0=self._start(trajectory), lbx=low, ubx=high, lbg=self.lower, ubg=self.upper)
        stats = solver.stats()
        z, multiplier = answer["x"].full().ravel(), answer["lam_g"].full().ravel()
        return z, multiplier, ipopt_status(str(stats["return_status"])), int(stats["iter_count"])

    def _start(self, trajectory: Rollout) -> Array:
        """Variables of a flight: states at the nodes from the chord of each cell."""
        chord = np.diff(trajectory.states, axis=0)
        inner = trajectory.states[:-1, None, :] + self.nodes[:, None] * chord[:, None, :]
        control = trajectory.control / self.size
        peak = float(self.shooting.scaled.problem.norm.effort(control).max())
        return np.concatenate(
            [
                trajectory.states.ravel(),
                inner.ravel(),
                control.ravel(),
                [1.05 * peak + 1e-3],
            ]
        )

    def control(self, z: Array) -> Array:
        """Controls of the variables, solver units, (n open cells, m)."""
        first = self.counts[0] + self.counts[1]
        return np.asarray(z[first : first + self.counts[2]].reshape(self.cells, self.m) * self.size)

    def terminal_multiplier(self, multiplier: Array, landed: Rollout) -> Array:
        """Multiplier of the rotation-vector residual from IPOPT's of the terminal rows."""
        import casadi as ca

        end = ca.MX.sym("end", 7)
        rows = [part for part, _, _ in self._terminal(end)]
        slope = ca.Function("slope", [end], [ca.jacobian(ca.vertcat(*rows), end)])(landed.states[-1]).full()
        costate = slope.T @ multiplier[self.terminal_start : self.terminal_start + len(slope)]
        E = residual_derivative(landed.states[-1], self.shooting.sign)
        return np.asarray(np.linalg.lstsq(E.T, costate, rcond=None)[0])


def _selector(is_open: NDArray[np.bool_]) -> Any:
    """Sparse matrix (open cells, cells) that puts the controls at their places among all cells."""
    import casadi as ca

    cells = [int(k) for k in np.flatnonzero(is_open)]
    return ca.DM.triplet(list(range(len(cells))), cells, ca.DM.ones(len(cells)), len(cells), len(is_open))


def _effort_rows(norm: Norm, V: Any, p: Any) -> list[tuple[Any, Array, Array]]:
    """Rows for effort(v_k) <= p, p >= 0 being a bound."""
    import casadi as ca

    rows: list[Any] = []
    for block, at in norm.parts:
        part = V if block.size == V.shape[0] else V[at, :]
        if block.is_round:
            rows.append(p**2 - ca.sum1(part**2).T)
        else:
            wide = ca.vec(part)
            rows += [p - wide, wide if block.is_one_sided else p + wide]
    return [(row, np.zeros(row.numel()), np.full(row.numel(), np.inf)) for row in rows]
