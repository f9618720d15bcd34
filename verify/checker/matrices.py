"""Matrices of rationals."""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction

from .exact_numbers import Matrix, show


def is_symmetric(A: Matrix) -> bool:
    """Whether a matrix is square and symmetric."""
    n = len(A)
    return all(len(row) == n for row in A) and all(A[i][j] == A[j][i] for i in range(n) for j in range(i))


def is_positive_semidefinite(A: Matrix) -> bool:
    """Decide x'Ax >= 0 for all x, exactly, by symmetric elimination."""
    if not is_symmetric(A):
        return False
    A = [list(row) for row in A]
    n = len(A)
    for k in range(n):
        pivot = A[k][k]
        if pivot < 0 or (pivot == 0 and any(A[i][k] != 0 for i in range(k + 1, n))):
            return False
        if pivot == 0:
            continue
        for i in range(k + 1, n):
            factor = A[i][k] / pivot
            if factor:
                for j in range(k + 1, n):
                    A[i][j] -= factor * A[k][j]
    return True


def is_positive_definite(A: Matrix) -> bool:
    """Decide x'Ax > 0 for all x != 0, exactly: every pivot of the elimination is positive."""
    if not is_symmetric(A):
        return False
    A = [list(row) for row in A]
    n = len(A)
    for k in range(n):
        if A[k][k] <= 0:
            return False
        for i in range(k + 1, n):
            factor = A[i][k] / A[k][k]
            for j in range(k + 1, n):
                A[i][j] -= factor * A[k][j]
    return True


def show_matrix(A: Sequence[Sequence[Fraction]]) -> str:
    """Return a matrix for people."""
    return "[" + ", ".join("[" + ", ".join(show(x) for x in row) + "]" for row in A) + "]"


def inverse_matrix(A: Matrix) -> Matrix:
    """Return the inverse of a positive definite 3 by 3 matrix."""
    cofactor = [
        [
            A[(i + 1) % 3][(j + 1) % 3] * A[(i + 2) % 3][(j + 2) % 3]
            - A[(i + 1) % 3][(j + 2) % 3] * A[(i + 2) % 3][(j + 1) % 3]
            for j in range(3)
        ]
        for i in range(3)
    ]
    determinant = sum((A[0][j] * cofactor[0][j] for j in range(3)), Fraction(0))
    return [[cofactor[j][i] / determinant for j in range(3)] for i in range(3)]


def norm(A: Matrix) -> Fraction:
    """Largest row sum of absolute values."""
    return max(sum((abs(x) for x in row), Fraction(0)) for row in A)


def matrix_product(A: Matrix, B: Matrix) -> Matrix:
    """Return A B."""
    columns = list(zip(*B, strict=True))
    return [[sum((a * b for a, b in zip(row, c, strict=True)), Fraction(0)) for c in columns] for row in A]
