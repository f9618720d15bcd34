"""Matrix conditions on lambda, decided in rationals, with a vector that refutes where they fail."""

from __future__ import annotations

from fractions import Fraction

from ..checker import Matrix, Vector


def negative_direction(A: Matrix, *, strict: bool) -> Vector | None:
    """Return x with x'Ax < 0 (`strict`: or x != 0 with x'Ax <= 0), or None if there is none.

    Symmetric elimination A = L D L'; where a pivot is negative, L'x = e solves for x exactly and
    x'Ax is that pivot.
    """
    n = len(A)
    work = [list(row) for row in A]
    L = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    for k in range(n):
        pivot = work[k][k]
        if pivot < 0 or (strict and pivot == 0):
            return _back(L, [Fraction(int(i == k)) for i in range(n)], k)
        if pivot == 0:
            for i in range(k + 1, n):
                if work[i][k] != 0:
                    # on span(e_i, e_k): d_i + 2 t a < 0 for t = -(d_i + 1)/(2 a)
                    t = -(work[i][i] + 1) / (2 * work[i][k])
                    target = [t if j == k else Fraction(int(j == i)) for j in range(n)]
                    return _back(L, target, k)
            continue
        for i in range(k + 1, n):
            L[i][k] = work[i][k] / pivot
        for i in range(k + 1, n):
            for j in range(k + 1, n):
                work[i][j] -= L[i][k] * work[k][j]
    return None


def _back(L: Matrix, target: Vector, done: int) -> Vector:
    """Solve L'x = target, where only the first `done` columns of L are filled."""
    x = list(target)
    for i in range(done - 1, -1, -1):
        x[i] = target[i] - sum((L[j][i] * x[j] for j in range(i + 1, len(L))), Fraction(0))
    return x


def quadratic(A: Matrix, x: Vector) -> Fraction:
    """Return x'Ax."""
    n = range(len(x))
    return sum((x[i] * A[i][j] * x[j] for i in n for j in n), Fraction(0))


def shifted(J: Matrix, factor: Fraction, shift: Fraction) -> Matrix:
    """Return factor J - shift I."""
    return [[factor * J[i][j] - (shift if i == j else 0) for j in range(3)] for i in range(3)]


def factors(A: Matrix) -> dict[str, Vector]:
    """Return A = L D L' for a positive semidefinite 3 by 3 matrix: L below the diagonal, and D."""
    work = [list(row) for row in A]
    L = [[Fraction(int(i == j)) for j in range(3)] for i in range(3)]
    for k in range(3):
        for i in range(k + 1, 3):
            L[i][k] = work[i][k] / work[k][k] if work[k][k] else Fraction(0)
            for j in range(k + 1, 3):
                work[i][j] -= L[i][k] * work[k][j]
    return {"lower": [L[1][0], L[2][0], L[2][1]], "pivots": [work[k][k] for k in range(3)]}
