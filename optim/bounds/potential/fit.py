"""Potentials by convex programming: the polynomial that separates two attitudes most.

Maximise phi(start) - phi(target) subject to h(v(x)) <= 1 at a few hundred points of the region,
look where it is violated among some thousands more and about the worst of them, add those, and
again. Nothing here is trusted: what comes out is a polynomial with float coefficients, whose
largest rate is proved afterwards and divided by.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from ....models.types import Array
from ..sets.chart import Chart
from ..sets.momentum_sets import MomentumSet
from ..sets.polynomials import exponents
from ..sets.rate import rate_features


@final
@dataclass(frozen=True)
class Fit:
    """Degree and effort of a potential.

    Attributes
    ----------
    degree : int
        Total degree of the polynomial.
    first, pool : int
        Points of the first program, and points that every round looks at.
    rounds : int
        Most programs solved between two proofs.
    proofs : int
        Most times that branch and bound is asked for further points.
    excess : float
        Stop once the rate exceeds 1 by no more.
    """

    degree: int = 5
    first: int = 500
    pool: int = 4000
    rounds: int = 20
    proofs: int = 3
    excess: float = 7e-4


class PotentialProgram:
    """The convex program of one pair of attitudes, to which points are added as they are violated.

    Its unknowns are coefficients in a basis in which the rates of unit vectors are of like size
    over the region: monomials of degree 7 would leave the normal equations without a digit.
    """

    def __init__(
        self,
        fit: Fit,
        chart: Chart,
        ends: tuple[Array, Array],
        momenta: MomentumSet,
        inverse_inertia: Array,
    ) -> None:
        self.fit, self.chart, self.momenta = fit, chart, momenta
        self._constraint, self._inverse = momenta.constraint(), inverse_inertia
        self._table = exponents(fit.degree)[1:]
        self._gap = 3e-3
        self._points = sample_region(chart, fit.pool)
        values, features = self._raw(np.concatenate([self._points, np.array(ends)]))
        features = features[:-2]
        gram = np.tensordot(features, features, axes=([0, 1], [0, 1])) / len(features)
        gram[np.diag_indices_from(gram)] += 1e-13 * np.trace(gram)
        self._basis = np.linalg.inv(np.linalg.cholesky(gram)).T
        self._features = features @ self._basis
        self._objective = (values[-2] - values[-1]) @ self._basis
        start, target = ends
        line = target + np.linspace(0, 1, 31)[:, None] * (start - target)
        self._constraint.begin(
            np.concatenate(
                [self._features[:: len(self._features) // fit.first], self._raw(line)[1] @ self._basis]
            )
        )

    def _raw(self, points: Array) -> tuple[Array, Array]:
        return rate_features(points, self._table, self._inverse, float(self.chart.outer))

    def coefficients(self, unknowns: Array) -> Array:
        """Coefficients over `exponents(degree)[1:]` in scaled coordinates."""
        return np.asarray(self._basis @ unknowns)

    def solve(self, excess: float | None = None) -> tuple[Array, float]:
        """Add points until the rate exceeds 1 by no more than `excess` (that of the fit).

        Returns the unknowns, and the difference between the ends over the largest rate seen.
        """
        excess = self.fit.excess if excess is None else excess
        best, best_value, idle = np.zeros(len(self._objective)), -np.inf, 0
        sharp = 0.3 * excess
        for _ in range(self.fit.rounds):
            unknowns = self._constraint.maximise(self._objective, gap=self._gap)
            height = self._tighten(unknowns)
            value = float(self._objective @ unknowns) / height
            idle = 0 if height > 1.03 or value > best_value * (1 + 2e-4) else idle + 1
            if value > best_value:
                best, best_value = unknowns, value
            if self._gap <= sharp and (height <= 1 + excess or idle > (height > 1.004)):
                break
            self._gap = min(self._gap, max(sharp, 0.03 * (height - 1)))
        return best, best_value

    def _tighten(self, unknowns: Array) -> float:
        """Constrain points where the rate is too large; the largest rate found."""
        rates = self._features @ unknowns
        heights = self.momenta.support_above(rates)
        worst = spread_highest(self._points, heights, spacing=0.05, least=1.0002, most=250)
        if worst:
            self._constraint.add(self._features[worst], rates[worst], heights[worst])
        peaks = spread_highest(self._points, heights, spacing=0.1, least=0.99, most=80)
        return max(float(heights.max()), self._climb(self._points[peaks], unknowns))

    def _climb(self, points: Array, unknowns: Array) -> float:
        """Look about the given points for larger rates, and constrain those."""
        near = (points[:, None, :] + 0.08 * _ball_points(24)[None]).reshape(-1, 3)
        near = near[in_region(self.chart, near)]
        if not len(near):
            return 1.0
        features = self._raw(near)[1] @ self._basis
        return self.constrain(near, features, unknowns)

    def constrain(self, points: Array, features: Array, unknowns: Array) -> float:
        """Constrain those of the points where the rate is too large; the largest rate."""
        rates = features @ unknowns
        heights = self.momenta.support_above(rates)
        worst = spread_highest(points, heights, spacing=0.03, least=1.0002, most=250)
        if worst:
            self._constraint.add(features[worst], rates[worst], heights[worst])
        return float(heights.max())

    def constrain_about(self, points: Array, unknowns: Array) -> None:
        """Constrain further points, or better ones near them, where the rate is too large."""
        if len(points):
            self.constrain(points, self._raw(points)[1] @ self._basis, unknowns)
            self._climb(points[:60], unknowns)


def sample_region(chart: Chart, count: int) -> Array:
    """Scaled points of the region, evenly spread: `count` inside, half as many just beyond its edge."""
    found: list[Array] = []
    have, begun = 0, 0
    while have < count:
        x = 2 * _even_points(begun, 2 * count) - 1
        begun += 2 * count
        inside = x[in_region(chart, x)]
        found.append(inside)
        have += len(inside)
    return np.concatenate([np.concatenate(found)[:count], edge_points(chart, count // 2)])


def edge_points(chart: Chart, count: int) -> Array:
    """Points a little beyond the region's edge, where fits overshoot, in evenly spread directions."""
    turn = np.pi * (3 - np.sqrt(5)) * np.arange(count)
    height = 1 - 2 * (np.arange(count) + 0.5) / count
    flat = np.sqrt(1 - height * height)
    directions = np.stack([flat * np.cos(turn), flat * np.sin(turn), height], axis=1)
    low, high = np.zeros(count), np.ones(count)
    for _ in range(12):
        middle = (low + high) / 2
        inside = in_region(chart, middle[:, None] * directions)
        low, high = np.where(inside, middle, low), np.where(inside, high, middle)
    return np.asarray(np.minimum(low + 0.012, 1.0)[:, None] * directions)


