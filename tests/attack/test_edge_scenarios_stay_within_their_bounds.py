"""Bodies of any size, long gaps, single windows, R(0) and k(0) far off, 100 periods: no bound is crossed."""

from fractions import Fraction as F

import missions
import numpy as np
import pytest
from edge_scenarios import edge_question
from floor_attack import FIGURES, TOLERANCE, Adversary, crossings
from intermit.verify.filter.answer import answer
from intermit.verify.filter.worst_found import _Shape
from problems import ADAPTIVE, J1, PERSISTENCE, paper_schedule

ADVERSARY = Adversary(batches=(24, 13, 13), most_periods=12)
PAPER = missions.question(
    law=PERSISTENCE, body=J1, schedule=paper_schedule(), max_angle_deg=F(120), max_weighted_rate=F("0.3")
)


def attack(seed):
    return ADVERSARY.attack(edge_question(seed), seed)


@pytest.mark.parametrize("seed", [0, 7, 27])
def test_a_few(seed):
    found = attack(seed)
    assert found.certified
    assert not crossings([found])


@pytest.mark.slow
def test_more():
    attacks = [attack(seed) for seed in range(20)]
    assert not crossings(attacks)
    assert sum(a.certified for a in attacks) >= 8


@pytest.mark.soak
def test_many():
    attacks = [attack(seed) for seed in range(400)]
    assert not crossings(attacks)
    assert sum(a.certified for a in attacks) >= 160


@pytest.mark.slow
@pytest.mark.parametrize("law", [PERSISTENCE, ADAPTIVE])
def test_all_time_is_a_hundred_periods_too(law):
    """The tail's repeated period bounds what is simulated at each instant of 800 s."""
    question = missions.other(PAPER, law=law)
    found = Adversary(batches=(8,), periods=100, most_periods=100).attack(question, 1)
    assert found.certified
    assert not crossings([found])


def test_a_bound_that_is_too_good_is_caught():
    """The partner that must fail: the bounds of a smaller set do not hold for a larger one."""
    small = answer(missions.other(PAPER, max_angle_deg=F(60), max_weighted_rate=F(0)))
    adversary = Adversary(batches=(24,))
    shape = _Shape(PAPER.law, PAPER.mission.body, PAPER.mission.schedule, PAPER.initial, None)
    ratios = adversary.ratios(PAPER, small, shape, shape.draw(np.random.default_rng(1), 24)).max(axis=1)
    caught = {name for name, ratio in zip(FIGURES, ratios, strict=True) if ratio > 1 + TOLERANCE}
    assert caught >= {"floor", "angle", "rate", "decay"}
