"""Files made to deceive: each tries one way round the proof of V' <= -rho W, and is refused."""

import json

import lyapunov_cases as cases
import pytest
from intermit.models.closed_loop import close_loop
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.lyapunov import candidate, certify_decay


@pytest.fixture(scope="module")
def document():
    proof = certify_decay(candidate(close_loop(cases.adaptive("0.525"))), cases.J1.exact_inertia)
    return json.dumps(json.loads(certificate_text([proof.certificate])))


def refusal(document, change):
    """Reason why the changed file is refused."""
    copy = json.loads(document)
    part = copy["parts"][0]
    change(part["data"], part["certificates"][0])
    findings = checker.check_text(json.dumps(copy))
    assert not all(f.valid for f in findings)
    return " ".join(f.reason for f in findings)


def test_original_is_valid(document):
    assert all(f.valid for f in checker.check_text(document))


def test_negative_rate(document):
    assert "negative" in refusal(document, lambda _d, c: c["claim"].update(rate="-1"))


def test_wider_domain(document):
    assert refusal(document, lambda _d, c: c["claim"].update(domain="everywhere"))
    assert "no domain" in refusal(document, lambda _d, c: c["claim"].update(domain="somewhere"))


def test_factor_of_unknown_sign(document):
    def change(name, power):
        return lambda _d, c: c["witness"]["sums"][0][0]["factors"].update({name: power})

    for name, power in (("k", "1"), ("b1", "1"), ("s", "-1"), ("R", "1"), ("c", "1"), ("nothing", "2")):
        assert "not known to be >= 0" in refusal(document, change(name, power))
    assert refusal(document, change("g", "1"))  # needs a claim for 0 <= g <= bound


def test_gain_bound_added_changes_the_claim_and_is_not_ignored(document):
    assert "nothing reads" not in refusal(document, lambda _d, c: c["claim"].update(gain_bound="x"))


def test_indefinite_gram_matrix(document):
    def change(d, c):
        gram = c["witness"]["sums"][0][0]["gram"]
        gram[0][0] = "-" + gram[0][0]

    assert "not positive semidefinite" in refusal(document, change)


def test_missing_squares(document):
    assert "differs" in refusal(document, lambda _d, c: c["witness"]["sums"][0].pop())
    assert "each vertex" in refusal(document, lambda _d, c: c["witness"]["sums"].pop())


def test_tolerance_added_needs_its_own_proofs(document):
    tolerance = [["0.1"] * 3] * 3
    assert "each vertex" in refusal(document, lambda d, _c: d.update(inertia_tolerance=tolerance))


@pytest.mark.parametrize("name", ["w1", "b0", "c", "s", "y1", "k_target", "J11", "v1"])
def test_states_that_take_the_name_of_something_else(document, name):
    def change(d, c):
        law = d["law"]
        law["states"].append(name)
        law["rates"][name] = law["rates"]["R"]

    assert refusal(document, change)


def test_parameters_that_take_the_name_of_something_else(document):
    def change(d, c):
        d["law"]["parameters"].append("w1")
        d["parameters"]["w1"] = "0"

    assert "meaning of its own" in refusal(document, change)


def test_redefined_values(document):
    def again(d, c):
        d["law"]["program"].append(d["law"]["program"][-1])

    assert "twice" in refusal(document, again)
    assert "not defined" in refusal(document, lambda d, _c: d["law"]["program"].insert(0, "v900 = neg v901"))
    assert "no operation" in refusal(document, lambda d, _c: d["law"]["program"].append("v900 = sqrt b0"))


def test_storage_with_the_rate_of_g_is_refused(document):
    def change(d, c):
        storage = c["claim"]["storage"]
        storage["program"].append(f"v900 = add {storage['value']} g_rate")
        storage["value"] = "v900"

    assert "must not use g'" in refusal(document, change)


def test_shift_with_the_rate_of_g_is_refused(document):
    def change(d, c):
        storage = c["claim"]["storage"]
        storage["shift_program"].append(f"v900 = add {storage['shift'][0]} g_rate")
        storage["shift"][0] = "v900"

    assert "shift" in refusal(document, change)


def test_shift_with_the_rate_of_the_body_is_refused(document):
    def change(d, c):
        storage = c["claim"]["storage"]
        storage["shift_program"].append(f"v900 = add {storage['shift'][0]} w1")
        storage["shift"][0] = "v900"

    assert "not defined" in refusal(document, change)


def test_momentum_gradient_is_checked(document):
    def change(d, c):
        storage = c["claim"]["storage"]
        storage["momentum_gradient"][0] = storage["momentum_gradient"][1]

    assert "dV/dy" in refusal(document, change)


def test_inertia_that_is_not_one(document):
    def change(d, c):
        d["inertia"][0][0] = "-1"

    assert "positive definite" in refusal(document, change)
