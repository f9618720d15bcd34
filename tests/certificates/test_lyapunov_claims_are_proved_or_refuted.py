"""Lyapunov claims are PROVED with a certificate the checker accepts, or REFUTED by an exact state."""

import dataclasses
import json
import random
from fractions import Fraction as F

import lyapunov_cases as cases
import numpy as np
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import (
    AdaptiveScalingAsPrinted,
    Control,
    Law,
    PersistenceFilterAsPrinted,
    QuaternionPD,
)
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.exact.direction import rational_direction, rational_quaternion
from intermit.verify.exact.matrix import quadratic_form
from intermit.verify.lyapunov import (
    ExactDerivative,
    NoCertificateError,
    best_weight,
    candidate,
    certificates_of,
    certify_decay,
    identity_claim,
    lyapunov_claims,
    paper_condition,
    sharp_threshold,
)
from intermit.verify.lyapunov.definiteness import negative_direction
from intermit.verify.lyapunov.identity import random_state
from intermit.verify.verdict import Verdict
from problems import paper_schedule

SHARP_J1 = 0.5 / np.sqrt(cases.J1.principal_inertias[0])


def verdicts(law, body, **options):
    return {claim.key: claim for claim in lyapunov_claims(law, body, **options)}


@pytest.mark.parametrize(
    "law", [cases.persistence("0.525"), cases.adaptive("0.525"), cases.adaptive("0.525", "2")]
)
@pytest.mark.parametrize("body", [cases.J1, cases.J2])
def test_above_the_papers_condition_everything_is_proved(law, body):
    claims = lyapunov_claims(law, body)
    assert [c.verdict for c in claims] == [Verdict.PROVED] * 5
    certificates = certificates_of(claims)
    # for the adaptive law the sign and the rate rest on one certificate
    assert len(certificates) == (5 if law.name == "persistence-filter" else 4)
    assert all(f.valid for f in checker.check_text(certificate_text(certificates)))


@pytest.mark.parametrize("law", [cases.persistence, cases.adaptive])
def test_certified_rate_is_within_a_hair_of_the_sharp_one(law):
    proof = certify_decay(candidate(close_loop(law("0.525"))), cases.J1.exact_inertia, weight=F(1))
    exact = 0.525 - SHARP_J1
    assert exact * (1 - 1e-4) < float(proof.rate) < exact


def test_a_rate_above_the_sharp_one_is_not_certified():
    chosen = candidate(close_loop(cases.persistence("0.525")))
    rate = F(0.525 - SHARP_J1) * F("1.0001")
    with pytest.raises(NoCertificateError):
        certify_decay(chosen, cases.J1.exact_inertia, weight=F(1), rate=rate)


@pytest.mark.parametrize("law", [cases.persistence, cases.adaptive])
def test_sharp_condition_separates_proof_from_refutation(law):
    threshold = sharp_threshold(cases.J1)
    assert threshold.low <= SHARP_J1 * (1 + 1e-15)
    assert threshold.high >= SHARP_J1 * (1 - 1e-15)
    below = verdicts(law(F(threshold.low) * F("0.999")), cases.J1)
    above = verdicts(law(F(threshold.high) * F("1.001")), cases.J1)
    assert below["lyapunov.derivative"].verdict is Verdict.REFUTED
    assert below["lyapunov.derivative"].witness.violation.low > 0
    assert below["lambda.sharp"].verdict is Verdict.REFUTED
    assert above["lyapunov.derivative"].verdict is Verdict.PROVED
    assert above["lambda.sharp"].verdict is Verdict.PROVED
    assert above["lambda.paper"].verdict is Verdict.REFUTED


def test_equality_is_proved_where_jmin_is_rational():
    claims = verdicts(cases.persistence("0.25"), cases.diagonal(4, 5, 6))
    assert claims["lambda.sharp"].verdict is Verdict.PROVED
    assert claims["lyapunov.derivative"].verdict is Verdict.PROVED
    claims = verdicts(cases.persistence(F(1, 4) - F(1, 10**12)), cases.diagonal(4, 5, 6))
    assert claims["lambda.sharp"].verdict is Verdict.REFUTED
    assert claims["lyapunov.derivative"].verdict is Verdict.REFUTED


def test_papers_condition_is_strict():
    assert paper_condition(F(1, 2), cases.J1).verdict is Verdict.UNDECIDED
    assert paper_condition(F(1, 2) + F(1, 10**30), cases.J1).verdict is Verdict.PROVED
    assert paper_condition(F(1), cases.diagonal("0.499", 1, 1)).verdict is Verdict.REFUTED
    assert paper_condition(F(1), cases.diagonal("0.501", 1, 1)).verdict is Verdict.PROVED


