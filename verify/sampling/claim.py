"""Sampling as evidence under a claim: it can refute one, with a witness, and never proves one."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

import numpy as np

from ...models.rigid_body import RigidBody
from ..verdict import Claim, Evidence, EvidenceKind, Verdict, Witness
from .function import DerivativeFunction
from .sampling import ROUNDING, DerivativeSamples
from .witness import exact_witness

SOURCE = "Ram & Akella, AAS 21-402, stability analysis"


@final
class ContradictionError(RuntimeError):
    """A claim was proved and a witness against it was found: one of the two is a mistake of the package."""


@final
@dataclass(frozen=True)
class SampledDerivative:
    """What sampling says of one law: evidence for two claims, and a witness against either if there is one.

    Attributes
    ----------
    samples : DerivativeSamples
    sign : evidence about V' <= 0
    sign_witness : state with V' > 0, confirmed in balls, or None
    identity : evidence about V' = its stated closed form; None outside the family
    identity_witness : state in which the two differ, confirmed in balls, or None
    """

    samples: DerivativeSamples
    sign: Evidence
    sign_witness: Witness | None
    identity: Evidence | None
    identity_witness: Witness | None


def interpret(
    check: DerivativeFunction,
    body: RigidBody,
    samples: DerivativeSamples,
    *,
    weight: Fraction = Fraction(1),
    gain_target: Fraction = Fraction(0),
) -> SampledDerivative:
    """Turn what sampling found into evidence, and violations into exact witnesses."""
    sign_witness = identity_witness = None
    if samples.worst.value < 0 or samples.violations:
        for state in samples.candidates:
            sign_witness = exact_witness(
                check, body, samples.domain, state, weight=weight, gain_target=gain_target
            )
            if sign_witness is not None:
                break
    if samples.identity_residual is not None and samples.identity_residual > ROUNDING:
        identity_witness = exact_witness(
            check, body, samples.domain, samples.identity_state,
            weight=weight, gain_target=gain_target, violated="stated",
        )  # fmt: skip
    identity = _identity_evidence(samples) if samples.identity_residual is not None else None
    return SampledDerivative(
        samples, _sign_evidence(samples, sign_witness), sign_witness, identity, identity_witness
    )


def with_samples(claim: Claim, evidence: Evidence, witness: Witness | None) -> Claim:
    """Put sampled evidence under a claim; a witness turns UNDECIDED into REFUTED.

    Raises
    ------
    ContradictionError
        If the claim stands as PROVED and the witness refutes it.
    """
    supported = replace(claim, evidence=(*claim.evidence, evidence))
    if witness is None or claim.verdict is Verdict.REFUTED:
        return supported
    if claim.verdict is Verdict.PROVED:
        raise ContradictionError(
            f"{claim.key} was proved, yet {witness.description} it is violated: "
            f"{witness.values}; please report this"
        )
    return replace(supported, verdict=Verdict.REFUTED, witness=witness, reason="", next_step="")


def _sign_evidence(samples: DerivativeSamples, witness: Witness | None) -> Evidence:
    count = samples.sampling.count
    found = f"V' > 0 in {samples.violations:,}" if samples.violations else "no violation in"
    bound = ""
    if samples.worst_bound is not None:
        number = samples.bound_violations
        bound = f"; above the paper's bound in {number:,}" if number else "; never above the paper's bound"
    # Where the search ran off to a state too small to confirm, the samples' own worst is stated.
    confirmed = samples.worst.value >= 0 or witness is not None
    search = f", {samples.worst.value:.6g} 1/s after a gradient search" if confirmed else ""
    return Evidence(
        kind=EvidenceKind.SAMPLES,
        summary=(
            f"{found}{' of' if samples.violations else ''} {count:,} samples{bound}; "
            f"least -V'/W {samples.sampled_worst:.6g} 1/s in the samples{search}"
        ),
        source="scrambled Sobol points, then L-BFGS-B from the worst",
        details=_details(samples, samples.worst.coordinates)
        | {
            "violations": samples.violations,
            "bound_violations": samples.bound_violations,
            "least_margin_in_samples": samples.sampled_worst,
            "least_margin_after_search": samples.worst.value,
            "gradient_evaluations": samples.search_evaluations,
        }
        | ({} if samples.worst_bound is None else {"least_margin_to_bound": samples.worst_bound.value}),
    )


def _identity_evidence(samples: DerivativeSamples) -> Evidence:
    residual = samples.identity_residual
    assert residual is not None
    return Evidence(
        kind=EvidenceKind.SAMPLES,
        summary=(
            f"V' by automatic differentiation and V' as stated differ by at most {residual:.2g} "
            f"relative to the terms that cancel, over {samples.sampling.count:,} samples"
        ),
        source="scrambled Sobol points",
        details=_details(samples, samples.identity_state) | {"largest_residual": residual},
    )


def _details(samples: DerivativeSamples, state: Sequence[float] | np.ndarray) -> dict[str, object]:
    return {
        "count": samples.sampling.count,
        "seed": samples.sampling.seed,
        "domain": samples.domain.describe(),
        "state": [float(x) for x in state],
        "state_order": [
            "b0",
            "b1",
            "b2",
            "b3",
            "Omega1",
            "Omega2",
            "Omega3",
            *samples.domain.names,
            "g",
            "g'",
        ],
    }
