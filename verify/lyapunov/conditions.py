"""Conditions on lambda, decided exactly from the decimal data; sufficient for V' <= 0, never counted.

paper   lambda > max(1/(2 Jmin), 1/2)          Ram & Akella, AAS 21-402
sharp   lambda >= sqrt(a)/(2 sqrt(Jmin))       V' <= 0 everywhere if and only if (a = 1 in the paper)

Jmin is algebraic and never computed: the conditions are 2 lambda J - I > 0 with lambda > 1/2, and
4 lambda^2 J - a I >= 0. With a tolerance on the inertia they are decided at the vertices of the
box, which suffices because they are convex in J.
"""

from __future__ import annotations

from collections.abc import Iterator
from fractions import Fraction
from itertools import product

from ...models.rigid_body import RigidBody
from ..certificates.format import Certificate
from ..claim_table import CLAIM_KEYS, stated
from ..exact.bisection import bisected
from ..exact.matrix import (
    Matrix,
    Rows,
    is_positive_definite,
    is_positive_semidefinite,
    quadratic_form,
    shifted,
)
from ..exact.rational_quantity import rational_quantity
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness
from .definiteness import Direction, factors, negative_direction
from .forms import inertia_data


def paper_condition(lam: Fraction, body: RigidBody, *, tolerance: Rows | None = None) -> Claim:
    """Claim lambda > max(1/(2 Jmin), 1/2) (key lambda.paper)."""
    statement = f"lambda = {float(lam):.9g} 1/s exceeds max(1/(2 Jmin), 1/2)"
    half = Fraction(1, 2)
    if lam < half:
        violation = rational_quantity("1/2 - lambda", half - lam, unit="1/s")
        witness = Witness("lambda itself is below 1/2", {"lambda": float(lam)}, violation)
        return _claim("lambda.paper", statement, Verdict.REFUTED, witness=witness)
    found = _refuting(body, tolerance, lambda J: shifted(J, 2 * lam, Fraction(1)), strict=True)
    if found is not None:
        J, x, value = found
        return _not_met("lambda.paper", statement, J, x, -value, "x'x - 2 lambda x'Jx")
    if lam == half:
        return _at_boundary("lambda.paper", statement)
    witness_factors = [
        factors(shifted(J, 2 * lam, Fraction(1))) for J in vertices(body.exact_inertia, tolerance)
    ]
    certificate = Certificate(
        "paper-condition", _data(lam, body, tolerance), {}, {"factors": witness_factors}
    )
    margin = rational_quantity("lambda - 1/2", lam - half, unit="1/s")
    return _claim("lambda.paper", statement, Verdict.PROVED, certificate=certificate, margins=(margin,))


def sharp_condition(
    lam: Fraction, body: RigidBody, *, weight: Fraction = Fraction(1), tolerance: Rows | None = None
) -> Claim:
    """Claim lambda >= sqrt(a)/(2 sqrt(Jmin)) (key lambda.sharp)."""
    threshold = sharp_threshold(body, weight=weight, tolerance=tolerance)
    if lam <= 0:
        violation = rational_quantity("threshold - lambda", Fraction(threshold.low) - lam, unit="1/s")
        witness = Witness("lambda itself is not positive", {"lambda": float(lam)}, violation)
        statement = f"lambda = {float(lam):.9g} 1/s is at least {threshold.low:.9g} 1/s"
        return _claim("lambda.sharp", statement, Verdict.REFUTED, witness=witness, quantities=(threshold,))
    root = "1/(2 sqrt(Jmin))" if weight == 1 else f"sqrt({float(weight):.6g})/(2 sqrt(Jmin))"
    statement = f"lambda = {float(lam):.9g} 1/s is at least {root}, about {threshold.low:.9g} 1/s"
    found = _refuting(body, tolerance, lambda J: shifted(J, 4 * lam**2, weight), strict=False)
    if found is not None:
        J, x, value = found
        return _not_met("lambda.sharp", statement, J, x, -value, "a x'x - 4 lambda^2 x'Jx", threshold)
    certificate = sharp_certificate(lam, body, weight=weight, tolerance=tolerance)
    low = Fraction(threshold.low), Fraction(threshold.high)
    margin = rational_quantity("lambda - threshold", lam - low[1], lam - low[0], "1/s")
    return _claim(
        "lambda.sharp",
        statement,
        Verdict.PROVED,
        certificate=certificate,
        margins=(margin,),
        quantities=(threshold,),
    )


