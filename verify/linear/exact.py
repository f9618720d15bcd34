"""Plants told stable or not without their monodromy matrix: carried parts, and quadratic functions that fall.

Liouville: a part y = W x with W A = S W, W B K = R W has k multipliers whose product is
exp(T tr S - tr R int g); a product of modulus >= 1 has a factor of modulus >= 1. This decides exactly what
the thrusters do not reach (Hautus), scalar plants, and a plant whose volume does not shrink.
Lyapunov: x'Px that falls at the least and at the greatest gain, or, where A and B K commute, along
T A - (int g) B K, decides stable plants however stiff.
"""

from __future__ import annotations

import warnings
from collections.abc import Iterator
from fractions import Fraction
from typing import Any

import numpy as np

from ...models.linear import LinearPlant
from ...models.types import ExactMatrix
from .. import checker
from ..certificates.format import Certificate, certificate_text
from ..certificates.schedule import schedule_data


def plant_data(plant: LinearPlant) -> dict[str, Any]:
    """The three matrices as certificate data."""
    return {"plant": dict(plant.exact)}


def data_of(plant: LinearPlant) -> dict[str, Any]:
    """The plant and its schedule as certificate data."""
    return plant_data(plant) | {"schedule": schedule_data(plant.schedule)}


def mean_gain(plant: LinearPlant) -> Fraction:
    """Integral of g over a period, s."""
    profile = plant.schedule.profile
    return sum(
        (
            (piece.end - piece.start) * c / (j + 1)
            for piece in profile.pieces
            for j, c in enumerate(piece.shape)
        ),
        Fraction(0),
    )


def growing_part(plant: LinearPlant) -> Certificate | None:
    """Certificate that a carried part does not shrink, so that some multiplier has modulus >= 1; or None."""
    period, total = plant.schedule.period, mean_gain(plant)
    assert period is not None
    A, F = _matrix(plant.exact["A"]), _matrix(plant.exact["B"]) * _matrix(plant.exact["K"])
    for side, (first, second) in {"left": (A, F), "right": (A.transpose(), F.transpose())}.items():
        for W in _parts(first, second):
            S, R = _carried(W, first), _carried(W, second)
            growth = period * _trace(S) - total * _trace(R)
            if growth < 0:
                continue
            witness = {"side": side, "W": _rows(W), "S": _rows(S), "R": _rows(R)}
            found = Certificate("floquet-liouville", data_of(plant), {"growth": growth}, witness)
            if _accepted(found):
                return found
    return None


def falling_function(plant: LinearPlant) -> Certificate | None:
    """Certificate that x'Px falls at every gain, or over a period of commuting motions; or None."""
    period, total = plant.schedule.period, mean_gain(plant)
    assert period is not None
    A, F = _matrix(plant.exact["A"]), _matrix(plant.exact["B"]) * _matrix(plant.exact["K"])
    tries: list[tuple[dict[str, Any], Any]] = []
    if A * F == F * A:
        tries.append(({"form": "commuting"}, _scaled(A, period) - _scaled(F, total)))
    least, greatest = _gain_range(plant)
    tries.append(({"form": "gains", "least": least, "greatest": greatest}, A - _scaled(F, total / period)))
    for form, field in tries:
        P = _lyapunov(field)
        if P is None:
            continue
        found = Certificate("floquet-lyapunov", data_of(plant), {"side": "below"}, form | {"P": P})
        if _accepted(found):
            return found
    return None


def _accepted(certificate: Certificate) -> bool:
    (finding,) = checker.check_text(certificate_text([certificate]))
    return finding.valid


def _gain_range(plant: LinearPlant) -> tuple[Fraction, Fraction]:
    """Rationals around the values of g, a little apart from its extremes where those are not 0 or 1."""
    values: list[float] = []
    for shape in set(plant.schedule.profile.shapes):
        s = np.linspace(0.0, 1.0, 257)
        values += list(np.polynomial.polynomial.polyval(s, [float(c) for c in shape] or [0.0]))
    room = Fraction(1, 2**20)
    low, high = Fraction(min(values)), Fraction(max(values))
    return (Fraction(0) if low >= 0 else low - room), (Fraction(1) if abs(high - 1) < room else high + room)


