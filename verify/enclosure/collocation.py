"""Proposing a polynomial step: floating-point collocation at Chebyshev nodes on [0, 1].

Nothing here is trusted: a proposal counts only after its differential inequalities are proved.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cache
from typing import final

import numpy as np

State = tuple[float, ...]
Rate = Callable[[float, Sequence[float]], Sequence[float]]
"""Rate of the state at (x, state), x in [0, 1] along the step, per second."""


@final
@dataclass(frozen=True)
class Rule:
    """Collocation with polynomials of a given degree.

    Attributes
    ----------
    nodes : Chebyshev nodes on (0, 1), as many as the degree
    integration : integration[i][j] = integral of the j-th Lagrange polynomial from 0 to node i
    slopes : slopes[k][j] = k-th Bernstein coefficient (degree - 1) of the j-th Lagrange polynomial
    """

    nodes: tuple[float, ...]
    integration: tuple[tuple[float, ...], ...]
    slopes: tuple[tuple[float, ...], ...]


@cache
def rule(degree: int) -> Rule:
    """Return the collocation rule of this degree."""
    from math import comb

    n = degree
    nodes = 0.5 - 0.5 * np.cos((2 * np.arange(n) + 1) * np.pi / (2 * n))
    lagrange = np.linalg.inv(np.vander(nodes, increasing=True)).T  # row j: power coefficients
    powers = np.arange(1, n + 1)
    primitive = (nodes[:, None] ** powers) @ (lagrange / powers).T
    to_bernstein = np.array([[comb(k, j) / comb(n - 1, j) for j in range(n)] for k in range(n)])
    slopes = to_bernstein @ lagrange.T
    return Rule(
        tuple(nodes.tolist()),
        tuple(tuple(row) for row in primitive.tolist()),
        tuple(tuple(row) for row in slopes.tolist()),
    )


def propose(
    rate: Rate, state: Sequence[float], length: float, degree: int, *, iterations: int = 40
) -> list[list[float]] | None:
    """Bernstein coefficients of a polynomial step for each component, or None if it does not settle.

    Picard iteration on the collocation equations; it contracts when the step is short.
    """
    r = rule(degree)
    size = range(len(state))
    points = [list(state) for _ in r.nodes]
    rates: list[Sequence[float]] = []
    settled = False
    for _ in range(iterations):
        rates = [rate(x, p) for x, p in zip(r.nodes, points, strict=True)]
        updated = [
            [state[i] + length * sum(w * f[i] for w, f in zip(row, rates, strict=True)) for i in size]
            for row in r.integration
        ]
        change = max(
            (
                abs(a - b) / (abs(a) + 1e-300)
                for p, q in zip(points, updated, strict=True)
                for a, b in zip(p, q, strict=True)
            ),
            default=0.0,
        )
        points = updated
        if settled:
            break
        if not change < 1e3:
            return None
        settled = change < 1e-11
    if not settled:
        return None
    controls = []
    for i in size:
        values = [state[i]]
        for row in r.slopes:
            values.append(
                values[-1] + length / degree * sum(w * f[i] for w, f in zip(row, rates, strict=True))
            )
        controls.append(values)
    return controls


def evaluate(controls: Sequence[float], x: float) -> float:
    """Value at x in [0, 1] of the polynomial with these Bernstein coefficients (floats)."""
    row = list(controls)
    while len(row) > 1:
        row = [a + x * (b - a) for a, b in zip(row[:-1], row[1:], strict=True)]
    return row[0]
