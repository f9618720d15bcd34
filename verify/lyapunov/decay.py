"""Claims that V' <= 0 (lyapunov.derivative) and that V_a decays at a certified rate (lambda.rate)."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ...models.schedule.polynomial import bernstein
from ..certificates.format import Certificate
from ..claim_table import CLAIM_KEYS, stated
from ..exact.matrix import Rows
from ..exact.rational_quantity import rational_quantity
from ..verdict import Claim, Evidence, EvidenceKind, Quantity, Verdict, Witness
from .candidates import Candidate
from .conditions import sharp_condition, vertices
from .derivative import DecayCertificate, NoCertificateError, certify_decay
from .falsify import falsify
from .identity import identity_certificate
from .refutation import Refutation, counterexample, refute_sign

SOURCE = CLAIM_KEYS["lyapunov.derivative"].source


def derivative_claim(
    candidate: Candidate,
    body: RigidBody,
    *,
    tolerance: Rows | None = None,
    schedule: Schedule | None = None,
) -> Claim:
    """Claim V' <= 0 on the whole domain (key lyapunov.derivative), the paper's V or the law's own.

    For every value of g first; where that fails and a schedule is given, for 0 <= g <= its largest.
    """
    key, weight = "lyapunov.derivative", Fraction(1)
    statement = f"V' <= 0 at every attitude and rate{_where(candidate)}"
    reason = ""
    for bound in (None, *(() if schedule is None else (largest_gain(schedule),))):
        try:
            proof = _certify(candidate, body, tolerance, weight, bound)
        except NoCertificateError as error:
            reason = str(error)
        else:
            within = "" if bound is None else f", 0 <= g <= {float(bound):.6g}"
            rho = _decays(candidate, proof.rate) if proof.rate else "V' <= 0"
            return _proved(key, f"{rho}{_where(candidate)}{within}", proof)
    refutation = _refute(candidate, body, tolerance, weight)
    if refutation is not None:
        return _refuted(key, statement, candidate, refutation, body, tolerance, weight)
    theorem = _by_sharp_condition(candidate, body, tolerance)
    if theorem:
        return _claim(key, statement, Verdict.PROVED, evidence=theorem)
    search = falsify(candidate, body, schedule=schedule, weight=weight)
    if search.refutation is not None and candidate.loop.time_symbols.signals:
        reason = f"V' > 0 at values of {', '.join(candidate.loop.time_symbols.signals)} that may never occur"
        return _claim(key, statement, Verdict.UNDECIDED, reason=reason, next_step=_next_step(candidate))
    if search.refutation is not None:
        return _refuted(key, statement, candidate, search.refutation, body, tolerance, weight)
    reason = f"{reason}; {search.summary}"
    return _claim(key, statement, Verdict.UNDECIDED, reason=reason, next_step=_next_step(candidate))


def rate_claim(
    candidate: Candidate,
    body: RigidBody,
    *,
    tolerance: Rows | None = None,
    weight: Fraction | None = None,
) -> Claim:
    """Claim a positive certified rate: V_a' <= -rho V_a, or -rho W (key lambda.rate).

    The weight a is the law's own where it has one; otherwise, unless given, the one that maximises
    the dissipation rho in V_a' <= -rho V_1.
    """
    if candidate.weight is not None and weight is None:
        weight = best_weight(candidate.loop.law.parameters["lambda"], body, tolerance)
    named = "" if weight is None else f" with a = {float(weight):.6g} kg m^2/s^2"
    statement = f"V{named} decays at a positive rate{_where(candidate)}"
    try:
        proof = _certify(candidate, body, tolerance, weight, None)
    except NoCertificateError as error:
        chosen = Fraction(1) if weight is None else weight
        refutation = _refute(candidate, body, tolerance, chosen)
        if refutation is not None:
            return _refuted("lambda.rate", statement, candidate, refutation, body, tolerance, chosen)
        step = _next_step(candidate)
        return _claim("lambda.rate", statement, Verdict.UNDECIDED, reason=str(error), next_step=step)
    if proof.rate == 0:
        reason = "only V' <= 0 was certified: the best rate is zero or too small to round"
        return _claim(
            "lambda.rate", statement, Verdict.UNDECIDED, reason=reason, next_step=_next_step(candidate)
        )
    sized = f"V{named}: {_decays(candidate, proof.rate)}{_where(candidate)}"
    extra = () if weight is None else (rational_quantity("weight", weight, unit="kg m^2/s^2"),)
    return _proved("lambda.rate", sized, proof, extra)


def largest_gain(schedule: Schedule) -> Fraction:
    """Upper bound on g: the largest Bernstein coefficient of its pieces."""
    return max(max(bernstein(shape), default=Fraction(0)) for shape in schedule.profile.shapes)


def best_weight(lam: Fraction, body: RigidBody, tolerance: Rows | None = None) -> Fraction:
    """Weight a that maximises rho in V_a' <= -rho V_1, to four digits (a choice, not a proof).

    [[(lambda - rho) J, -(a/2) I], [-(a/2) I, (a lambda - rho) I]] >= 0 binds along Jmin; with
    q = lambda^2 Jmin the largest rho is lambda q/(1 + q), at a = 2 q/(1 + q).
    """
    least = min(
        float(np.linalg.eigvalsh(np.array([[float(x) for x in row] for row in J]))[0])
        for J in vertices(body.exact_inertia, tolerance)
    )
    q = float(lam) ** 2 * least
    return Fraction(f"{max(2 * q / (1 + q), 1e-12):.4g}")


def _certify(
    candidate: Candidate,
    body: RigidBody,
    tolerance: Rows | None,
    weight: Fraction | None,
    gain_bound: Fraction | None,
) -> DecayCertificate:
    rows = None if tolerance is None else tuple(tuple(row) for row in tolerance)
    return certify_decay(candidate, body.exact_inertia, tolerance=rows, weight=weight, gain_bound=gain_bound)


def _refute(
    candidate: Candidate, body: RigidBody, tolerance: Rows | None, weight: Fraction
) -> Refutation | None:
    found = (refute_sign(candidate, J, weight) for J in vertices(body.exact_inertia, tolerance))
    try:
        return next((refutation for refutation in found if refutation is not None), None)
    except (ArithmeticError, ValueError):  # V' cannot be evaluated without rounding
        return None


def _refuted(
    key: str,
    statement: str,
    candidate: Candidate,
    refutation: Refutation,
    body: RigidBody,
    tolerance: Rows | None,
    weight: Fraction,
) -> Claim:
    """Claim refuted by a state, with a certificate of V' > 0 there where the checker can compute V'."""
    certificate = counterexample(candidate, refutation, body, tolerance=tolerance, weight=weight)
    details = {} if certificate is None else {"certificate": certificate}
    evidence = Evidence(EvidenceKind.WITNESS, "evaluated exactly in rationals", SOURCE, details)
    return _claim(key, statement, Verdict.REFUTED, evidence=(evidence,), witness=refutation.witness)


def _by_sharp_condition(
    candidate: Candidate, body: RigidBody, tolerance: Rows | None
) -> tuple[Evidence, ...]:
    """Evidence for V' <= 0 from the identity and the sharp condition; empty if one of them is missing."""
    parameters = candidate.loop.law.parameters
    if candidate.right_side is None or "lambda" not in parameters:
        return ()
    weight = parameters.get("a", Fraction(1))
    condition = sharp_condition(parameters["lambda"], body, weight=weight, tolerance=tolerance)
    try:
        certificate, _ = identity_certificate(candidate)
    except ValueError:
        return ()
    if condition.verdict is not Verdict.PROVED:
        return ()
    summary = "V' = R Q + g^2 (1 - k* R) P as polynomials, P >= 0, and Q <= 0 by the sharp condition"
    theorem = Evidence(EvidenceKind.THEOREM, summary, SOURCE, {"certificate": certificate})
    return (theorem, *condition.evidence)


