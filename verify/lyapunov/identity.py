"""The identity V' = R Q + g^2 (1 - k* R) P, proved as polynomials for every inertia and parameter."""

from __future__ import annotations

import random
from fractions import Fraction

from ...models.closed_loop import ClosedLoop
from .. import checker
from ..certificates.format import Certificate, certificate_text
from ..certificates.program import NotAlgebraicError
from ..claim_table import CLAIM_KEYS, stated
from ..exact.direction import rational_quaternion
from ..exact.matrix import Rows
from ..exact.rational_quantity import rational_quantity
from ..verdict import Claim, Evidence, EvidenceKind, Verdict, Witness
from .candidates import Candidate
from .exact_states import ExactDerivative, ExactState
from .forms import law_form, storage_form

KEY = "lyapunov.identity"
SOURCE = CLAIM_KEYS[KEY].source
TRIES = 20


def identity_certificate(candidate: Candidate) -> tuple[Certificate, tuple[str, ...]]:
    """Certificate of the identity and the claim in the checker's words.

    Raises
    ------
    ValueError
        If nothing is claimed of V', or the checker refuses it, with the reason.
    """
    if candidate.right_side is None:
        raise ValueError(f"no closed form of V' is stated for law {candidate.loop.law.name}")
    law, storage = law_form(candidate.loop), storage_form(candidate, identity=True)
    certificate = Certificate("lyapunov-identity", {"law": law}, {"storage": storage})
    (finding,) = checker.check_text(certificate_text([certificate]))
    if not finding.valid:
        raise ValueError(finding.reason)
    return certificate, finding.claim


def identity_claim(candidate: Candidate, inertia: Rows) -> Claim | None:
    """Claim the identity (key lyapunov.identity); None for a law without a stated closed form.

    The proof holds for every inertia and all positive parameters; the one given serves to refute.
    """
    if candidate.right_side is None:
        return None
    floor = candidate.floor is not None
    formula = "R Q + g^2 (1 - k* R) P" if floor else "R Q"
    statement = f"V' = {formula} identically, for every inertia and all positive parameters"
    reason = ""
    try:
        certificate, words = identity_certificate(candidate)
    except NotAlgebraicError as error:
        reason = str(error)
    except ValueError as error:
        reason = str(error)
    else:
        evidence = Evidence(
            EvidenceKind.CERTIFICATE,
            "exact polynomial algebra modulo |beta|^2 = 1",
            SOURCE,
            {"certificate": certificate, "claim": list(words)},
        )
        return _claim(statement, Verdict.PROVED, (evidence,))
    witness = refute_identity(candidate, inertia)
    if witness is not None:
        evidence = Evidence(EvidenceKind.WITNESS, "evaluated exactly in rationals", SOURCE)
        return _claim(statement, Verdict.REFUTED, (evidence,), witness=witness)
    return _claim(
        statement, Verdict.UNDECIDED, (), reason=reason, next_step="write the law with + - * / alone"
    )


def refute_identity(candidate: Candidate, inertia: Rows) -> Witness | None:
    """State where V' and the stated closed form differ, exactly; None if a few random states show none."""
    derivative = ExactDerivative(candidate, inertia)
    generator = random.Random(1)  # noqa: S311 (any state will do)
    for _ in range(TRIES):
        state = random_state(candidate.loop, generator)
        try:
            rate, _, stated = derivative.at(state)
        except (ArithmeticError, ValueError):  # not without rounding, at this state
            continue
        if rate != stated:
            violation = rational_quantity("V' - stated V'", rate - stated)
            return Witness("at this state", state.floats(), violation)
    return None


def random_state(loop: ClosedLoop, generator: random.Random) -> ExactState:
    """Draw a state of modest rational coordinates, controller states positive."""

    def draw(low: int, high: int) -> Fraction:
        return Fraction(generator.randint(low, high), 16)

    quaternion = rational_quaternion([generator.gauss(0, 1) for _ in range(4)], denominator=50)
    return ExactState(
        quaternion=quaternion,
        rate=(draw(-32, 32), draw(-32, 32), draw(-32, 32)),
        controller={s.name: draw(8, 48) for s in loop.law.controller_states},
        gain=draw(1, 16),
        gain_rate=draw(-16, 16),
        floor=draw(8, 48),
    )


def _claim(
    statement: str,
    verdict: Verdict,
    evidence: tuple[Evidence, ...],
    *,
    witness: Witness | None = None,
    reason: str = "",
    next_step: str = "",
) -> Claim:
    return stated(KEY, statement, verdict, evidence, witness=witness, reason=reason, next_step=next_step)
