"""States with V' > 0, exactly, constructed for the weighted family below its sharp condition."""

from __future__ import annotations

import math
from collections.abc import Iterator
from fractions import Fraction

from ..checker import Matrix
from ..rational_quantity import rational_quantity
from ..verdict import Witness
from .candidates import Candidate
from .definiteness import negative_direction, shifted
from .exact_states import ExactDerivative, ExactState, rational_direction

SIZES = tuple(Fraction(1, 2**n) for n in range(2, 40, 3))


def refute_sign(candidate: Candidate, J: Matrix, weight: Fraction) -> Witness | None:
    """State of the family's own construction with V' > 0 at one inertia, or None."""
    derivative = ExactDerivative(candidate, J, weight=weight)
    for state in _family_states(candidate, J, weight):
        rate, reference, _ = derivative.at(state)
        if rate > 0:
            violation = rational_quantity("V'", rate)
            values = state.floats() | {"W": float(reference), "inertia": [float(x) for row in J for x in row]}
            return Witness("at this state V grows", values, violation)
    return None


def _family_states(candidate: Candidate, J: Matrix, weight: Fraction) -> Iterator[ExactState]:
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
            cosine, sine = (1 - t * t) / (1 + t * t), 2 * t / (1 + t * t)
            yield ExactState(
                quaternion=(cosine, *(sine * v for v in n)),
                rate=tuple(2 * lam * sine * v for v in n),
                controller={s.name: Fraction(2) for s in candidate.loop.law.controller_states},
                gain=Fraction(0),
                gain_rate=Fraction(0),
            )
