"""Potentials by convex programming: the polynomial that separates two attitudes most.

Maximise phi(start) - phi(target) subject to h(v(x)) <= 1 at points of the region, then add the
points where it is violated, and again. Nothing here is trusted: what comes out is a polynomial
with float coefficients, whose largest rate is proved afterwards and divided by.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import NDArray

from .chart import Chart
from .momentum_sets import MomentumSet
from .polynomials import CONSTANT, exponents
from .rate import potential_rates, rate_features

Array = NDArray[np.float64]


@final
@dataclass(frozen=True)
class Fit:
    """Degree and effort of a potential.

    Attributes
    ----------
    degree : int
        Total degree of the polynomial.
    points : int
        Points of the first program.
    rounds, candidates : int
        Rounds with random points, and how many are looked at in each.
    proofs : int
        Rounds with points found by branch and bound.
    excess : float
        Stop once the rate exceeds 1 by no more.
    seed : int
        Seed of the points.
    """

    degree: int = 5
    points: int = 1000
    rounds: int = 2
    candidates: int = 6000
    proofs: int = 12
    excess: float = 7e-4
    seed: int = 0


class PotentialProgram:
    """The convex program of one pair of attitudes, to which points are added as they are violated."""

    def __init__(
        self,
        fit: Fit,
        chart: Chart,
        ends: tuple[Array, Array],
        momenta: MomentumSet,
        inverse_inertia: Array,
    ) -> None:
        self.fit, self.chart = fit, chart
        self._momenta, self._constraint, self._inverse = momenta, momenta.constraint(), inverse_inertia
        self._table = exponents(fit.degree)[1:]
        self._random = np.random.default_rng(fit.seed)
        start, target = ends
        values, _ = self._features(np.array([start, target]))
        self._objective = values[0] - values[1]
        line = target + np.linspace(0, 1, 31)[:, None] * (start - target)
        points = np.concatenate([sample_region(chart, fit.points, self._random), line])
        self._rows = self._features(points)[1]

    def _features(self, points: Array) -> tuple[Array, Array]:
        return rate_features(points, self._table, self._inverse, float(self.chart.outer))

    def _rates(self, points: Array, coefficients: Array) -> Array:
        args = (points, self._table, self._inverse, float(self.chart.outer), coefficients)
        return potential_rates(*args)

    def solve(self) -> Array:
        """Coefficients over `exponents(degree)[1:]` in scaled coordinates, for the points at hand."""
        return self._constraint.maximise(self._objective, self._rows)

    def solve_sampled(self) -> Array:
        """Solve, adding random points where the rate is too large, for some rounds."""
        coefficients = self.solve()
        for _ in range(self.fit.rounds):
            trial = sample_region(self.chart, self.fit.candidates, self._random)
            rates = self._momenta.support_above(self._rates(trial, coefficients))
            if rates.max() <= 1 + self.fit.excess:
                break
            self.add(trial, rates)
            coefficients = self.solve()
        return coefficients

    def value(self, coefficients: Array) -> float:
        """Difference of the potential between the ends."""
        return float(self._objective @ coefficients)

    def add(self, points: Array, heights: Array) -> None:
        """Constrain further points, of which `heights` says how far they exceed 1."""
        chosen = spread_violations(points, heights, spacing=0.03)
        if chosen:
            self._rows = np.concatenate([self._rows, self._features(points[chosen])[1]])


def sample_region(chart: Chart, count: int, random: np.random.Generator) -> Array:
    """Scaled points (count, 3) of the region, denser towards its boundary than uniform ones."""
    coefficients = [(e, float(c)) for e, c in chart.region.items()]
    margin = 0.03 * float(chart.region[CONSTANT])  # a little beyond the edge, where fits overshoot
    found: list[Array] = []
    have = 0
    while have < count:
        x = np.clip(1.05 * random.uniform(-1, 1, (4 * count, 3)), -1, 1)
        value = margin + sum(c * x[:, 0] ** e[0] * x[:, 1] ** e[1] * x[:, 2] ** e[2] for e, c in coefficients)
        inside = x[(value >= 0) & ((x * x).sum(axis=1) <= 1)]
        found.append(inside)
        have += len(inside)
    return np.concatenate(found)[:count]


def spread_violations(points: Array, rates: Array, *, spacing: float, most: int = 250) -> list[int]:
    """Indices of the worst violations, no two closer than `spacing`."""
    chosen: list[int] = []
    for i in np.argsort(-rates):
        if rates[i] <= 1.0002 or len(chosen) >= most:
            break
        if not chosen or np.linalg.norm(points[chosen] - points[i], axis=1).min() > spacing:
            chosen.append(int(i))
    return chosen
