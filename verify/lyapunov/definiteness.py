"""Matrix conditions on lambda, decided in rationals, with a vector that refutes where they fail."""

from __future__ import annotations

from fractions import Fraction

from ..exact.matrix import Rows, elimination, quadratic_form

Direction = list[Fraction]


def negative_direction(A: Rows, *, strict: bool) -> Direction | None:
    """Return x with x'Ax < 0 (`strict`: or x != 0 with x'Ax <= 0), or None if there is none.

    Symmetric elimination A = L D L'; where a pivot is negative, L'x = e solves for x exactly and
    x'Ax is that pivot.
    """
    L, pivots = elimination(A)
    units = range(len(A))
    for k, pivot in enumerate(pivots):
        x = _back(L, k, k)
        if pivot < 0 or (strict and pivot == 0):
            return x
        if pivot > 0:
            continue
        Ax = [sum((a * v for a, v in zip(row, x, strict=True)), Fraction(0)) for row in A]
        for i in units[k + 1 :]:
            y = _back(L, i, k)
            mixed = sum((a * b for a, b in zip(y, Ax, strict=True)), Fraction(0))
            if mixed:  # (y + t x)'A(y + t x) = y'Ay + 2 t y'Ax is -1 for this t
                t = -(quadratic_form(A, y) + 1) / (2 * mixed)
                return [a + t * b for a, b in zip(y, x, strict=True)]
    return None


def _back(L: Rows, axis: int, done: int) -> Direction:
    """Solve L'x = e of that axis, with only the first `done` columns of L."""
    x = [Fraction(int(i == axis)) for i in range(len(L))]
    for i in range(done - 1, -1, -1):
        x[i] -= sum((L[j][i] * x[j] for j in range(i + 1, len(L))), Fraction(0))
    return x


def factors(A: Rows) -> dict[str, list[Fraction]]:
    """Return A = L D L' for a positive semidefinite 3 by 3 matrix: L below the diagonal, and D."""
    L, pivots = elimination(A)
    return {"lower": [L[1][0], L[2][0], L[2][1]], "pivots": pivots}
