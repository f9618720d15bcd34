"""The certificate of a lower bound goes through the stand-alone checker, and through nothing else's word."""

import json
import math
from fractions import Fraction

import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, thrusters
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.bounds import PathOptions, certified_lower_bound
from intermit.optim.bounds.certificate import peak_certificate
from intermit.optim.problem import Terminal, TransferProblem, quaternion_from_axis_angle
from intermit.verify.certificates import certificate_text
from intermit.verify.checker import check_text

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
WINDOW = PiecewisePolynomial(
    (Fraction(0), Fraction(4), Fraction(6), Fraction(10)), ((Fraction(1),), (), (Fraction(1),))
)
THRUSTERS = thrusters([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])
AWAY = (Fraction("0.03"), Fraction("0.02"), Fraction("0.04"))
SLOWLY = (Fraction("0.002"), Fraction("-0.001"), Fraction("0.003"))
QUICK = PathOptions(degree=3, tolerance=1e-2)
"""Weak potentials: the proofs are the same, and short."""


ROUND = RigidBody.from_rows([[2, 0, 0], [0, 2, 0], [0, 0, 3]])
TUMBLING = (Fraction("0.5"), Fraction("0.4"), Fraction("-0.3"))
SPINNING = (Fraction("0.01"), Fraction(0), Fraction(2))


def problem(**options):
    attitude = quaternion_from_axis_angle((1, 1, 1), math.radians(70))
    return TransferProblem(**{"body": J1, "window": WINDOW, "attitude": attitude} | options)


CASES = {
    "path": problem(),
    "path in the invariant set": problem(norm=THRUSTERS),
    "components": problem(norm=LARGEST_COMPONENT),
    "components after a coast": problem(norm=LARGEST_COMPONENT, rate=SLOWLY),
    "components to a slow end": problem(
        norm=LARGEST_COMPONENT, rate=SLOWLY, terminal=Terminal(rate=Fraction("0.0001"))
    ),
    "path after a coast": problem(rate=AWAY),
    "path in the invariant set after a coast": problem(norm=THRUSTERS, rate=AWAY),
    "path and momentum": problem(rate=TUMBLING),
    "momentum about an axis": problem(
        norm=LARGEST_COMPONENT, body=ROUND, rate=SPINNING, terminal=Terminal(rate=Fraction("0.01"))
    ),
    "momentum": problem(norm=LARGEST_COMPONENT, rate=(Fraction(-1), Fraction(2), Fraction(0))),
}


@pytest.fixture(scope="module")
def bounds():
    return {key: certified_lower_bound(case, options=QUICK) for key, case in CASES.items()}


def shown(bounds, key):
    """The largest bound, or that of the name in the key."""
    name = key.removeprefix("path in the ").replace("to a slow end", "after a coast")
    return next((b for b in bounds[key].all if b.name == name), bounds[key].best)


@pytest.fixture(scope="module")
def texts(bounds):
    return {key: certificate_text([peak_certificate(CASES[key], shown(bounds, key))]) for key in bounds}


def edited(text, *path, change):
    document = json.loads(text)
    place = document["parts"][0]
    for key in path[:-1]:
        place = place[key]
    place[path[-1]] = change(place[path[-1]])
    return json.dumps(document)


def by(factor):
    return lambda value: str(Fraction(value) * Fraction(factor))


def valid(text):
    return all(f.valid for f in check_text(text))


@pytest.mark.parametrize("key", CASES)
def test_every_kind_of_bound_is_proved_and_is_the_one_printed(texts, bounds, key):
    findings = check_text(texts[key])
    assert [f.valid for f in findings] == [True], findings
    claimed = Fraction(json.loads(texts[key])["parts"][0]["certificates"][0]["claim"]["peak"])
    printed = Fraction(shown(bounds, key).value)
    assert printed * (1 - Fraction(1, 2**52)) <= claimed <= printed
    assert len(texts[key]) < 200_000


