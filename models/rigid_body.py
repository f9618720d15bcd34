"""The rigid body: exact inertia, kinematics and dynamics as CasADi expressions.

Conventions, here once for the whole package: the attitude quaternion is scalar first,
(b0, b1, b2, b3) with b0 = cos(Phi/2), unit norm, target attitude at b0 = +1; rates and torques
are in the body frame; S(x) y = x cross y; SI units.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Any, final

import numpy as np

from .apart import apart
from .types import Array

ExactMatrix = tuple[tuple[Fraction, Fraction, Fraction], ...]


@final
@dataclass(frozen=True)
class RigidBody:
    """Inertia J = J' > 0 about the centre of mass, body frame, kg m^2, exact, shape (3, 3)."""

    exact_inertia: ExactMatrix

    def __post_init__(self) -> None:
        J = self.exact_inertia
        for i in range(3):
            for j in range(i):
                if J[i][j] != J[j][i]:
                    lower, upper = apart(J[i][j], J[j][i])
                    raise ValueError(
                        f"inertia must be symmetric: entry ({i + 1},{j + 1}) is {lower}, "
                        f"entry ({j + 1},{i + 1}) is {upper}"
                    )
        if not all(minor > 0 for minor in leading_minors(J)):
            raise ValueError("inertia must be positive definite")

    @classmethod
    def from_rows(cls, rows: Sequence[Sequence[Fraction | int | float | str]]) -> RigidBody:
        """Build from three rows; strings and fractions stay exact, floats are taken as they are."""
        if len(rows) != 3 or any(len(row) != 3 for row in rows):
            raise ValueError("inertia must have three rows of three numbers (kg m^2)")
        return cls(tuple((Fraction(r[0]), Fraction(r[1]), Fraction(r[2])) for r in rows))

    @cached_property
    def inertia(self) -> Array:
        """J as floats, (3, 3), kg m^2."""
        return np.array([[float(x) for x in row] for row in self.exact_inertia])

    @cached_property
    def exact_inverse(self) -> ExactMatrix:
        """J^-1, exact, (3, 3), 1/(kg m^2)."""
        adjugate, det = _adjugate(self.exact_inertia), leading_minors(self.exact_inertia)[2]
        return tuple((row[0] / det, row[1] / det, row[2] / det) for row in adjugate)

    @cached_property
    def inverse_inertia(self) -> Array:
        """J^-1 as floats, (3, 3), 1/(kg m^2), rounded from the exact inverse."""
        return np.array([[float(x) for x in row] for row in self.exact_inverse])

    @cached_property
    def principal_inertias(self) -> Array:
        """Eigenvalues of J, ascending, (3,), kg m^2 (floats: for proofs enclose them instead)."""
        return np.asarray(np.linalg.eigvalsh(self.inertia), dtype=float)

    @cached_property
    def satisfies_triangle_inequality(self) -> bool:
        """Whether each principal inertia is at most the sum of the other two (exact: tr(J)/2 I - J >= 0)."""
        J = self.exact_inertia
        half = (J[0][0] + J[1][1] + J[2][2]) / 2
        M = [[(half if i == j else Fraction(0)) - J[i][j] for j in range(3)] for i in range(3)]
        adjugate = _adjugate(M)
        minors = (*(M[i][i] for i in range(3)), *(adjugate[i][i] for i in range(3)), leading_minors(M)[2])
        return all(minor >= 0 for minor in minors)


def leading_minors(matrix: Sequence[Sequence[Fraction]]) -> tuple[Fraction, Fraction, Fraction]:
    """Leading principal minors of a 3 by 3 matrix; all positive iff a symmetric one is positive definite."""
    adjugate = _adjugate(matrix)
    det = sum((matrix[0][j] * adjugate[j][0] for j in range(3)), Fraction(0))
    return matrix[0][0], adjugate[2][2], det


def _adjugate(m: Sequence[Sequence[Fraction]]) -> list[list[Fraction]]:
    """Cofactors, transposed, of a 3 by 3 matrix (models go without the proof library)."""

    def cofactor(i: int, j: int) -> Fraction:
        a, b, c, d = (i + 1) % 3, (i + 2) % 3, (j + 1) % 3, (j + 2) % 3
        return m[a][c] * m[b][d] - m[a][d] * m[b][c]

    return [[cofactor(j, i) for j in range(3)] for i in range(3)]


def attitude_rate(b0: Any, bv: Any, w: Any) -> tuple[Any, Any]:
    """Quaternion kinematics: (b0', bv') for the body rate w, rad/s, as CasADi expressions."""
    import casadi as ca

    return -ca.dot(bv, w) / 2, (b0 * w + ca.cross(bv, w)) / 2


def momentum_rate(J: Any, w: Any, torque: Any) -> Any:
    """Euler's equation: J w' = -w x J w + torque, N m, as a CasADi expression (no inverse of J)."""
    import casadi as ca

    return -ca.cross(w, J @ w) + torque