def test_weighted_family_decays_at_every_lambda():
    claim = verdicts(cases.persistence("0.1"), cases.J1)["lambda.rate"]
    assert claim.verdict is Verdict.PROVED
    rate, weight = claim.quantities
    jmin = cases.J1.principal_inertias[0]
    tight = 0.1 - np.sqrt(weight.low / jmin) / 2
    assert tight * (1 - 1e-3) < rate.low < tight


def test_best_weight_beats_its_neighbours():
    lam, jmin = 0.525, cases.J1.principal_inertias[0]

    def dissipation(a):  # largest rho with a^2 <= 4 (lam - rho) Jmin (a lam - rho)
        sum_, product = lam + a * lam, a * lam**2 - a**2 / (4 * jmin)
        return (sum_ - np.sqrt(sum_**2 - 4 * product)) / 2

    a = float(best_weight(F("0.525"), cases.J1))
    assert dissipation(a) >= max(dissipation(a * 1.01), dissipation(a * 0.99))


def test_inertia_box_is_proved_whole_or_refuted_at_a_vertex():
    law = cases.persistence("0.525")
    narrow = verdicts(law, cases.J1, tolerance=cases.tolerance("0.02"))
    assert narrow["lyapunov.derivative"].verdict is Verdict.PROVED
    point = verdicts(law, cases.J1)
    assert narrow["lyapunov.derivative"].quantities[0].low < point["lyapunov.derivative"].quantities[0].low
    law = cases.persistence("0.345")  # 1.2 % above sharp for J1 itself
    assert verdicts(law, cases.J1)["lyapunov.derivative"].verdict is Verdict.PROVED
    wide = verdicts(law, cases.J1, tolerance=cases.tolerance("0.1"))
    assert wide["lyapunov.derivative"].verdict is Verdict.REFUTED
    assert wide["lambda.sharp"].verdict is Verdict.REFUTED


@pytest.mark.parametrize(
    "law",
    [
        PersistenceFilterAsPrinted(F("0.525"), F(1)),
        AdaptiveScalingAsPrinted(F("0.525"), F("0.1"), F(1), F(0)),
    ],
)
def test_identity_is_refuted_for_the_laws_as_printed(law):
    claim = identity_claim(candidate(close_loop(law)), cases.J1.exact_inertia)
    assert claim.verdict is Verdict.REFUTED
    assert claim.witness is not None


def test_law_without_storage_is_undecided():
    (claim,) = lyapunov_claims(QuaternionPD(F(1), F(1)), cases.J1)
    assert claim.verdict is Verdict.UNDECIDED
    assert "offers no storage function" in claim.reason
    assert "[check] claims" in claim.next_step  # a built-in law cannot be given one


def test_a_law_without_storage_is_told_where_to_return_one():
    @dataclasses.dataclass(frozen=True)
    class Mine(Law):
        name = "mine"

        def control(self, plant, time, states, parameters):
            return Control(-plant.bv)

    (claim,) = lyapunov_claims(Mine(), cases.J1)
    assert "Mine.storage" in claim.next_step
    assert "lambda" not in claim.reason + claim.next_step


def test_a_users_law_goes_through_the_same_pipeline():
    (claim,) = lyapunov_claims(cases.RateDamping(F("0.3")), cases.J1)
    assert claim.verdict is Verdict.PROVED
    (claim,) = lyapunov_claims(cases.HeavierDamping(F("0.525"), F(1), F(2)), cases.J1)
    assert claim.verdict is Verdict.PROVED
    # beside the shared part of the dissipation there is g^2 times a square: the rate stays the sharp one
    assert claim.quantities[0].low == pytest.approx(0.525 - SHARP_J1, rel=1e-3)
    assert all(f.valid for f in checker.check_text(certificate_text(certificates_of([claim]))))


def test_a_users_law_that_is_unstable_is_refuted():
    (claim,) = lyapunov_claims(cases.RateDamping(F("-0.3")), cases.J1)
    assert claim.verdict is Verdict.REFUTED
    (claim,) = lyapunov_claims(cases.HeavierDamping(F("0.525"), F(1), F("0.5")), cases.J1)
    assert claim.verdict is Verdict.REFUTED
    assert claim.witness.violation.low > 0


def test_a_sign_needing_the_range_of_g_holds_for_the_schedule():
    law = cases.PlainDamping(F("0.3"))
    (claim,) = lyapunov_claims(law, cases.J1)
    assert claim.verdict is Verdict.UNDECIDED
    (claim,) = lyapunov_claims(law, cases.J1, schedule=paper_schedule())
    assert claim.verdict is Verdict.PROVED
    assert "0 <= g <= 1" in claim.statement


