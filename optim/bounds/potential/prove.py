"""Branch and bound for the largest rate of a potential, in floats with a proved error.

Every box holds the Taylor coefficients of the three components of v, and of the region F, in
t in [-1, 1]^3. A box without a point of {F >= 0, |x| <= outer} is dropped. On the others

    h(v(t)) <= max over the corners of h(v_0 + D t) + sum_i widths_i R_i,

h being convex and symmetric, D the linear part and R_i the absolute sum of the coefficients of
second and higher order; or, for ellipsoids, the square of h is expanded to second order first.
A box whose bound is above the target is cut into eight.

Rounding. Cutting is one product with a matrix of exact entries whose rows have absolute sum 1,
so that the absolute sum of the coefficients never grows, and a product of length m adds at most
gamma_m = m u / (1 - m u) of it (u = 2^-53) whatever the order of summation. Hence after L cuts
each coefficient vector is within (u + L gamma_m)(1 + 1e-9) times the first absolute sum of the
truth, in absolute sum. That error, doubled for the few operations at the end, is added once.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from ....models.types import Array
from ....verify.exact.polynomial import Polynomial
from ..sets.momentum_sets import EVALUATION_SLACK, MomentumSet, TaylorBoxes
from ..sets.polynomials import as_table, halving_matrices

_CORNERS = np.array([[i, j, k] for i in (-1.0, 1.0) for j in (-1.0, 1.0) for k in (-1.0, 1.0)])
_BATCH = 2048
_BLIND = 6


@final
@dataclass(frozen=True)
class Supremum:
    """A proved upper bound of h(v) over the region.

    Attributes
    ----------
    value : float
        No point of the region exceeds it.
    seen : float
        Largest value at a box centre: the truth lies between (not a proved figure).
    boxes : int
        Boxes examined.
    worst, heights : arrays (k, 3) and (k,)
        Scaled centres of boxes with the largest centre values, for further constraints.
    """

    value: float
    seen: float
    boxes: int
    worst: Array
    heights: Array


@final
@dataclass(frozen=True)
class BranchAndBound:
    """How far to go.

    Attributes
    ----------
    tolerance : float
        Aim: at most (1 + tolerance) times the largest value seen, or times 1 if that is less.
    most_boxes : int
        Beyond it the search starts again with 2.5 times the tolerance.

    levels : int
        Most successive cuts of a box.
    """

    tolerance: float = 1e-3
    most_boxes: int = 250_000
    levels: int = 60

    def supremum(
        self, rate: Sequence[Polynomial], region: Polynomial, momenta: MomentumSet, *, degree: int
    ) -> Supremum:
        """Bound h(v) on {region >= 0, |x| <= 1}, x the scaled coordinates; `degree` is that of v."""
        first = np.array([as_table(p, degree) for p in (*rate, region)])
        sums = np.abs(first).sum(axis=1) * (1 + 1e-12)
        size = first.shape[1]
        unit = 2.0**-53
        error = 2.0 * (unit + self.levels * size * unit / (1 - size * unit)) * sums
        noise = float(error[:3] @ momenta.widths()) * (1 + 1e-9)
        cut = halving_matrices(degree)

        stack = [(0, np.zeros((1, 3)), first[None])]
        seen, proved, boxes = 0.0, 0.0, 0
        worst: list[tuple[float, Array]] = []
        while stack:
            level, centres, tables = stack.pop()
            boxes += len(tables)
            inside, alive = _position(tables, centres, _half_sides(level), float(error[3]))
            centres, tables, inside = centres[alive], tables[alive], inside[alive]
            if not len(tables):
                continue
            if level < _BLIND:
                stack += _children(tables, centres, level, cut[level % 3])
                continue
            boxes_here = TaylorBoxes(tables[:, :3], tables[:, 3], float(error[3]))
            values = momenta.support_above(boxes_here.middle)
            values = np.where(inside, values, 0.0)
            seen = max(seen, float(values.max()))
            high = np.argsort(-values)[:20]
            worst += [(float(values[i]), centres[i]) for i in high if values[i] > 1]
            target = max(seen, 1.0) * (1 + self.tolerance)
            enough = (target - noise) / (1 + 3 * EVALUATION_SLACK)
            upper = momenta.support_over_boxes(boxes_here, enough) * (1 + 2 * EVALUATION_SLACK) + noise
            finished = (upper <= target) | (level >= self.levels)
            if boxes > self.most_boxes:
                if self.tolerance < 0.1:
                    coarser = replace(self, tolerance=2.5 * self.tolerance)
                    return coarser.supremum(rate, region, momenta, degree=degree)
                finished[:] = True
            if finished.any():
                proved = max(proved, float(upper[finished].max()))
            rest = ~finished
            if rest.any():
                stack += _children(tables[rest], centres[rest], level, cut[level % 3])
        worst.sort(key=lambda pair: -pair[0])
        kept = worst[:2000]
        points = np.array([centre for _, centre in kept]).reshape(-1, 3)
        heights = np.array([value for value, _ in kept])
        return Supremum(float(np.nextafter(proved, np.inf)), seen, boxes, points, heights)


def _position(tables: Array, centres: Array, half_sides: Array, error: float) -> tuple[Array, Array]:
    """Whether the centre is inside the region, and whether any point of the box may be."""
    middle = tables[:, 3, 0]
    reach = np.abs(tables[:, 3, 1:]).sum(axis=1) * (1 + 1e-12)
    nearest = np.maximum(np.abs(centres) - half_sides, 0.0)
    in_ball = (nearest * nearest).sum(axis=1) <= 1 + 1e-9
    centre_in_ball = (centres * centres).sum(axis=1) <= 1
    return (middle >= 0) & centre_in_ball, (middle + reach + error >= 0) & in_ball


def _half_sides(level: int) -> Array:
    """Half the sides of a box after that many cuts, axis by axis in turn."""
    return np.array([2.0 ** -((level + 2 - axis) // 3) for axis in range(3)])


def _children(tables: Array, centres: Array, level: int, cut: Array) -> list[tuple[int, Array, Array]]:
    """Cut every box into two, in batches."""
    size = tables.shape[2]
    offset = np.zeros((2, 3))
    offset[:, level % 3] = np.array([-1.0, 1.0]) * _half_sides(level + 1)[level % 3]
    result = []
    for start in range(0, len(tables), _BATCH // 2):
        part = tables[start : start + _BATCH // 2]
        shifted = (part @ cut).reshape(len(part), 4, 2, size).transpose(0, 2, 1, 3).reshape(-1, 4, size)
        middles = (centres[start : start + len(part), None, :] + offset).reshape(-1, 3)
        result.append((level + 1, middles, shifted))
    return result
