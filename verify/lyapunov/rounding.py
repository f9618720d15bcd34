"""From floating-point Gram matrices to rational ones: exact fit of linear equations, rational null spaces."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np

from ...models.types import Array
from ..exact import matrix
from ..exact.matrix import Matrix
from ..exact.rational import fraction, rational

SMALL_DENOMINATOR = 64
"""Null vectors are looked for among rationals up to this denominator."""


def fit_exactly(
    rows: list[dict[int, Fraction]], right: list[Fraction], guess: list[float], level: float
) -> list[Fraction] | None:
    """Return the exact solution of the equations that is nearest to the rounded guess; None if there is none.

    Parameters
    ----------
    rows : list of dict
        Each equation as {unknown: coefficient}.
    right : list[Fraction]
        Right sides, one an equation.
    guess : list[float]
        Floating-point solution, one number an unknown.
    level : float
        Least eigenvalue that the guess has to spare; the guess is rounded far more finely.
    """
    bits = 20 + max(0, math.ceil(-math.log2(level)))
    rounded = [Fraction(round(x * 2**bits), 2**bits) for x in guess]
    residual = [
        r - sum((a * rounded[j] for j, a in row.items()), Fraction(0))
        for row, r in zip(rows, right, strict=True)
    ]
    keep = _independent(rows, len(guess))
    n = len(keep)
    normal = matrix.zeros(n, n)
    for p in range(n):
        for q in range(p, n):
            short, long = sorted((rows[keep[p]], rows[keep[q]]), key=len)
            dot = sum((a * long[j] for j, a in short.items() if j in long), Fraction(0))
            normal[p, q] = normal[q, p] = rational(dot)
    multipliers = normal.solve(matrix.of([[residual[k]] for k in keep]))
    fitted = list(rounded)
    for p, k in enumerate(keep):
        y = fraction(multipliers[p, 0])
        for j, a in rows[k].items():
            fitted[j] += y * a
    exact = all(
        sum((a * fitted[j] for j, a in row.items()), Fraction(0)) == r
        for row, r in zip(rows, right, strict=True)
    )
    return fitted if exact else None


def _independent(rows: list[dict[int, Fraction]], unknowns: int) -> list[int]:
    """Numbers of a largest set of linearly independent equations."""
    transposed = matrix.zeros(unknowns, len(rows))
    for r, row in enumerate(rows):
        for j, a in row.items():
            transposed[j, r] = rational(a)
    return matrix.echelon(transposed)[1]


def rational_null_space(gram: Array, basis: Matrix, tolerance: float) -> Matrix:
    """Return the rows of a basis from which the null vectors of a Gram matrix are taken out.

    Null vectors are brought to echelon form and rounded to small rationals; a wrong guess only
    makes the equations unsolvable, never a proof wrong.
    """
    if not basis:
        return basis
    values, vectors = np.linalg.eigh(gram)
    null = vectors[:, values < tolerance]
    count = null.shape[1]
    if count == 0:
        return basis
    echelon, pivots = _echelon(null.T.copy())
    rational = [[Fraction(float(x)).limit_denominator(SMALL_DENOMINATOR) for x in row] for row in echelon]
    free = [j for j in range(len(basis)) if j not in pivots]
    # rows of C span the complement {v : N v = 0}: v_free = 1, v_pivot = -N[pivot, free]
    complement = []
    for j in free:
        row = [Fraction(0)] * len(basis)
        row[j] = Fraction(1)
        for r, pivot in enumerate(pivots):
            row[pivot] = -rational[r][j]
        complement.append(row)
    return matrix.rows(matrix.of(complement) * matrix.of(basis)) if complement else ()


def _echelon(rows: Array) -> tuple[Array, list[int]]:
    """Reduced echelon form with complete pivoting over columns."""
    pivots: list[int] = []
    for r in range(len(rows)):
        rest = np.abs(rows[r:])
        rest[:, pivots] = 0.0
        i, j = np.unravel_index(int(np.argmax(rest)), rest.shape)
        rows[[r, r + int(i)]] = rows[[r + int(i), r]]
        rows[r] /= rows[r, j]
        for k in range(len(rows)):
            if k != r:
                rows[k] -= rows[k, j] * rows[r]
        pivots.append(int(j))
    return rows, pivots
