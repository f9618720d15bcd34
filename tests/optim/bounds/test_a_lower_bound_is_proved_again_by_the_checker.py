"""The certificate of a lower bound goes through the stand-alone checker, and through nothing else's word."""

import json
import math
from fractions import Fraction

import pytest
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.bounds import certified_lower_bound
from intermit.optim.bounds.certificate import peak_certificate
from intermit.optim.norms import LargestComponent
from intermit.optim.problem import Terminal, TransferProblem, quaternion_from_axis_angle
from intermit.verify.certificates import certificate_text
from intermit.verify.checker import check_text

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
WINDOW = PiecewisePolynomial(
    (Fraction(0), Fraction(4), Fraction(6), Fraction(10)), ((Fraction(1),), (), (Fraction(1),))
)


def problem(**options):
    attitude = quaternion_from_axis_angle((1, 1, 1), math.radians(70))
    return TransferProblem(body=J1, window=WINDOW, attitude=attitude, **options)


@pytest.fixture(scope="module")
def text():
    return certificate_text([peak_certificate(problem())])


def edited(text, *path, change):
    document = json.loads(text)
    place = document["parts"][0]
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = change(place[path[-1]])
    return json.dumps(document)


def by(factor):
    return lambda value: str(Fraction(value) * Fraction(factor))


def test_valid_and_as_large_as_the_bound(text):
    findings = check_text(text)
    assert [f.valid for f in findings] == [True], findings
    claimed = Fraction(json.loads(text)["parts"][0]["certificates"][0]["claim"]["peak"])
    bound = certified_lower_bound(problem())
    assert bound.value * (1 - 1e-12) <= float(claimed) <= bound.value * (1 + 1e-12)


WITNESS = ("certificates", 0, "witness")
PROOF = (*WITNESS, "separations", 0)


@pytest.mark.parametrize(
    ("path", "factor"),
    [
        (("certificates", 0, "claim", "peak"), "1.001"),
        ((*WITNESS, "travel"), "1.01"),
        ((*WITNESS, "inertia_above"), "1.1"),
        ((*WITNESS, "inertia_below"), "0.9"),
        ((*WITNESS, "instant"), "0.5"),
        ((*PROOF, "rate"), "0.97"),
        ((*PROOF, "chart", "outer"), "0.9"),
        ((*PROOF, "chart", "direction", 0), "1.0001"),
        ((*PROOF, "chart", "middle", 0), "1.2"),
        ((*PROOF, "potential", 0, 3), "1.3"),
        (("data", "inertia", 0, 0), "0.9"),
        (("data", "transfer", "attitude", 0), "1.05"),
        (("data", "transfer", "window", "shapes", 0, 0), "1.01"),
    ],
)
def test_any_change_that_matters_is_refused(text, path, factor):
    assert not all(f.valid for f in check_text(edited(text, *path, change=by(factor))))


def test_start_rate_and_tolerance_are_part_of_the_claim(text):
    for path in (("data", "transfer", "rate", 0), ("data", "transfer", "tolerance", "attitude")):
        assert not all(f.valid for f in check_text(edited(text, *path, change=lambda _: "0.02")))


def test_tumbling_start_with_tolerances():
    moving = problem(
        rate=(Fraction("0.01"), Fraction(0), Fraction("-0.005")),
        terminal=Terminal(attitude=Fraction(1, 100), rate=Fraction(1, 1000)),
    )
    assert all(f.valid for f in check_text(certificate_text([peak_certificate(moving)])))


def test_other_norms_say_so():
    with pytest.raises(TypeError, match="no certificate"):
        peak_certificate(problem(norm=LargestComponent()))
