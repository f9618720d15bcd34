"""All claims about the Lyapunov function of one law on one body."""

from __future__ import annotations

from collections.abc import Iterable
from fractions import Fraction

from ...models.closed_loop import close_loop
from ...models.laws import Law
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ..certificates.format import Certificate
from ..claim_table import stated
from ..exact.matrix import Rows
from ..verdict import Claim, Verdict
from .candidates import NoStorageError, candidate, storage_step
from .conditions import paper_condition, sharp_condition
from .decay import derivative_claim, rate_claim
from .identity import identity_claim


def lyapunov_claims(
    law: Law,
    body: RigidBody,
    *,
    tolerance: Rows | None = None,
    schedule: Schedule | None = None,
) -> tuple[Claim, ...]:
    """Claims lyapunov.identity, lyapunov.derivative, lambda.paper, lambda.sharp, lambda.rate that apply.

    Parameters
    ----------
    law, body : Law, RigidBody
        The closed loop.
    tolerance : (3, 3) exact or None
        Largest deviation of each entry of the inertia, kg m^2; claims then hold for the whole box.
    schedule : Schedule or None
        Where V' <= 0 cannot be certified for every g, certify it for 0 <= g <= the schedule's largest; and
        the phases searched for a violation.

    Notes
    -----
    A law without a storage function gets one UNDECIDED claim that says so; conditions on lambda are
    claimed only of a law whose V' was proved to be the family's. Certificates are in the
    claims' evidence; `certificates_of` collects them.
    """
    try:
        chosen = candidate(close_loop(law))
    except NoStorageError as error:
        return (_no_storage(str(error), storage_step(law)),)
    claims: list[Claim] = []
    identity = identity_claim(chosen, body.exact_inertia)
    claims += [identity] if identity is not None else []
    claims.append(derivative_claim(chosen, body, tolerance=tolerance, schedule=schedule))
    proved = identity is not None and identity.verdict is Verdict.PROVED
    if proved and "lambda" in law.parameters:  # the conditions speak of that V' only
        lam = law.parameters["lambda"]
        claims.append(paper_condition(lam, body, tolerance=tolerance))
        claims.append(
            sharp_condition(lam, body, weight=law.parameters.get("a", Fraction(1)), tolerance=tolerance)
        )
        claims.append(rate_claim(chosen, body, tolerance=tolerance))
    return tuple(claims)


def certificates_of(claims: Iterable[Claim]) -> tuple[Certificate, ...]:
    """Certificates under the claims, in order, each once."""
    found: list[Certificate] = []
    for claim in claims:
        for evidence in claim.evidence:
            certificate = evidence.details.get("certificate")
            if isinstance(certificate, Certificate) and certificate not in found:
                found.append(certificate)
    return tuple(found)


def _no_storage(reason: str, next_step: str) -> Claim:
    statement = "V' <= 0 at every attitude and rate"
    return stated("lyapunov.derivative", statement, Verdict.UNDECIDED, reason=reason, next_step=next_step)
