"""One call of Clarabel for a Gram search: linear equations between matrices, each semidefinite.

Clarabel's own interface is used: the modelling layer would take longer to import than a check takes.
Nothing that comes out is evidence; it is rounded to rationals and checked there.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np

from ...models.types import Array
from ..solver_status import clarabel_status


@final
@dataclass(frozen=True)
class ConeSolution:
    """What the solver returned: the free scalar, the matrices, and the equations' multipliers."""

    level: float
    matrices: tuple[Array, ...]
    multipliers: Array


def maximise_level(
    *,
    sizes: Sequence[int],
    equations: Sequence[dict[int, float]],
    columns: Sequence[tuple[int, int, int]],
    right: Array,
    level_column: Array,
    shift: float,
    cap: float,
) -> ConeSolution | None:
    """Maximise t subject to A h + t level_column = right, G_i - shift t I >= 0, t <= cap.

    Parameters
    ----------
    sizes : Sequence[int]
        Orders of the matrices G_i.
    equations : Sequence[dict[int, float]]
        Rows of A: column number -> coefficient.
    columns : Sequence[tuple[int, int, int]]
        (matrix, p, q) with p <= q of each entry h: G[p, q] = G[q, p] = h.
    right, level_column : Array
        Right side and the column of t, (m,).
    shift : float
        1 to push the least eigenvalue up, 0 if t enters the equations alone.
    cap : float
        Largest t that is of use.

    Returns
    -------
    ConeSolution or None
        None if Clarabel ends without usable numbers.
    """
    import clarabel
    import scipy.sparse as sp

    count, m = len(columns) + 1, len(right)
    rows, places, values = [], [], []
    for r, row in enumerate(equations):
        for column, value in row.items():
            rows.append(r)
            places.append(column + 1)
            values.append(value)
    for r in np.flatnonzero(level_column).tolist():
        rows.append(r)
        places.append(0)
        values.append(float(level_column[r]))
    rows.append(m)
    places.append(0)
    values.append(1.0)
    offsets = [m + 1, *(m + 1 + np.cumsum([n * (n + 1) // 2 for n in sizes])).tolist()]
    for number, (which, p, q) in enumerate(columns):
        rows.append(int(offsets[which]) + q * (q + 1) // 2 + p)
        places.append(number + 1)
        values.append(-1.0 if p == q else -np.sqrt(2.0))
    for which, n in enumerate(sizes):
        for p in range(n):
            rows.append(int(offsets[which]) + p * (p + 1) // 2 + p)
            places.append(0)
            values.append(shift)
    A = sp.csc_matrix((values, (rows, places)), shape=(int(offsets[-1]), count))
    b = np.concatenate([right, [cap], np.zeros(int(offsets[-1]) - m - 1)])
    cones = [clarabel.ZeroConeT(m), clarabel.NonnegativeConeT(1)]
    cones += [clarabel.PSDTriangleConeT(n) for n in sizes if n]
    settings = clarabel.DefaultSettings()
    settings.verbose = False
    objective = np.zeros(count)
    objective[0] = -1.0
    solver = clarabel.DefaultSolver(sp.csc_matrix((count, count)), objective, A, b, cones, settings)
    found = solver.solve()
    if not clarabel_status(found).is_usable:
        return None
    x = np.asarray(found.x)
    matrices = [np.zeros((n, n)) for n in sizes]
    for value, (which, p, q) in zip(x[1:], columns, strict=True):
        matrices[which][p, q] = matrices[which][q, p] = value
    return ConeSolution(float(x[0]), tuple(matrices), np.asarray(found.z)[:m])