def _next_step(candidate: Candidate) -> str:
    """What may decide it: a larger lambda for the family's V; of a law's own V only its author knows."""
    if candidate.right_side is not None:
        return "raise lambda"
    return (
        f"change the storage function that {type(candidate.loop.law).__name__}.storage returns, or the gains"
    )


def _decays(candidate: Candidate, rate: Fraction) -> str:
    """The rate in words, and what it is a share of."""
    W = "V" if candidate.right_side is None else "R (2 a (1 - b0) + Omega'J Omega)"
    return f"V' <= -rho W with W = {W}, rho = {float(rate):.9g} 1/s"


def _where(candidate: Candidate) -> str:
    if candidate.floor is not None:
        return ", wherever R >= R_min, for every R_min > 0 with k* = 1/R_min"
    return ", R > 0" if "R" in candidate.loop.controller_states else ""


def _proved(key: str, statement: str, proof: DecayCertificate, extra: tuple[Quantity, ...] = ()) -> Claim:
    details: dict[str, Certificate | list[str]] = {
        "certificate": proof.certificate,
        "claim": list(proof.statement),
    }
    evidence = Evidence(
        EvidenceKind.CERTIFICATE,
        "-V' - rho W is a sum of squares on the sphere, in rationals, accepted by the stand-alone checker",
        SOURCE,
        details,
    )
    quantities = (rational_quantity("certified_rate", proof.rate, unit="1/s"), *extra)
    return _claim(key, statement, Verdict.PROVED, evidence=(evidence,), quantities=quantities)


def _claim(
    key: str,
    statement: str,
    verdict: Verdict,
    *,
    evidence: tuple[Evidence, ...] = (),
    witness: Witness | None = None,
    quantities: tuple[Quantity, ...] = (),
    reason: str = "",
    next_step: str = "",
) -> Claim:
    return stated(
        key,
        statement,
        verdict,
        evidence,
        quantities,
        witness=witness,
        reason=reason,
        next_step=next_step,
    )