def test_each_argument_occurs(texts):
    found = {
        key: json.loads(text)["parts"][0]["certificates"][0]["witness"]["argument"]
        for key, text in texts.items()
    }
    assert found == {
        "path": "path",
        "path in the invariant set": "path",
        "components": "components",
        "components after a coast": "components",
        "components to a slow end": "components",
        "path after a coast": "path",
        "path in the invariant set after a coast": "path",
        "path and momentum": "braking",
        "momentum about an axis": "axis",
        "momentum": "momentum",
    }
    coasted = [key for key in CASES if "coast" in key or "slow" in key or key == "path and momentum"]
    assert [key for key, text in texts.items() if '"coast"' in text] == coasted


def test_every_bound_listed_has_a_certificate(bounds):
    for key, listed in bounds.items():
        found = [peak_certificate(CASES[key], bound) for bound in listed.all]
        assert all((c is None) == (b.value <= 0) for c, b in zip(found, listed.all, strict=True))
        assert valid(certificate_text([c for c in found if c is not None]))


WITNESS = ("certificates", 0, "witness")
PROOF = (*WITNESS, "separations", 0)
SHARED = [
    (("certificates", 0, "claim", "peak"), "1.001"),
    (("data", "inertia", 0, 0), "0.9"),
]
ABOUT_AN_AXIS = [
    (("certificates", 0, "claim", "peak"), "1.001"),
    (("data", "inertia", 0, 0), "0.9"),  # no longer round
    (("data", "inertia", 2, 2), "0.9"),
    (("data", "transfer", "rate", 2), "0.99"),
    (("data", "transfer", "tolerance", "rate"), "1.1"),
    (("data", "transfer", "window", "knots", 3), "1.01"),
    ((*WITNESS, "axis"), "0"),
    ((*WITNESS, "axis"), "1.5"),
]
TRAVELLED = [
    *SHARED,
    ((*WITNESS, "travel"), "1.01"),
    ((*WITNESS, "instant"), "0.5"),
    ((*WITNESS, "speed", 0), "0.9"),
    ((*PROOF, "rate"), "0.95"),
    ((*PROOF, "chart", "outer"), "0.9"),
    ((*PROOF, "chart", "direction", 0), "1.0001"),
    ((*PROOF, "chart", "middle", 0), "1.2"),
    ((*PROOF, "potential", 0, 3), "1.3"),
    (("data", "transfer", "attitude", 0), "1.05"),
    (("data", "transfer", "window", "shapes", 0, 0), "1.01"),
    (("data", "transfer", "window", "knots", 3), "1.01"),
]
COASTED = [
    *TRAVELLED,
    ((*WITNESS, "coast", "until"), "0.99"),
    ((*WITNESS, "coast", "until"), "1.01"),
    ((*WITNESS, "coast", "attitude", 0), "1.001"),
    ((*WITNESS, "coast", "turn"), "0"),
    ((*WITNESS, "coast", "slack"), "0.1"),
    ((*WITNESS, "coast", "growth", 0), "0.99"),
    ((*WITNESS, "coast", "growth", 0), "1.5"),
    (("data", "transfer", "rate", 0), "1.001"),
]
BRAKING = [
    *SHARED,
    ((*WITNESS, "travel"), "1.01"),
    ((*WITNESS, "shares", 20), "0.5"),
    ((*WITNESS, "shares", 20), "1.5"),
    ((*WITNESS, "coast", "attitude", 0), "1.001"),
    ((*WITNESS, "coast", "turn"), "0"),
    ((*WITNESS, "coast", "slack"), "0.1"),
    ((*WITNESS, "coast", "growth"), "0.99"),
    ((*PROOF, "rate"), "0.95"),
    (("data", "transfer", "rate", 0), "0.99"),
    (("data", "transfer", "window", "knots", 3), "1.01"),
]
COMPONENTS = [
    *TRAVELLED,
    ((*WITNESS, "rows", 1, 0), "1.01"),
    ((*WITNESS, "rows", 2, 0), "0.99"),
    ((*WITNESS, "bounds", 0), "0.95"),
    ((*WITNESS, "box", 1), "0.97"),
    ((*WITNESS, "box", 1), "1.1"),
    ((*WITNESS, "widths", 0, 0), "0.9"),
    ((*WITNESS, "multipliers", 0, 0), "0.5"),
]
MOVING = [
    *COMPONENTS,
    ((*WITNESS, "coast", "attitude", 0), "1.001"),
    ((*WITNESS, "coast", "turn"), "0"),
    ((*WITNESS, "instant"), "0.99"),
    ((*WITNESS, "instant"), "1.01"),
    (("data", "transfer", "rate", 0), "1.01"),
]
SLOW_END = [
    *MOVING,
    ((*WITNESS, "end"), "0.5"),  # the traces that give it may be loose by the root of 3
    (("data", "transfer", "tolerance", "rate"), "1.01"),
]


