"""The gradient search finds V' > 0 just below the sharp condition, none above, and any sampled violation."""

import random
from fractions import Fraction as F

import lyapunov_cases as cases
import numpy as np
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import AdaptiveScalingAsPrinted, PersistenceFilterAsPrinted
from intermit.models.rigid_body import RigidBody
from intermit.verify.lyapunov import ExactDerivative, Falsifier, candidate, falsify, sharp_threshold
from intermit.verify.lyapunov.identity import random_state
from problems import paper_schedule


def rotated(*principal):
    """A body of these principal inertias, its axes turned by an exact rotation, so that J is exact."""
    Q = [[F(1, 3), F(2, 3), F(2, 3)], [F(2, 3), F(1, 3), F(-2, 3)], [F(2, 3), F(-2, 3), F(1, 3)]]
    return RigidBody.from_rows(
        [[sum(Q[i][m] * F(principal[m]) * Q[j][m] for m in range(3)) for j in range(3)] for i in range(3)]
    )


def check_sharp(law, body):
    threshold = sharp_threshold(body)
    below = candidate(close_loop(law(F(threshold.low) * F("0.999"))))
    found = falsify(below, body, schedule=paper_schedule())
    assert found.witness is not None
    assert found.witness.violation.low > 0
    # the supremum of V'/W is the shortfall of lambda; the search comes within a thousandth of it
    shortfall = 0.001 * threshold.low
    assert shortfall * 0.999 < found.worst < shortfall * (1 + 1e-6)
    above = candidate(close_loop(law(F(threshold.high))))
    found = falsify(above, body, schedule=paper_schedule())
    assert found.witness is None
    assert not found.reason  # nothing was seen in floats either
    assert found.worst < 0
    # the search looked where it is worst: half an angle of 1e-3 rad loses 1e-6/8 of lambda
    assert found.worst > -1e-6 * threshold.low


@pytest.mark.parametrize("body", [cases.J1, cases.J2])
@pytest.mark.parametrize("law", [cases.persistence, cases.adaptive])
def test_violation_found_at_0_999_of_sharp_and_none_above(law, body):
    check_sharp(law, body)


@pytest.mark.parametrize(
    ("law", "body"),
    [
        (cases.persistence, rotated("0.001", "0.0012", "0.0015")),
        (cases.adaptive, rotated("1e4", "1.2e4", "1.5e4")),
        (cases.persistence, rotated("0.01", "100", "100")),
        (cases.adaptive, rotated(4, 4, 4)),
    ],
)
def test_so_it_does_for_bodies_of_any_size(law, body):
    """A cubesat's board, a space station's module, a rod, a ball whose sharp lambda is 1/4 exactly."""
    check_sharp(law, body)


@pytest.mark.parametrize(
    "law",
    [
        AdaptiveScalingAsPrinted(F("0.525"), F("0.1"), F(1), F(0)),
        PersistenceFilterAsPrinted(F("0.525"), F(1)),
        cases.HeavierDamping(F("0.525"), F(1), F("0.9")),
        cases.persistence("0.3"),
    ],
)
def test_finds_one_wherever_samples_do(law):
    chosen = candidate(close_loop(law))
    exact = ExactDerivative(chosen, cases.J1.exact_inertia)
    generator = random.Random(11)
    sampled = any(exact.at(random_state(chosen.loop, generator))[0] > 0 for _ in range(300))
    found = falsify(chosen, cases.J1, schedule=paper_schedule())
    assert found.witness is not None or not sampled
    assert found.witness is not None  # all of these are false


def test_search_is_repeatable_and_counts_its_effort():
    chosen = candidate(close_loop(cases.persistence("0.3")))
    first, second = (falsify(chosen, cases.J1, options=Falsifier(points=50, starts=2)) for _ in range(2))
    assert first == second
    assert first.evaluations > 100
    with pytest.raises(ValueError, match="points >= starts"):
        Falsifier(points=1, starts=2)


def test_witness_is_a_state_of_the_sphere():
    found = falsify(candidate(close_loop(cases.persistence("0.3"))), cases.J1)
    assert np.linalg.norm(found.witness.values["quaternion"]) == pytest.approx(1, abs=1e-15)
