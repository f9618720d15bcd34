"""The gradient search finds V' > 0 just below the sharp condition, none above, and any sampled violation."""

import random
from fractions import Fraction as F

import lyapunov_cases as cases
import numpy as np
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import AdaptiveScalingAsPrinted, PersistenceFilterAsPrinted
from intermit.verify.lyapunov import ExactDerivative, Falsifier, candidate, falsify, sharp_threshold
from intermit.verify.lyapunov.identity import random_state
from problems import paper_schedule


@pytest.mark.parametrize("body", [cases.J1, cases.J2])
@pytest.mark.parametrize("law", [cases.persistence, cases.adaptive])
def test_finds_a_violation_at_0_999_of_sharp_and_none_above(law, body):
    threshold = sharp_threshold(body)
    below = candidate(close_loop(law(F(threshold.low) * F("0.999"))))
    found = falsify(below, body, schedule=paper_schedule())
    assert found.witness is not None
    assert found.witness.violation.low > 0
    # the supremum of V'/W is the shortfall of lambda; the search comes within a thousandth of it
    shortfall = 0.001 * threshold.low
    assert shortfall * 0.999 < found.worst < shortfall * (1 + 1e-6)
    above = candidate(close_loop(law(F(threshold.high) * F("1.0001"))))
    found = falsify(above, body, schedule=paper_schedule())
    assert found.witness is None
    assert found.worst < 0


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
