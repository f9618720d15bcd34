"""States with V' > 0, exactly, and their certificates; below the sharp condition they can be constructed."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.rigid_body import RigidBody
from .. import checker
from ..certificates.format import Certificate, certificate_text
from ..certificates.program import NotAlgebraicError
from ..exact.direction import rational_direction, sphere_point
from ..exact.matrix import Rows, shifted
from ..exact.rational_quantity import rational_quantity
from ..verdict import Witness
from .candidates import Candidate
from .definiteness import negative_direction
from .exact_states import ExactDerivative, ExactState
from .forms import inertia_data, law_form, parameter_data, storage_form

SIZES = tuple(Fraction(1, 2**n) for n in range(2, 40, 3))


@final
@dataclass(frozen=True)
class Refutation:
    """A state with V' > 0 at one inertia, exactly."""

    state: ExactState
    inertia: Rows
    witness: Witness


def at_state(candidate: Candidate, J: Rows, weight: Fraction, state: ExactState) -> Refutation | None:
    """Return the refutation by a state, or None if V' <= 0 there.

    Raises
    ------
    ArithmeticError, ValueError
        If V' cannot be evaluated without rounding.
    """
    rate, reference, _ = ExactDerivative(candidate, J, weight=weight).at(state)
    if rate <= 0:
        return None
    values = state.floats() | {"W": float(reference), "inertia": [float(x) for row in J for x in row]}
    if candidate.floor is not None:
        values["k_target"] = float(state.floor)
    witness = Witness("at this state V grows", values, rational_quantity("V'", rate))
    return Refutation(state, J, witness)


def refute_sign(candidate: Candidate, J: Rows, weight: Fraction) -> Refutation | None:
    """State of the family's own construction with V' > 0 at one inertia, or None."""
    tried = (at_state(candidate, J, weight, state) for state in _family_states(candidate, J, weight))
    return next((found for found in tried if found is not None), None)


def counterexample(
    candidate: Candidate,
    refutation: Refutation,
    body: RigidBody,
    *,
    tolerance: Rows | None,
    weight: Fraction,
) -> Certificate | None:
    """Certificate of V' > 0 that the checker accepts; None for laws it cannot compute."""
    try:
        law, storage = law_form(candidate.loop), storage_form(candidate, weight=weight)
    except NotAlgebraicError:
        return None
    storage.pop("reference")
    rows = None if tolerance is None else tuple(tuple(row) for row in tolerance)
    data = {
        **inertia_data(body.exact_inertia, rows),
        "law": law,
        "parameters": parameter_data(candidate.loop),
    }
    signals = list(candidate.loop.time_symbols.signals)
    domain = "above floor" if candidate.floor is not None else "everywhere"
    claim: dict[str, object] = {"storage": storage, "domain": domain}
    claim["state"] = refutation.state.claimed(signals)
    if "inertia_tolerance" in data:
        claim["inertia"] = refutation.inertia
    certificate = Certificate("lyapunov-counterexample", data, claim)
    findings = checker.check_text(certificate_text([certificate]))
    return certificate if all(finding.valid for finding in findings) else None


def _family_states(candidate: Candidate, J: Rows, weight: Fraction) -> Iterator[ExactState]:
    """States with g = 0 near the equilibrium: bv = s x, Omega = 2 lambda s x with 4 lambda^2 x'Jx < a x'x.

    There Q = s^2 lambda (a - 4 lambda^2 x'Jx) + O(s^4) > 0.
    """
    parameters = candidate.loop.law.parameters
    if candidate.right_side is None or "lambda" not in parameters:
        return
    lam = parameters["lambda"]
    x = negative_direction(shifted(J, 4 * lam**2, parameters.get("a", weight)), strict=False)
    if x is None:
        return
    length = math.sqrt(sum(float(v) ** 2 for v in x))
    for digits in (10**3, 10**6, 10**12):
        n = rational_direction([float(v) / length for v in x], denominator=digits)
        for t in SIZES:
            cosine, sine = sphere_point([t])
            yield ExactState(
                quaternion=(cosine, *(sine * v for v in n)),
                rate=tuple(2 * lam * sine * v for v in n),
                controller={s.name: Fraction(2) for s in candidate.loop.law.controller_states},
                gain=Fraction(0),
                gain_rate=Fraction(0),
            )
