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
from .. import checker
from ..certificates.format import Certificate, certificate_text
from ..certificates.schedule import schedule_data
from ..exact.matrix import echelon, identity, of, rows, trace, zeros
from ..exact.rational import rational


def plant_data(plant: LinearPlant) -> dict[str, object]:
    """The three matrices as certificate data."""
    return {"plant": dict(plant.exact)}


def data_of(plant: LinearPlant) -> dict[str, object]:
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
    A, F = of(plant.exact["A"]), of(plant.exact["B"]) * of(plant.exact["K"])
    for side, (first, second) in {"left": (A, F), "right": (A.transpose(), F.transpose())}.items():
        for W in _parts(first, second):
            S, R = _carried(W, first), _carried(W, second)
            growth = period * trace(S) - total * trace(R)
            if growth < 0:
                continue
            witness = {"side": side, "W": rows(W), "S": rows(S), "R": rows(R)}
            found = Certificate("floquet-liouville", data_of(plant), {"growth": growth}, witness)
            if _accepted(found):
                return found
    return None


def falling_function(plant: LinearPlant) -> Certificate | None:
    """Certificate that x'Px falls at every gain, or over a period of commuting motions; or None."""
    period, total = plant.schedule.period, mean_gain(plant)
    assert period is not None
    A, F = of(plant.exact["A"]), of(plant.exact["B"]) * of(plant.exact["K"])
    tries: list[tuple[dict[str, object], Any]] = []
    if A * F == F * A:
        tries.append(({"form": "commuting"}, A * rational(period) - F * rational(total)))
    least, greatest = _gain_range(plant)
    tries.append(({"form": "gains", "least": least, "greatest": greatest}, A - F * rational(total / period)))
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
    yield identity(n)
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
    n = S.nrows()
    total = zeros(n, n)
    for c in reversed(p.coeffs()):
        total = total * S + identity(n) * c
    return total


def _carried(W: Any, A: Any) -> Any:
    """S with W A = S W, for rows W that A carries along."""
    return W * A * W.transpose() * (W * W.transpose()).inv()


def _left_kernel(M: Any) -> Any:
    """Rows v with v M = 0, or None if there is only v = 0."""
    reduced, pivots = echelon(M.transpose())
    free = [j for j in range(M.nrows()) if j not in pivots]
    if not free:
        return None
    kernel = zeros(len(free), M.nrows())
    for place, column in enumerate(free):
        kernel[place, column] = 1
        for i, j in enumerate(pivots):
            kernel[place, j] = -reduced[i, column]
    return kernel


def _beside(parts: list[Any]) -> Any:
    n, width = parts[0].nrows(), parts[0].ncols()
    whole = zeros(n, width * len(parts))
    for place, part in enumerate(parts):
        for i in range(n):
            for j in range(width):
                whole[i, place * width + j] = part[i, j]
    return whole


def _lyapunov(field: Any) -> list[list[Fraction]] | None:
    """A rational P, near the solution of N'P + P N = -I in balanced coordinates; None if N is not stable."""
    from scipy.linalg import LinAlgError, matrix_balance, solve_continuous_lyapunov

    N = np.array([[float(x) for x in row] for row in rows(field)])
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
