"""Between windows far apart an ensemble knows R as single runs do; a forgotten one ends its run."""

from dataclasses import dataclass
from fractions import Fraction as F
from typing import ClassVar

import casadi as ca
import numpy as np
import pytest
from intermit.models.ensemble import simulate_ensemble
from intermit.models.ensemble.metrics import MetricOptions
from intermit.models.laws import Control, Law
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import filter_minimum, simulate
from problems import ADAPTIVE, J1, PERSISTENCE, TILTED


@dataclass(frozen=True)
class Switched(Law):
    """A damper whose strength jumps where b1 passes a level."""

    name: ClassVar[str] = "switched"

    def control(self, plant, time, states, parameters):
        """Half or all of it."""
        return Control(-ca.if_else(plant.bv[0] > 0.4, 1, 0.5) * plant.w - 0.1 * plant.bv)


@pytest.mark.parametrize("law", [PERSISTENCE, ADAPTIVE])
def test_long_coasts_are_those_of_single_runs(law):
    """R falls to 1e-22 s between the windows, and to exp(-0.525 47) of itself after them."""
    schedule = build_schedule([Window(F(0), F(3)), Window(F(100), F(103))], Hermite())
    times = np.array([0.0, 2.0, 10.0, 55.5, 99.0, 100.0, 101.0, 104.0, 150.0])
    starts = [[*TILTED, 0, 0, 0], [0.6, 0.8, 0, 0, 0.02, -0.01, 0.03]]
    asked = MetricOptions(attitude=0.01, rate=0.01)
    many = simulate_ensemble(law, J1, schedule, starts, horizon=F(150), times=times, metrics=asked)
    for i, start in enumerate(starts):
        one = simulate(law, J1, schedule, quaternion=start[:4], rate=start[4:], horizon=F(150))
        assert many.states[i] == pytest.approx(one.state(times).T, rel=1e-8, abs=1e-9)
        assert many.state("R")[i] == pytest.approx(one.controller_state("R", times), rel=1e-8)
        assert many.metrics.filter_minimum[i] == pytest.approx(filter_minimum(one).value, rel=1e-8)


def test_a_forgotten_filter_stops_its_run():
    schedule = build_schedule([Window(F(0), F(3)), Window(F(1000), F(1003))], Hermite())
    start = [*TILTED, 0, 0, 0]
    stopped, gone_on = (
        simulate_ensemble(law, J1, schedule, start, horizon=F(1003)) for law in (PERSISTENCE, ADAPTIVE)
    )
    assert stopped.stop_times[0] == 1000
    assert gone_on.completed.all()  # its gain does not divide by R


def test_the_fast_backend_leaves_decay_and_jumps_alone():
    """It is not even loaded: these runs need what only the default backend knows."""
    schedule = build_schedule([Window(F(0), F(3)), Window(F(100), F(103))], Hermite())
    start = [*TILTED, 0, 0, 0]
    for law in (PERSISTENCE, Switched()):
        fast, default = (
            simulate_ensemble(law, J1, schedule, start, horizon=F(103), backend=backend)
            for backend in ("fast", "default")
        )
        assert np.array_equal(fast.final_states, default.final_states)
