"""Sampling and search find every violation that is there, each confirmed exactly, and none that is not."""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import (
    AdaptiveScaling,
    AdaptiveScalingAsPrinted,
    Law,
    PersistenceFilter,
    PersistenceFilterAsPrinted,
)
from intermit.models.rigid_body import RigidBody
from intermit.verify.sampling import (
    DerivativeSamples,
    SampledDerivative,
    SampledDomain,
    Sampling,
    derivative_function,
    interpret,
    sample_derivative,
    with_samples,
)
from intermit.verify.sampling.claim import ContradictionError
from intermit.verify.verdict import Claim, Evidence, EvidenceKind, Verdict

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
FLOOR = F("0.149646")
SHARP = 1 / (2 * math.sqrt(J1.principal_inertias[0]))
"""Least lambda with V' <= 0 for the paper's V, 1/s."""
FEW = Sampling(count=2**12, seed=3)


def law(kind: type[Law], lam: float) -> Law:
    if kind in (AdaptiveScaling, AdaptiveScalingAsPrinted):
        return kind(F(lam), F("0.1"), F(1), F("0.2"))  # type: ignore[call-arg]
    return kind(F(lam), F(1))  # type: ignore[call-arg]


def domain(names: tuple[str, ...]) -> SampledDomain:
    boxes = {"R": (FLOOR, F(4)), "k": (F(0), F(10))}
    return SampledDomain(
        rate=F(2), controller=tuple(boxes[n] for n in names), names=names, gain=F(1), gain_rate=F(15, 8)
    )


def sampled(chosen: Law, sampling: Sampling = FEW) -> tuple[DerivativeSamples, SampledDerivative]:
    check = derivative_function(close_loop(chosen))
    box = domain(tuple(check.loop.controller_states))
    samples = sample_derivative(check, J1, box, gain_target=1 / FLOOR, sampling=sampling)
    return samples, interpret(check, J1, samples, gain_target=1 / FLOOR)


@pytest.mark.parametrize("kind", [PersistenceFilter, AdaptiveScaling])
@pytest.mark.parametrize("factor", [1.001, 1.54])
def test_above_sharp_nothing_is_found_and_the_margin_is_exact(kind: type[Law], factor: float) -> None:
    samples, said = sampled(law(kind, factor * SHARP))
    assert samples.violations == samples.bound_violations == 0
    assert said.sign_witness is None
    assert said.identity_witness is None
    # inf -V'/W = lambda - 1/(2 sqrt(Jmin)): a float's rounding below it, and close above it (the
    # search keeps off the equilibrium by a barrier that costs about 1e-5 of W there).
    exact = (factor - 1) * SHARP
    assert exact - 1e-10 <= samples.worst.value <= exact + 1e-5


@pytest.mark.parametrize("kind", [PersistenceFilter, AdaptiveScaling])
def test_just_below_sharp_a_state_is_found_and_confirmed(kind: type[Law]) -> None:
    _, said = sampled(law(kind, 0.999 * SHARP))
    assert said.sign_witness is not None
    assert said.sign_witness.violation.low > 0


@pytest.mark.parametrize("kind", [AdaptiveScalingAsPrinted, PersistenceFilterAsPrinted])
def test_printed_laws_are_refuted_under_the_papers_lambda(kind: type[Law]) -> None:
    samples, said = sampled(law(kind, 0.525))
    assert samples.violations > 0
    assert said.sign_witness is not None
    assert said.identity_witness is not None


@pytest.mark.parametrize(
    ("kind", "holds"),
    [(PersistenceFilter, True), (AdaptiveScaling, True), (PersistenceFilterAsPrinted, False)],
)
def test_identity_agrees_with_automatic_differentiation(kind: type[Law], holds: bool) -> None:
    samples, _ = sampled(law(kind, 0.525))
    assert samples.identity_residual is not None
    # about 400 operations of half an ulp each, relative to the largest term
    assert (samples.identity_residual < 400 * sys.float_info.epsilon) is holds


def test_witness_is_confirmed_by_hand() -> None:
    """R Q at the witness, from the closed form typed here once more, in floats."""
    _, said = sampled(law(PersistenceFilter, 0.3))
    assert said.sign_witness is not None
    values = said.sign_witness.values
    beta, Omega, R = np.array(values["beta"]), np.array(values["Omega"]), values["R"]
    energy = Omega @ J1.inertia @ Omega
    by_hand = R * (-0.3 * energy - 0.6 * (1 - beta[0]) + beta[1:] @ Omega)
    assert abs(np.linalg.norm(beta) - 1) < 1e-15
    violation = said.sign_witness.violation
    assert by_hand == pytest.approx(violation.low, rel=1e-9)
    assert violation.low <= violation.high <= violation.low * (1 + 1e-12)


def test_same_seed_same_result_and_another_seed_another() -> None:
    first, _ = sampled(law(PersistenceFilter, 0.525))
    again, _ = sampled(law(PersistenceFilter, 0.525))
    other, _ = sampled(law(PersistenceFilter, 0.525), replace(FEW, seed=4))
    assert first.sampled_worst == again.sampled_worst
    assert np.array_equal(first.counts, again.counts)
    assert first.sampled_worst != other.sampled_worst


@pytest.mark.parametrize("count", [1, 100, 2**14 + 5])
def test_every_sample_is_counted_once(count: int) -> None:
    samples, _ = sampled(law(PersistenceFilter, 0.525), Sampling(count=count, seed=1))
    assert samples.counts.sum() == count


def test_attitudes_are_uniform_on_the_sphere() -> None:
    box = domain(("R",))
    points = box.states(np.random.default_rng(5).random((200_000, box.dimension)))
    beta = points[:4]
    assert np.allclose(np.linalg.norm(beta, axis=0), 1, atol=1e-15)
    # the mean of beta beta' is I/4; each entry has a standard error below 0.5/sqrt(N)
    assert np.abs(beta @ beta.T / beta.shape[1] - np.eye(4) / 4).max() < 5 * 0.5 / math.sqrt(200_000)


def test_samples_refute_but_never_prove() -> None:
    open_claim = Claim(
        key="lyapunov.derivative",
        title="t",
        statement="s",
        verdict=Verdict.UNDECIDED,
        reason="r",
        next_step="n",
    )
    _, good = sampled(law(PersistenceFilter, 0.525))
    _, bad = sampled(law(PersistenceFilter, 0.3))
    assert with_samples(open_claim, good.sign, good.sign_witness).verdict is Verdict.UNDECIDED
    assert with_samples(open_claim, bad.sign, bad.sign_witness).verdict is Verdict.REFUTED
    proved = replace(
        open_claim, verdict=Verdict.PROVED, evidence=(Evidence(EvidenceKind.CERTIFICATE, "claimed"),)
    )
    with pytest.raises(ContradictionError, match="was proved"):
        with_samples(proved, bad.sign, bad.sign_witness)
