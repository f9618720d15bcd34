"""Coasts are known exactly: R keeps its digits however small, turns cost one period, an end has a reason."""

from fractions import Fraction as F
from math import exp

import numpy as np
import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import QuaternionPD
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import DOP853, SimulationError, simulate
from intermit.models.simulation.coasting import coasting_decay
from intermit.models.simulation.nutation import rate_period
from problems import ADAPTIVE, J1, PERSISTENCE

HALF_TURN = [0.0, 0.0, 0.0, 1.0]
LAMBDA = 0.525
PD = QuaternionPD(proportional=F(1), derivative=F("2.5"))
TUMBLING = [0.11, -0.07, 0.05]


def run(law, *windows, end=None, rate=(0, 0, 0), body=J1, start=HALF_TURN, **options):
    schedule = build_schedule([Window(F(on), F(on + 3)) for on in windows], Hermite())
    horizon = F(windows[-1] + 4 if end is None else end)
    return simulate(law, body, schedule, quaternion=start, rate=list(rate), horizon=horizon, **options)


def test_decay_is_read_off_the_law():
    assert coasting_decay(close_loop(PERSISTENCE)) == pytest.approx([LAMBDA], rel=1e-15)
    assert coasting_decay(close_loop(ADAPTIVE)) == pytest.approx([LAMBDA, 0], rel=1e-15)


@pytest.mark.parametrize("lead", [0, 30, 100])
def test_the_filter_decays_by_its_formula(lead):
    found = run(PERSISTENCE, lead + 1)
    assert found.controller_state("R", lead + 1) == pytest.approx(exp(-LAMBDA * (lead + 1)), rel=1e-12)
    assert np.array_equal(found.state(0.5 * lead)[:7], [*HALF_TURN, 0, 0, 0])


@pytest.mark.parametrize("lead", [40, 80, 109])
def test_what_follows_a_tiny_filter_state_is_known(lead):
    fine, coarse = (run(PERSISTENCE, lead, method=DOP853(rtol=r)) for r in (1e-13, 1e-9))
    assert coarse.state(lead + 4) == pytest.approx(fine.state(lead + 4), abs=1e-7)


def test_a_forgotten_filter_ends_the_run_with_the_truth():
    with pytest.raises(SimulationError, match="the law's own property") as caught:
        run(PERSISTENCE, 1000)
    # exp(-lambda t) = 1e-25 at t = 109.647 s
    assert "t = 109.647 s" in str(caught.value)
    assert "initial.time" in str(caught.value)


def test_a_gain_that_does_not_divide_by_it_runs_on():
    assert run(ADAPTIVE, 10**9).end == 10**9 + 4


def test_idle_time_in_the_middle_costs_nothing_from_rest():
    near, far = (run(ADAPTIVE, 0, gap) for gap in (30, 3 * 10**6))
    assert far.evaluations < 2 * near.evaluations


@pytest.mark.parametrize("body", [J1, RigidBody.from_rows([[1, 0, 0], [0, 2, 0], [0, 0, 3]])])
def test_many_turns_are_those_of_the_long_way_round(body):
    start, length = np.array([0.6, 0.0, 0.8, 0.0]), 3000
    long = run(PD, length, end=length, rate=TUMBLING, body=body, start=start)
    assert len(long.segments) == 1
    for t in (0.3, 777.7, 2222.2, 2999.9):
        short = run(PD, 4000, end=F(t), rate=TUMBLING, body=body, start=start, method=DOP853(rtol=1e-13))
        assert long.state(t) == pytest.approx(short.segments[-1].end_state, abs=1e-8)


def test_a_long_coast_costs_no_more_than_a_short_one():
    near, far = (run(PD, end, end=end, rate=TUMBLING) for end in (2000, 2 * 10**6))
    assert far.evaluations == near.evaluations


def test_the_period_of_a_top_is_known():
    # symmetric about the third axis: w1, w2 turn at w3 (I3 - I1)/I1
    assert rate_period(np.diag([2.0, 2.0, 3.0]), np.array([0.1, 0.0, 0.4])) == pytest.approx(2 * np.pi / 0.2)
    assert rate_period(np.diag([3.0, 2.0, 2.0]), np.array([0.4, 0.1, 0.0])) == pytest.approx(2 * np.pi / 0.2)


def test_more_turns_than_can_be_followed_are_counted():
    nearly_round = RigidBody.from_rows([["1", 0, 0], [0, "1.0000001", 0], [0, 0, "1.0000002"]])
    with pytest.raises(SimulationError, match=r"2\.22e\+06 turns: at most 8000"):
        run(PD, 10**8, rate=TUMBLING, body=nearly_round)
