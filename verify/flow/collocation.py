"""Proposing a polynomial step: floating-point collocation at Chebyshev nodes on [0, 1].

Nothing here is trusted: a proposal counts only after its differential inequalities are proved.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from functools import cache
from math import comb
from typing import final

import numpy as np

from ...models.types import Array

Rates = Callable[[Array], Array]
"""Rates (m, n), per second, at m points of the step for states (m, n); the points are the caller's."""

CHECK_POINTS = np.array([0.0, 0.13, 0.31, 0.5, 0.69, 0.87, 1.0])
"""Where a proposal's defect is looked at in floats before the exact proof is tried."""


@final
@dataclass(frozen=True)
class Rule:
    """Collocation with polynomials of a given degree d.

    Attributes
    ----------
    nodes : Chebyshev nodes on (0, 1), (d,)
    integration : (d, d), row i times rates at the nodes = integral from 0 to node i
    controls : (d + 1, d), times rates at the nodes = Bernstein coefficients of the integral from 0
    check_values : (m, d + 1), Bernstein coefficients to values at `CHECK_POINTS`
    check_slopes : (m, d + 1), Bernstein coefficients to slopes there
    """

    nodes: Array
    integration: Array
    controls: Array
    check_values: Array
    check_slopes: Array


@cache
def rule(degree: int) -> Rule:
    """Return the collocation rule of this degree."""
    n = degree
    nodes = 0.5 - 0.5 * np.cos((2 * np.arange(n) + 1) * np.pi / (2 * n))
    lagrange = np.linalg.inv(np.vander(nodes, increasing=True)).T  # row j: power coefficients
    powers = np.arange(1, n + 1)
    primitive = (nodes[:, None] ** powers) @ (lagrange / powers).T
    to_bernstein = np.array([[comb(k, j) / comb(n - 1, j) for j in range(n)] for k in range(n)])
    slopes = to_bernstein @ lagrange.T
    controls = np.vstack([np.zeros(n), np.cumsum(slopes, axis=0) / n])
    difference = n * (np.eye(n + 1, k=1)[:n] - np.eye(n + 1)[:n])
    return Rule(nodes, primitive, controls, basis(n, CHECK_POINTS), basis(n - 1, CHECK_POINTS) @ difference)


def basis(degree: int, points: Array) -> Array:
    """Values of the Bernstein polynomials of this degree at points of [0, 1], (m, degree + 1)."""
    x = points[:, None]
    j = np.arange(degree + 1)
    weights = np.array([comb(degree, k) for k in j], dtype=float)
    values: Array = weights * x**j * (1 - x) ** (degree - j)
    return values


def propose(
    rates: Rates, state: Array, length: float, degree: int, *, iterations: int = 40, tolerance: float = 1e-7
) -> Array | None:
    """Bernstein coefficients (degree + 1, n) of a polynomial step, or None if it does not settle.

    Picard iteration on the collocation equations; it contracts when the step is short.
    """
    r = rule(degree)
    points = np.tile(state, (degree, 1))
    for _ in range(iterations):
        slopes = rates(points)
        updated = state + length * (r.integration @ slopes)
        change = float(np.max(np.abs(updated - points) / (np.abs(updated) + 1e-300), initial=0.0))
        points = updated
        if change < tolerance:
            controls: Array = state + length * (r.controls @ slopes)
            return controls
        if not change < 1e3:
            return None
    return None
