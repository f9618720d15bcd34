"""The cones of one convex program: how effort is limited, and what is paid for it.

Variables are the controls v (n m of them, cell after cell) and some extras e that bound efforts or
consumptions from above. A row reads  rhs - (on_control v + on_extra e)  in its cone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from ....models.types import Array
from ...norms import Euclidean, LargestComponent, Norm
from .goal import Goal, LeastImpulse


@final
@dataclass(frozen=True)
class EffortCones:
    """Rows, cones and price of the controls and extras.

    Attributes
    ----------
    on_control, on_extra : sparse (rows, n m), (rows, extras)
    rhs : (rows,)
    cones : list of clarabel cones
    control_price, extra_price : (n m,), (extras,)
        What is minimised is their product with v and e.
    """

    on_control: Any
    on_extra: Any
    rhs: Array
    cones: list[Any]
    control_price: Array
    extra_price: Array

    @property
    def extras(self) -> int:
        """Number of extra variables."""
        return len(self.extra_price)


def effort_cones(goal: Goal, size: float, norm: Norm, weights: Array) -> EffortCones:
    """Cones for a goal, controls measured in `size`; weights (n,) are shares of the window time."""
    if isinstance(goal, LeastImpulse):
        limit = goal.limit / size
        return (
            _impulse_ball(weights, limit) if isinstance(norm, Euclidean) else _impulse(norm, weights, limit)
        )
    return _peak_ball(len(weights)) if isinstance(norm, Euclidean) else _peak(norm, len(weights))


def _ball_rows(cells: int, heads: int) -> tuple[Any, Any]:
    """Rows of the cones (e, v_k) for n cells, with one e for all (heads = 1) or one for each."""
    import scipy.sparse as sparse

    n, m = 3 * cells, 3
    row = np.arange(n) + np.arange(n) // m + 1
    head = np.arange(cells) * (m + 1)
    column = np.zeros(cells, dtype=int) if heads == 1 else np.arange(cells)
    on_control = sparse.csc_matrix((-np.ones(n), (row, np.arange(n))), shape=(n + cells, n))
    on_extra = sparse.csc_matrix((-np.ones(cells), (head, column)), shape=(n + cells, heads))
    return on_control, on_extra


def _peak_ball(cells: int) -> EffortCones:
    """|v_k| <= p, p being the one extra."""
    import clarabel

    on_control, on_extra = _ball_rows(cells, 1)
    cones = [clarabel.SecondOrderConeT(4) for _ in range(cells)]
    return EffortCones(on_control, on_extra, np.zeros(4 * cells), cones, np.zeros(3 * cells), np.ones(1))


def _peak(norm: Norm, cells: int) -> EffortCones:
    """Limits v <= p, and v >= -p for components or v >= 0 for one-sided thrusters."""
    import clarabel
    import scipy.sparse as sparse

    n = cells * norm.control_matrix.shape[1]
    identity, peak = sparse.identity(n, format="csc"), sparse.csc_matrix(-np.ones((n, 1)))
    lower = peak if isinstance(norm, LargestComponent) else sparse.csc_matrix((n, 1))
    return EffortCones(
        sparse.vstack([identity, -identity]),
        sparse.vstack([peak, lower]),
        np.zeros(2 * n),
        [clarabel.NonnegativeConeT(2 * n)],
        np.zeros(n),
        np.ones(1),
    )


def _impulse_ball(weights: Array, limit: float) -> EffortCones:
    """|v_k| <= e_k <= limit, and the sum of weight_k e_k is paid."""
    import clarabel
    import scipy.sparse as sparse

    cells = len(weights)
    on_control, on_extra = _ball_rows(cells, cells)
    return EffortCones(
        sparse.vstack([on_control, sparse.csc_matrix((cells, 3 * cells))]),
        sparse.vstack([on_extra, sparse.identity(cells)]),
        np.r_[np.zeros(4 * cells), np.full(cells, limit)],
        [*(clarabel.SecondOrderConeT(4) for _ in range(cells)), clarabel.NonnegativeConeT(cells)],
        np.zeros(3 * cells),
        weights,
    )


def _impulse(norm: Norm, weights: Array, limit: float) -> EffortCones:
    """|v_kj| <= e_kj <= limit for components; 0 <= v_kj <= limit for thrusters, paid for themselves."""
    import clarabel
    import scipy.sparse as sparse

    m = norm.control_matrix.shape[1]
    n, price = m * len(weights), np.repeat(weights, m)
    one, none = sparse.identity(n, format="csc"), sparse.csc_matrix((n, n))
    if isinstance(norm, LargestComponent):
        on_control = sparse.vstack([one, -one, none])
        on_extra = sparse.vstack([-one, -one, one])
        rhs, own, extra = np.r_[np.zeros(2 * n), np.full(n, limit)], np.zeros(n), price
    else:
        on_control, on_extra = sparse.vstack([one, -one]), sparse.csc_matrix((2 * n, 0))
        rhs, own, extra = np.r_[np.full(n, limit), np.zeros(n)], price, np.zeros(0)
    return EffortCones(on_control, on_extra, rhs, [clarabel.NonnegativeConeT(len(rhs))], own, extra)