@pytest.mark.parametrize(
    ("law", "reason"), [(cases.SineFeedback(), "sin"), (cases.Resetting(F(1)), "resets its states")]
)
def test_beyond_the_method_is_undecided_with_the_reason(law, reason):
    (claim,) = lyapunov_claims(law, cases.J1)
    assert claim.verdict is Verdict.UNDECIDED
    assert reason in claim.reason


def test_derivative_as_the_checker_derives_it_equals_the_models():
    """Two derivations of V': the checker's polynomials, and CasADi's chain rule with J^-1."""
    generator = random.Random(3)
    for law in (cases.persistence("0.4"), cases.adaptive("0.4", "1.5"), cases.RateDamping(F("0.3"))):
        chosen = candidate(close_loop(law))
        exact = ExactDerivative(chosen, cases.J1.exact_inertia)
        by_chain_rule = close_loop(law).total_derivative(chosen.value)
        free = ExactDerivative(dataclasses.replace(chosen, derivative=by_chain_rule), cases.J1.exact_inertia)
        for _ in range(5):
            state = random_state(chosen.loop, generator)
            assert exact.at(state)[0] == free.at(state)[0]


def test_negative_directions_are_exact():
    A = [[F(1), F(2), F(0)], [F(2), F(1), F(0)], [F(0), F(0), F(1)]]
    x = negative_direction(A, strict=False)
    assert quadratic_form(A, x) < 0
    A = [[F(0), F(1), F(0)], [F(1), F(5), F(0)], [F(0), F(0), F(1)]]
    x = negative_direction(A, strict=False)
    assert quadratic_form(A, x) < 0
    semidefinite = [[F(1), F(1), F(0)], [F(1), F(1), F(0)], [F(0), F(0), F(1)]]
    assert negative_direction(semidefinite, strict=False) is None
    x = negative_direction(semidefinite, strict=True)
    assert quadratic_form(semidefinite, x) == 0
    assert any(x)


def test_rational_points_lie_on_spheres_near_the_given_ones():
    rng = np.random.default_rng(5)
    for _ in range(50):
        q = rng.normal(size=4)
        q /= np.linalg.norm(q)
        exact = rational_quaternion(q)
        assert sum(x * x for x in exact) == 1
        np.testing.assert_allclose([float(x) for x in exact], q, atol=1e-5)
    n = rational_direction([0.0, -1.0, 0.0])
    assert n == (0, -1, 0)


@pytest.mark.parametrize(
    ("law", "tolerance"),
    [
        (cases.persistence("0.3"), None),
        (cases.adaptive("0.3"), None),
        (cases.persistence("0.345"), cases.tolerance("0.1")),
        (cases.HeavierDamping(F("0.525"), F(1), F("0.5")), None),
        (PersistenceFilterAsPrinted(F("0.525"), F(1)), None),
    ],
)
def test_a_counterexample_is_a_certificate_too(law, tolerance):
    claim = verdicts(law, cases.J1, tolerance=tolerance)["lyapunov.derivative"]
    assert claim.verdict is Verdict.REFUTED
    (certificate,) = certificates_of([claim])
    text = certificate_text([certificate])
    (finding,) = checker.check_text(text)
    assert finding.valid
    assert finding.kind == "lyapunov-counterexample"
    document = json.loads(text)
    state = document["parts"][0]["certificates"][0]["claim"]["state"]
    state["rate"] = ["0", "0", "0"]
    state["g"] = state["g_rate"] = "0"  # nothing moves but the filter: V' = -lambda V
    assert not checker.check_text(json.dumps(document))[0].valid
    state["quaternion"][0] = "2"
    assert "unit norm" in checker.check_text(json.dumps(document))[0].reason


def test_a_counterexample_must_lie_in_the_domain():
    claim = verdicts(cases.adaptive("0.3"), cases.J1)["lyapunov.derivative"]
    document = json.loads(certificate_text(certificates_of([claim])))
    stated = document["parts"][0]["certificates"][0]["claim"]
    stated["state"]["controller"]["R"] = "0.5"  # below R_min = 1/k_target = 1
    assert "below its range" in checker.check_text(json.dumps(document))[0].reason
    stated["state"]["controller"]["R"] = "2"
    stated["inertia"] = [["1", "0", "0"], ["0", "1", "0"], ["0", "0", "1"]]
    assert not checker.check_text(json.dumps(document))[0].valid


def test_a_box_that_reaches_no_inertia_has_no_threshold():
    with pytest.raises(ValueError, match="not positive definite"):
        sharp_threshold(cases.J1, tolerance=cases.tolerance("3"))
