"""[uncertainty] in scenario files: read, checked, certified, rechecked; refused where senseless."""

from fractions import Fraction as F

import pytest
from intermit.verify.robust.answer import certify_robust_floor
from robust_attack import ADAPTIVE, TOLERANCE, attack, question, random_robust_question

SEEDS = range(6)


@pytest.fixture(scope="module")
def attacked():
    rows = []
    for seed in SEEDS:
        q = random_robust_question(seed)
        floor = certify_robust_floor(q)
        if floor.repeats:
            rows.append((seed, floor, attack(q, floor, runs=16, periods=7, seed=seed)))
    return rows


def test_most_random_questions_are_certified(attacked):
    assert len(attacked) == 6


def test_nothing_flown_crosses_a_bound(attacked):
    for seed, _, worst in attacked:
        assert max(worst.values()) <= 1 + TOLERANCE, (seed, worst)


def test_the_bounds_are_near_what_is_flown(attacked):
    """A bound lowered by 3 % would be crossed in most of them: of the floor, or of the angle."""
    caught = [max(worst["floor"], worst["envelope"]) > 0.97 for _, _, worst in attacked]
    assert sum(caught) >= len(caught) / 2


CHANNELS = {
    "shape": {"inertia_relative": F(2, 100)},
    "thrust": {"thrust_error": (F(-5, 100), F(5, 100))},
    "turn": {"misalignment_deg": F(1)},
    "push": {"disturbance": F(1, 100)},
}


@pytest.mark.slow
@pytest.mark.parametrize("name", CHANNELS)
def test_nothing_crosses_a_bound_of_a_law_that_learns(name):
    q = question(law=ADAPTIVE, **CHANNELS[name])
    floor = certify_robust_floor(q)
    assert floor.failed_at is None
    worst = attack(q, floor, runs=16, periods=6, seed=3)
    assert max(worst.values()) <= 1 + TOLERANCE
    assert max(worst["floor"], worst["envelope"]) > 0.97


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(100, 300))
def test_nothing_flown_crosses_a_bound_in_a_long_attack(seed):
    q = random_robust_question(seed)
    floor = certify_robust_floor(q)
    if floor.repeats:
        assert max(attack(q, floor, runs=60, seed=seed).values()) <= 1 + TOLERANCE
