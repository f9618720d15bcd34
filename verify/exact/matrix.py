"""Rational matrices: algebra by python-flint, definiteness decided exactly, eigenvalues bounded.

Callers hold matrices as rows of `Fraction`; `of` and `rows` lead to flint and back. Whoever has more
than one operation to do stays in flint between them.
"""

from __future__ import annotations

from collections.abc import Sequence
from fractions import Fraction
from typing import Any

from flint import fmpq_mat

from .rational import fraction, rational

Rows = Sequence[Sequence[Fraction]]
Matrix = tuple[tuple[Fraction, ...], ...]
Vector = Sequence[Fraction]


def of(entries: Sequence[Sequence[Fraction | float | int]]) -> Any:
    """Return rows as a flint matrix, floats at their binary value."""
    return fmpq_mat([[rational(x) for x in row] for row in entries])


def rows(M: Any) -> Matrix:
    """Return a flint matrix as rows."""
    return tuple(tuple(fraction(x) for x in row) for row in M.tolist())


def identity(n: int) -> Any:
    """Return the identity as a flint matrix."""
    return of([[int(i == j) for j in range(n)] for i in range(n)])


def zeros(height: int, width: int) -> Any:
    """Return a flint matrix of zeros, to be filled."""
    return fmpq_mat(height, width)


def echelon(M: Any) -> tuple[Any, list[int]]:
    """Reduced row echelon form of a flint matrix, and the columns of its pivots."""
    reduced, rank = M.rref()
    pivots: list[int] = []
    for i in range(rank):
        first = pivots[-1] + 1 if pivots else 0
        pivots.append(next(j for j in range(first, M.ncols()) if reduced[i, j] != 0))
    return reduced, pivots


def trace(M: Any) -> Fraction:
    """Return the sum of the diagonal of a flint matrix."""
    return sum((fraction(M[i, i]) for i in range(M.nrows())), Fraction(0))


def unit(axis: int) -> Matrix:
    """Return e e' for the unit vector of an axis, (3, 3)."""
    return tuple(tuple(Fraction(int(i == j == axis)) for j in range(3)) for i in range(3))


def skew(a: Vector) -> Any:
    """Return S(a) with S(a) b = a x b as a flint matrix, (3, 3)."""
    return of([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def inverse(A: Rows) -> Matrix:
    """Return A^-1.

    Raises
    ------
    ZeroDivisionError
        If there is none.
    """
    return rows(of(A).inv())


def congruent(H: Rows, B: Rows) -> Matrix:
    """Return B'HB."""
    right = of(B)
    return rows(right.transpose() * of(H) * right)


def quadratic_form(A: Rows, x: Vector) -> Fraction:
    """Return x'Ax."""
    return sum((x[i] * a * x[j] for i, row in enumerate(A) for j, a in enumerate(row) if a), Fraction(0))


def combination(weights: Sequence[Fraction], matrices: Sequence[Rows]) -> Matrix:
    """Return the sum of matrices of one shape, each times its weight."""
    total = of(matrices[0]) * rational(weights[0])
    for weight, M in zip(weights[1:], matrices[1:], strict=True):
        total += of(M) * rational(weight)
    return rows(total)


def shifted(A: Rows, factor: Fraction, shift: Fraction) -> Matrix:
    """Return factor A - shift I."""
    return tuple(
        tuple(factor * x - (shift if i == j else 0) for j, x in enumerate(row)) for i, row in enumerate(A)
    )


def is_positive_definite(A: Rows | fmpq_mat) -> bool:
    """Decide x'Ax > 0 for all x != 0, exactly, for a symmetric matrix (rows, or flint's)."""
    return all(c > 0 for c in _signed_characteristic(A))


def is_positive_semidefinite(A: Rows | fmpq_mat) -> bool:
    """Decide x'Ax >= 0 for all x, exactly, for a symmetric matrix (rows, or flint's)."""
    return all(c >= 0 for c in _signed_characteristic(A))


def _signed_characteristic(A: Rows | fmpq_mat) -> list[Any]:
    """Coefficients of det(t I + A), lowest first: sums of principal minors.

    The roots are minus the eigenvalues, all real: none is positive (negative) if and only if no
    coefficient is negative (every one is positive).
    """
    coefficients = (A if isinstance(A, fmpq_mat) else of(A)).charpoly().coeffs()
    n = len(coefficients) - 1
    return [c if (n - k) % 2 == 0 else -c for k, c in enumerate(coefficients)]


def least_eigenvalue_below(A: Rows) -> Fraction:
    """Return a rational <= the least eigenvalue of a symmetric matrix, about 1e-14 of its size from it.

    LAPACK proposes, exact arithmetic decides: unlike a ball around each root that needs no gap
    between the eigenvalues, and the number is short.
    """
    import numpy as np

    guess = float(np.linalg.eigvalsh(np.array([[float(x) for x in row] for row in A]))[0])
    scale = max(abs(float(x)) for row in A for x in row)
    step = 1e-14 * scale
    while True:
        bound = Fraction(guess - step)
        if is_positive_semidefinite(shifted(A, Fraction(1), bound)):
            return bound
        step *= 4


def greatest_eigenvalue_above(A: Rows) -> Fraction:
    """Return a rational >= the greatest eigenvalue of a symmetric matrix."""
    return -least_eigenvalue_below([[-x for x in row] for row in A])


def elimination(A: Rows) -> tuple[list[list[Fraction]], list[Fraction]]:
    """Return L, unit lower triangular, and the diagonal D of A = L D L' of a symmetric matrix.

    A pivot of 0 is passed over: below it A must be 0 too for the product to be A, as it is if A >= 0.
    """
    n = len(A)
    work = [list(row) for row in A]
    L = [[Fraction(int(i == j)) for j in range(n)] for i in range(n)]
    for k in range(n):
        for i in range(k + 1, n):
            L[i][k] = work[i][k] / work[k][k] if work[k][k] else Fraction(0)
            for j in range(k + 1, n):
                work[i][j] -= L[i][k] * work[k][j]
    return L, [work[k][k] for k in range(n)]
