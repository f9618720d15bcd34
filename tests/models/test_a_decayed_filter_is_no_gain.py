"""A gain 1/R is not known once R has decayed into the integration's error: the run ends there and says so."""

from fractions import Fraction as F

import pytest
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import SimulationError, simulate
from problems import ADAPTIVE, J1, PERSISTENCE

HALF_TURN = [0.0, 0.0, 0.0, 1.0]


def run(law, lead):
    schedule = build_schedule([Window(F(lead), F(lead + 3))], Hermite())
    return simulate(law, J1, schedule, quaternion=HALF_TURN, rate=[0, 0, 0], horizon=F(lead + 4))


def test_a_filter_decayed_to_noise_ends_the_run():
    with pytest.raises(SimulationError, match="R has decayed below 1e-10 s") as caught:
        run(PERSISTENCE, 1000)
    # exp(-lambda t) = 1e-10 at t = 43.9 s; the integrator's own steps are seconds long
    at = float(str(caught.value).split("t = ")[1].split(" s")[0])
    assert 43.8 < at < 60


def test_a_filter_that_is_still_known_runs_on():
    assert run(PERSISTENCE, 30).end == 34


def test_a_gain_that_does_not_divide_by_it_runs_on():
    assert run(ADAPTIVE, 1000).end == 1004