def in_region(chart: Chart, x: Array) -> NDArray[np.bool_]:
    """Whether scaled points are in the region (floats)."""
    value = np.zeros(len(x))
    for e, c in chart.region.terms.items():
        value += float(c) * x[:, 0] ** e[0] * x[:, 1] ** e[1] * x[:, 2] ** e[2]
    return np.asarray((value >= 0) & ((x * x).sum(axis=1) <= 1))


def _even_points(first: int, count: int) -> Array:
    """Points of the unit cube whose every stretch is evenly spread (additive recurrence, Roberts 2018)."""
    root = 1.2207440846057596  # of x^4 = x + 1
    steps = np.array([root**-1, root**-2, root**-3])
    return np.asarray((0.5 + np.arange(first + 1, first + count + 1)[:, None] * steps) % 1.0)


def _ball_points(count: int) -> Array:
    """Points of the unit ball, evenly spread."""
    x = 2 * _even_points(0, 3 * count) - 1
    return np.asarray(x[(x * x).sum(axis=1) <= 1][:count])


def spread_highest(points: Array, heights: Array, *, spacing: float, least: float, most: int) -> list[int]:
    """Indices of the largest heights above `least`, no two points closer than `spacing`."""
    chosen: list[int] = []
    for i in np.argsort(-heights):
        if heights[i] <= least or len(chosen) >= most:
            break
        if not chosen or np.linalg.norm(points[chosen] - points[i], axis=1).min() > spacing:
            chosen.append(int(i))
    return chosen