def _parts(A: Any, F: Any) -> Iterator[Any]:
    """Row spaces that A and F carry along, widest first: all, what F does not enter, and its own parts.

    The part that F does not enter is split by the irreducible factors of its characteristic polynomial, so
    that one growing mode is not hidden by others that shrink.
    """
    n = A.nrows()
    yield _identity(n)
    power, columns = F, []
    for _ in range(n):
        columns.append(power)
        power = A * power
    free = _left_kernel(_beside(columns))
    if free is None:
        return
    yield free
    S = _carried(free, A)
    _, factors = S.charpoly().factor()
    for factor, _ in factors:
        kernel = _left_kernel(_polynomial_at(factor, S))
        if kernel is not None:
            yield kernel * free


def _polynomial_at(p: Any, S: Any) -> Any:
    total = _scaled(S, Fraction(0))
    for c in reversed(p.coeffs()):
        total = total * S + _scaled(_identity(S.nrows()), Fraction(int(c.p), int(c.q)))
    return total


def _carried(W: Any, A: Any) -> Any:
    """S with W A = S W, for rows W that A carries along."""
    return W * A * W.transpose() * (W * W.transpose()).inv()


def _left_kernel(M: Any) -> Any:
    """Rows v with v M = 0, or None if there is only v = 0."""
    reduced, rank = M.transpose().rref()
    n = M.nrows()
    if rank == n:
        return None
    pivots = [next(j for j in range(n) if reduced[i, j] != 0) for i in range(rank)]
    rows = []
    for free in (j for j in range(n) if j not in pivots):
        row = [0] * n
        row[free] = 1
        for i, j in enumerate(pivots):
            row[j] = -reduced[i, free]
        rows.append(row)
    return _flint(rows)


def _beside(parts: list[Any]) -> Any:
    return _flint([[x for part in parts for x in part.tolist()[i]] for i in range(parts[0].nrows())])


def _trace(M: Any) -> Fraction:
    total = sum((M[i, i] for i in range(M.nrows())), M[0, 0] * 0)
    return Fraction(int(total.p), int(total.q))


def _lyapunov(field: Any) -> list[list[Fraction]] | None:
    """A rational P, near the solution of N'P + P N = -I in balanced coordinates; None if N is not stable."""
    from scipy.linalg import LinAlgError, matrix_balance, solve_continuous_lyapunov

    N = np.array([[float(x) for x in row] for row in _rows(field)])
    try:
        balanced, T = matrix_balance(N, permute=False)
        if not np.linalg.eigvals(balanced).real.max() < 0:
            return None
        with warnings.catch_warnings():  # P is only proposed: what it proves is checked exactly
            warnings.simplefilter("ignore")
            P = solve_continuous_lyapunov(balanced.T, -np.abs(balanced).max() * np.eye(len(N)))
    except (LinAlgError, ValueError):
        return None
    inverse = np.diag(1 / np.diag(T))
    P = inverse @ (P + P.T) @ inverse
    if not np.isfinite(P).all() or not np.abs(P).max() > 0:
        return None
    P = P / np.abs(P).max()
    return [[Fraction(x) for x in row] for row in ((P + P.T) / 2).tolist()]


def _flint(rows: list[list[Any]]) -> Any:
    import flint

    return flint.fmpq_mat([[flint.fmpq(x) for x in row] for row in rows])


def _matrix(rows: ExactMatrix) -> Any:
    import flint

    return flint.fmpq_mat([[flint.fmpq(x.numerator, x.denominator) for x in row] for row in rows])


def _identity(n: int) -> Any:
    return _flint([[int(i == j) for j in range(n)] for i in range(n)])


def _scaled(M: Any, factor: Fraction) -> Any:
    import flint

    return M * flint.fmpq(factor.numerator, factor.denominator)


def _rows(M: Any) -> list[list[Fraction]]:
    return [[Fraction(int(x.p), int(x.q)) for x in row] for row in M.tolist()]
