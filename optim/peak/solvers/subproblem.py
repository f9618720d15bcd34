"""The convex step: least peak (or impulse) for the transfer linearised about the current control.

    minimise    value + penalty * slack + (damping / 2) sum_k weight_k |v_k - v0_k|^2 + curvature
    subject to  residual + G (v - v0) within the terminal set, up to the slack
                effort(v_k) <= p on every open cell, p being the value or a given limit

The slack makes the program feasible whatever the linearisation says (an exact penalty); the
effort cones are kept whole, not linearised. Solved by Clarabel's interior point method.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from ....models.norms import Norm
from ....models.types import Array
from .curvature import Curvature
from .effort_cones import effort_cones
from .goal import Goal


@final
@dataclass(frozen=True)
class Linearisation:
    """A control (n, m) on the open cells, the residual (6,) it leads to, and its derivative (6, n m)."""

    control: Array
    residual: Array
    derivative: Array


@final
@dataclass(frozen=True)
class ConvexStep:
    """Answer of one convex program.

    Attributes
    ----------
    control : (n, m)
    value, slack, bend : float
        What is made least, terminal slack, and the curvature term at the answer.
    multiplier : (6,)
        Of the terminal rows, so that `multiplier @ derivative` is minus the switching function.
    """

    control: Array
    value: float
    slack: float
    bend: float
    multiplier: Array


@final
class ConeProgram:
    """Sparse pattern and effort cones for n cells of one goal, one norm and one terminal set."""

    def __init__(
        self, goal: Goal, size: float, norm: Norm, weights: Array, tolerances: tuple[float, float]
    ) -> None:
        import clarabel
        import scipy.sparse as sparse

        self.cells, self.m = len(weights), norm.control_matrix.shape[1]
        self.tolerances = tolerances
        self.exact = [block for block in (0, 1) if tolerances[block] == 0.0]
        self.ball = [block for block in (0, 1) if tolerances[block] > 0.0]
        self.n_control = self.cells * self.m
        self.n_slack = 6 * len(self.exact) + len(self.ball)
        effort = effort_cones(goal, size, norm, weights)
        self.effort, self.first_slack = effort, self.n_control + effort.extras
        self.size = self.first_slack + self.n_slack
        self.weights = np.repeat(weights, self.m)
        slack = sparse.csc_matrix(
            (-np.ones(self.n_slack), (range(self.n_slack), range(self.first_slack, self.size))),
            shape=(self.n_slack, self.size),
        )
        empty = sparse.csc_matrix((len(effort.rhs), self.n_slack))
        rows = sparse.hstack([effort.on_control, effort.on_extra, empty])
        self._fixed = sparse.vstack([slack, rows]).tocsc()
        self._fixed_rhs = np.r_[np.zeros(self.n_slack), effort.rhs]
        self._cones = [clarabel.NonnegativeConeT(self.n_slack), *effort.cones]

    def solve(
        self, at: Linearisation, *, penalty: float, damping: float, curvature: Curvature | None = None
    ) -> ConvexStep:
        """Solve the convex program at one linearisation, curvature included."""
        import clarabel
        import scipy.sparse as sparse

        n = self.n_control
        centre = at.control.ravel()
        extra = 0 if curvature is None else len(curvature.values)
        exact_rows, exact_rhs = self._exact_rows(at.derivative, at.residual)
        ball_rows, ball_rhs = self._ball_rows(at.derivative, at.residual)
        A = sparse.vstack([sparse.csc_matrix(exact_rows), self._fixed, sparse.csc_matrix(ball_rows)])
        # the variables are changes of control: the rows are the same with v0 + z in the place of v
        fixed_rhs = self._fixed_rhs - self._fixed[:, :n] @ centre
        b = np.concatenate([exact_rhs, fixed_rhs, ball_rhs])
        cones = [clarabel.ZeroConeT(len(exact_rhs)), *self._cones]
        cones += [clarabel.SecondOrderConeT(4) for _ in self.ball]
        diagonal = np.r_[damping * self.weights, np.zeros(self.size - n)]
        price = np.r_[self.effort.control_price, self.effort.extra_price]
        q = np.r_[price, np.full(self.n_slack, penalty)]
        bend = 0.0
        if curvature is not None and extra:
            along = sparse.hstack(
                [
                    sparse.csc_matrix(curvature.rows),
                    sparse.csc_matrix((extra, self.size - n)),
                    -sparse.identity(extra),
                ]
            )
            A = sparse.vstack([sparse.hstack([A, sparse.csc_matrix((A.shape[0], extra))]), along])
            b = np.concatenate([b, np.zeros(extra)])
            cones.append(clarabel.ZeroConeT(extra))
            diagonal, q = np.r_[diagonal, curvature.values], np.r_[q, np.zeros(extra)]
        solver = clarabel.DefaultSolver(sparse.diags(diagonal).tocsc(), q, A.tocsc(), b, cones, _settings())
        answer = solver.solve()
        z, dual = np.array(answer.x), np.array(answer.z)
        if curvature is not None and extra:
            bend = float(curvature.values @ (curvature.rows @ z[:n]) ** 2) / 2
        return ConvexStep(
            control=at.control + z[:n].reshape(self.cells, self.m),
            value=float(price @ z[: self.first_slack] + self.effort.control_price @ centre),
            bend=bend,
            slack=float(np.maximum(z[self.first_slack : self.size], 0.0).sum()),
            multiplier=self._multiplier(dual, len(b) - extra),
        )

    def _exact_rows(self, G: Array, residual: Array) -> tuple[Array, Array]:
        rows = np.zeros((3 * len(self.exact), self.size))
        for i, block in enumerate(self.exact):
            rows[3 * i : 3 * i + 3, : self.n_control] = G[3 * block : 3 * block + 3]
            start = self.first_slack + 6 * i
            rows[3 * i : 3 * i + 3, start : start + 3] = np.eye(3)
            rows[3 * i : 3 * i + 3, start + 3 : start + 6] = -np.eye(3)
        rhs = [-residual[3 * block : 3 * block + 3] for block in self.exact]
        return rows, np.concatenate(rhs) if rhs else np.zeros(0)

    def _ball_rows(self, G: Array, residual: Array) -> tuple[Array, Array]:
        rows, rhs = np.zeros((4 * len(self.ball), self.size)), np.zeros(4 * len(self.ball))
        for i, block in enumerate(self.ball):
            rows[4 * i, self.first_slack + 6 * len(self.exact) + i] = -1.0
            rhs[4 * i] = self.tolerances[block]
            rows[4 * i + 1 : 4 * i + 4, : self.n_control] = -G[3 * block : 3 * block + 3]
            rhs[4 * i + 1 : 4 * i + 4] = residual[3 * block : 3 * block + 3]
        return rows, rhs

    def _multiplier(self, dual: Array, rows: int) -> Array:
        multiplier = np.zeros(6)
        for i, block in enumerate(self.exact):
            multiplier[3 * block : 3 * block + 3] = dual[3 * i : 3 * i + 3]
        first = rows - 4 * len(self.ball)
        for i, block in enumerate(self.ball):
            multiplier[3 * block : 3 * block + 3] = -dual[first + 4 * i + 1 : first + 4 * i + 4]
        return multiplier


def _settings() -> Any:
    import clarabel

    settings = clarabel.DefaultSettings()
    settings.verbose = False
    settings.tol_gap_abs = settings.tol_gap_rel = settings.tol_feas = 1e-10
    settings.max_iter = 60
    settings.max_threads = 1
    return settings
