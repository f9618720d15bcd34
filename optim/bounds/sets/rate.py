"""How fast a potential can change: its body gradient divided by the inertia, as exact polynomials.

With x the modified Rodrigues vector, phi' = grad phi . x' = v . (J w) for

    v = 1/4 J^-1 [ (1 - |x|^2) g - 2 x cross g + 2 (x.g) x ],   g = grad phi,

so |phi'| is at most the support function of a set of momenta taken at v.
"""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ....models.types import Array
from ....verify.exact.matrix import Matrix
from ....verify.exact.polynomial import Polynomial
from .polynomials import RING, SQUARED_LENGTH, Exponent, X


def momentum_rate_polynomials(
    potential: Polynomial, inverse_inertia: Matrix, scale: Fraction
) -> tuple[Polynomial, Polynomial, Polynomial]:
    """Return the three components of v for a potential in the scaled coordinates x / scale, in those."""
    gradient = [potential.derivative(axis) for axis in range(3)]
    along = X[0] * gradient[0] + X[1] * gradient[1] + X[2] * gradient[2]
    straight = 1 / scale - SQUARED_LENGTH * scale
    body = []
    for i in range(3):
        j, k = (i + 1) % 3, (i + 2) % 3
        cross = X[j] * gradient[k] - X[k] * gradient[j]
        body.append(straight * gradient[i] - cross * 2 + X[i] * along * (2 * scale))
    rows = [sum((body[j] * (row[j] / 4) for j in range(3)), RING.constant(0)) for row in inverse_inertia]
    return rows[0], rows[1], rows[2]


def rate_features(
    points: Array, table: tuple[Exponent, ...], inverse_inertia: Array, scale: float
) -> tuple[Array, Array]:
    """Return values (n, m) and momentum rates v (n, 3, m) of monomials at scaled points (n, 3), floats."""
    values, gradient = _monomials(points, table)
    x = scale * points
    square = (x * x).sum(axis=1)[:, None, None]
    cross = np.zeros((len(x), 3, 3))
    for i in range(3):
        cross[:, i, (i + 1) % 3], cross[:, i, (i + 2) % 3] = -x[:, (i + 2) % 3], x[:, (i + 1) % 3]
    body = (1 - square) * np.eye(3) - 2 * cross + 2 * x[:, :, None] * x[:, None, :]
    return values, np.matmul((0.25 / scale) * inverse_inertia @ body, gradient)


def _monomials(points: Array, table: tuple[Exponent, ...]) -> tuple[Array, Array]:
    """Values (n, m) and gradients (n, 3, m) of the monomials."""
    E = np.array(table)
    powers = np.ones((len(points), 3, int(E.max()) + 1))
    for k in range(1, powers.shape[2]):
        powers[:, :, k] = powers[:, :, k - 1] * points
    factors = [powers[:, axis, E[:, axis]] for axis in range(3)]
    gradient = np.empty((len(points), 3, len(E)))
    for axis in range(3):
        lowered = E[:, axis] * powers[:, axis, np.maximum(E[:, axis] - 1, 0)]
        np.multiply(lowered * factors[(axis + 1) % 3], factors[(axis + 2) % 3], out=gradient[:, axis])
    return factors[0] * factors[1] * factors[2], gradient