@pytest.mark.parametrize(
    ("key", "path", "factor"),
    [("path", *one) for one in TRAVELLED]
    + [("path in the invariant set", *one) for one in TRAVELLED]
    + [("components", *one) for one in COMPONENTS]
    + [("components after a coast", *one) for one in MOVING]
    + [("components to a slow end", *one) for one in SLOW_END]
    + [("path after a coast", *one) for one in COASTED]
    + [("path in the invariant set after a coast", *one) for one in COASTED]
    + [("path in the invariant set after a coast", (*WITNESS, "coast", "growth", 1), "0.99")]
    + [("momentum", *one) for one in SHARED]
    + [("momentum", ("data", "transfer", "rate", 1), "0.9")]
    + [("momentum about an axis", *one) for one in ABOUT_AN_AXIS]
    + [("path and momentum", *one) for one in BRAKING],
)
def test_any_change_that_matters_is_refused(texts, key, path, factor):
    assert not valid(edited(texts[key], *path, change=by(factor)))


@pytest.mark.parametrize("key", ["path", "path in the invariant set", "components"])
def test_start_rate_and_tolerance_are_part_of_the_claim(texts, key):
    for path in (("data", "transfer", "rate", 0), ("data", "transfer", "tolerance", "attitude")):
        assert not valid(edited(texts[key], *path, change=lambda _: "0.02"))


@pytest.mark.parametrize("key", ["path", "path in the invariant set", "components"])
def test_a_larger_set_of_torques_is_not_covered(texts, key):
    """A cube holds the ball, thrusters of twice the lever the others: not every bound carries over."""
    other = {
        "path": {"by": "component"},
        "path in the invariant set": {
            "by": "thrusters",
            "axes": [[str(2 * x) for x in row] for row in THRUSTERS.axes],
        },
        "components": {"by": "thrusters", "axes": [["2", "0", "0"], ["0", "2", "0"], ["0", "0", "2"]]},
    }
    assert not valid(edited(texts[key], "data", "transfer", "torque", change=lambda _: other[key]))


@pytest.mark.slow
@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT, THRUSTERS])
def test_tumbling_start_with_tolerances(norm):
    moving = problem(
        norm=norm,
        rate=(Fraction("0.01"), Fraction(0), Fraction("-0.005")),
        terminal=Terminal(attitude=Fraction(1, 100), rate=Fraction(1, 1000)),
    )
    bound = certified_lower_bound(moving, options=QUICK)
    assert bound.value > 0
    assert valid(certificate_text([peak_certificate(moving, bound.best)]))


@pytest.mark.slow
@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT])
def test_one_target_sign_the_long_way_round(norm):
    long = problem(norm=norm, signs=(-1,))
    bound = certified_lower_bound(long, options=QUICK)
    text = certificate_text([peak_certificate(long, bound.best)])
    assert valid(text)
    assert not valid(edited(text, "data", "transfer", "signs", change=lambda _: ["1"]))
    assert not valid(edited(text, "data", "transfer", "signs", change=lambda _: ["1", "-1"]))