def sharp_certificate(
    lam: Fraction, body: RigidBody, *, weight: Fraction = Fraction(1), tolerance: Rows | None = None
) -> Certificate:
    """Write the certificate of lambda >= sqrt(a)/(2 sqrt(Jmin)); one the checker refuses if that is false."""
    lower = [factors(shifted(J, 4 * lam**2, weight)) for J in vertices(body.exact_inertia, tolerance)]
    return Certificate("sharp-condition", _data(lam, body, tolerance), {"weight": weight}, {"factors": lower})


def sharp_threshold(
    body: RigidBody, *, weight: Fraction = Fraction(1), tolerance: Rows | None = None
) -> Quantity:
    """Enclosure of sqrt(a)/(2 sqrt(Jmin)), 1/s, by bisection on the exact condition.

    Raises
    ------
    ValueError
        If the tolerance reaches an inertia that is not positive definite, or the weight is not positive.
    """
    if weight <= 0:
        raise ValueError(f"the weight a must be positive, received {float(weight):g}")
    bodies = list(vertices(body.exact_inertia, tolerance))
    if not all(is_positive_definite(J) for J in bodies):
        raise ValueError("the tolerance reaches an inertia that is not positive definite")

    def holds(lam: Fraction) -> bool:
        return all(is_positive_semidefinite(shifted(J, 4 * lam**2, weight)) for J in bodies)

    high = Fraction(1)
    while not holds(high):
        high *= 2
    low, high = bisected(lambda lam: not holds(lam), Fraction(0), high, relative=Fraction(1, 2**50))
    return rational_quantity("sharp_threshold", low, high, "1/s", "least lambda with V' <= 0 everywhere")


def vertices(inertia: Rows, tolerance: Rows | None) -> Iterator[Matrix]:
    """Inertias at the vertices of the box of tolerances, in the order of the certificates."""
    J = [list(row) for row in inertia]
    places = [(i, j) for i in range(3) for j in range(i, 3) if tolerance is not None and tolerance[i][j] > 0]
    for signs in product((-1, 1), repeat=len(places)):
        vertex = [list(row) for row in J]
        for (i, j), sign in zip(reversed(places), signs, strict=True):
            assert tolerance is not None
            vertex[i][j] = vertex[j][i] = J[i][j] + sign * tolerance[i][j]
        yield tuple(map(tuple, vertex))


def _refuting(
    body: RigidBody, tolerance: Rows | None, form: object, *, strict: bool
) -> tuple[Matrix, Direction, Fraction] | None:
    """Inertia and vector at which the condition fails strictly, with the value of the form there."""
    assert callable(form)
    for J in vertices(body.exact_inertia, tolerance):
        A = form(J)
        x = negative_direction(A, strict=strict)
        if x is not None and (value := quadratic_form(A, x)) < 0:
            return J, x, value
    return None


def _data(lam: Fraction, body: RigidBody, tolerance: Rows | None) -> dict[str, object]:
    rows = None if tolerance is None else tuple(tuple(row) for row in tolerance)
    return {**inertia_data(body.exact_inertia, rows), "parameters": {"lambda": lam}}


def _not_met(
    key: str,
    statement: str,
    J: Matrix,
    x: Direction,
    violation: Fraction,
    name: str,
    threshold: Quantity | None = None,
) -> Claim:
    witness = Witness(
        "along the direction x",
        {"x": [float(v) for v in x], "inertia": [float(v) for row in J for v in row]},
        rational_quantity(name, violation),
    )
    quantities = () if threshold is None else (threshold,)
    return _claim(key, statement, Verdict.REFUTED, witness=witness, quantities=quantities)


def _at_boundary(key: str, statement: str) -> Claim:
    return _claim(
        key,
        statement,
        Verdict.UNDECIDED,
        reason="lambda lies exactly on the boundary, where the strict inequality fails by nothing",
        next_step="take lambda larger by any amount, or rely on the sharp condition",
    )


def _claim(
    key: str,
    statement: str,
    verdict: Verdict,
    *,
    certificate: Certificate | None = None,
    witness: Witness | None = None,
    quantities: tuple[Quantity, ...] = (),
    margins: tuple[Quantity, ...] = (),
    reason: str = "",
    next_step: str = "",
) -> Claim:
    evidence: tuple[Evidence, ...] = ()
    source = CLAIM_KEYS[key].source
    if certificate is not None:
        summary = "exact elimination shows the matrix of the condition positive"
        evidence = (Evidence(EvidenceKind.CERTIFICATE, summary, source, {"certificate": certificate}),)
    elif witness is not None:
        evidence = (Evidence(EvidenceKind.WITNESS, "evaluated exactly in rationals", source),)
    return stated(
        key,
        statement,
        verdict,
        evidence,
        quantities,
        margins,
        witness=witness,
        reason=reason,
        next_step=next_step,
    )
