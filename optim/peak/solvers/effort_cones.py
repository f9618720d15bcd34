"""The cones of one convex program: how effort is limited, and what is paid for it.

Variables are the controls v (n m of them, cell after cell) and some extras e that bound efforts or
consumptions from above. A row reads  rhs - (on_control v + on_extra e)  in its cone.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from ....models.norm_blocks import Block
from ....models.norms import Norm
from ....models.types import Array
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
    import scipy.sparse as sparse

    cells, m = len(weights), len(norm.axes)
    parts: list[EffortCones] = []
    price = np.zeros(cells * m)
    for block, at in norm.parts:
        columns = np.arange(cells * m).reshape(cells, m)[:, at].ravel()
        on = _OnBlock(block, cells, columns, cells * m)
        parts.append(on.impulse(weights, goal.limit / size) if isinstance(goal, LeastImpulse) else on.peak())
        price[columns] = parts[-1].control_price
    if isinstance(goal, LeastImpulse):
        on_extra, extra_price = sparse.block_diag([p.on_extra for p in parts]), [p.extra_price for p in parts]
    else:
        on_extra, extra_price = sparse.vstack([p.on_extra for p in parts]), [np.ones(1)]
    return EffortCones(
        sparse.vstack([p.on_control for p in parts]),
        on_extra,
        np.concatenate([p.rhs for p in parts]),
        [cone for p in parts for cone in p.cones],
        price,
        np.concatenate(extra_price),
    )


@final
@dataclass(frozen=True)
class _OnBlock:
    """Cones of one block: its controls on n cells stand in `columns` among `total`.

    The prices of controls are those of its own `columns`.
    """

    block: Block
    cells: int
    columns: NDArray[np.int64]
    total: int

    def peak(self) -> EffortCones:
        """The block's controls within p, the one extra: |v_k| <= p, or v <= p and v >= low p."""
        import clarabel
        import scipy.sparse as sparse

        n = len(self.columns)
        if self.block.is_round:
            return EffortCones(*self._round(1), self._zeros(), self._round_cones(), np.zeros(n), np.ones(1))
        one, p = self._each(), sparse.csc_matrix(-np.ones((n, 1)))
        lower = sparse.csc_matrix((n, 1)) if self.block.is_one_sided else p
        return EffortCones(
            sparse.vstack([one, -one]),
            sparse.vstack([p, lower]),
            np.zeros(2 * n),
            [clarabel.NonnegativeConeT(2 * n)],
            np.zeros(n),
            np.ones(1),
        )

    def impulse(self, weights: Array, limit: float) -> EffortCones:
        """Controls within the limit, and what they consume in each cell paid for by its weight.

        A ball: |v_k| <= e_k <= limit, e_k paid. A box: |v_kj| <= e_kj <= limit, e_kj paid; one-sided,
        0 <= v_kj <= limit are paid themselves.
        """
        import clarabel
        import scipy.sparse as sparse

        n, cells = len(self.columns), self.cells
        price = np.repeat(weights, self.block.size)
        if self.block.is_round:
            on_control, on_extra = self._round(cells)
            return EffortCones(
                sparse.vstack([on_control, sparse.csc_matrix((cells, self.total))]),
                sparse.vstack([on_extra, sparse.identity(cells)]),
                np.r_[self._zeros(), np.full(cells, limit)],
                [*self._round_cones(), clarabel.NonnegativeConeT(cells)],
                np.zeros(n),
                weights,
            )
        one = self._each()
        if self.block.is_one_sided:
            on_control, on_extra = sparse.vstack([one, -one]), sparse.csc_matrix((2 * n, 0))
            rhs, own, extra = np.r_[np.full(n, limit), np.zeros(n)], price, np.zeros(0)
        else:
            e = sparse.identity(n, format="csc")
            on_control = sparse.vstack([one, -one, sparse.csc_matrix((n, self.total))])
            on_extra = sparse.vstack([-e, -e, e])
            rhs, own, extra = np.r_[np.zeros(2 * n), np.full(n, limit)], np.zeros(n), price
        return EffortCones(on_control, on_extra, rhs, [clarabel.NonnegativeConeT(len(rhs))], own, extra)

    def _each(self) -> Any:
        """Rows that pick the block's controls one by one."""
        import scipy.sparse as sparse

        n = len(self.columns)
        return sparse.csc_matrix((np.ones(n), (np.arange(n), self.columns)), shape=(n, self.total))

    def _round(self, heads: int) -> tuple[Any, Any]:
        """Rows of the cones (e, v_k) for n cells, with one e for all (heads = 1) or one for each."""
        import scipy.sparse as sparse

        n, cells, size = len(self.columns), self.cells, self.block.size
        row = np.arange(n) + np.arange(n) // size + 1
        head = np.arange(cells) * (size + 1)
        column = np.zeros(cells, dtype=int) if heads == 1 else np.arange(cells)
        on_control = sparse.csc_matrix((-np.ones(n), (row, self.columns)), shape=(n + cells, self.total))
        on_extra = sparse.csc_matrix((-np.ones(cells), (head, column)), shape=(n + cells, heads))
        return on_control, on_extra

    def _round_cones(self) -> list[Any]:
        import clarabel

        return [clarabel.SecondOrderConeT(self.block.size + 1) for _ in range(self.cells)]

    def _zeros(self) -> Array:
        return np.zeros(len(self.columns) + self.cells)
