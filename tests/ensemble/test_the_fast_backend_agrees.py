"""heyoka's Taylor steps give the runs and figures of the default backend."""

from dataclasses import dataclass, fields, replace
from fractions import Fraction
from typing import ClassVar

import casadi as ca
import numpy as np
import pytest
from intermit.models.ensemble import EnsembleMetrics, MetricOptions, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, Control, Law, PersistenceFilter
from intermit.models.norms import MEASURED
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule

pytest.importorskip("heyoka")

BODY = RigidBody.from_rows([["3", "1/8", "1/4"], ["1/8", "4", "3/8"], ["1/4", "3/8", "5"]])
OTHER = RigidBody.from_rows([[6, 0, 0], [0, 7, 0], [0, 0, 8]])
SCHEDULE = build_schedule([Window(Fraction(1, 100), Fraction(321, 100))], Hermite(), period=Fraction(8))
ADAPTIVE = AdaptiveScaling(Fraction(21, 40), Fraction(1, 10), Fraction(1), Fraction(1, 5))
FILTER = PersistenceFilter(Fraction(21, 40), Fraction(1))
HORIZON = Fraction(19)
TIMES = np.linspace(0, 19, 96)


def initial_states(count, seed=8):
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(count, 4))
    q[:, 0] = np.abs(q[:, 0]) + 0.3
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return np.hstack([q, rng.uniform(-0.2, 0.2, (count, 3))])


def both(laws, bodies, states, **wanted):
    return (
        simulate_ensemble(laws, bodies, SCHEDULE, states, horizon=HORIZON, backend=b, **wanted)
        for b in ("default", "fast")
    )


@pytest.mark.parametrize("law", [ADAPTIVE, FILTER], ids=lambda law: law.name)
@pytest.mark.parametrize("count", [1, 11])
def test_states_agree(law, count):
    plain, fast = both(law, BODY, initial_states(count), times=TIMES)
    np.testing.assert_allclose(fast.states, plain.states, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(fast.final_states, plain.final_states, rtol=1e-9, atol=1e-9)


@pytest.mark.parametrize("times", [[3.0], [0.0, 0.01], [0.01, 19.0], [0.81, 0.8101, 8.01]])
def test_any_times_may_be_asked_for(times):
    plain, fast = both(FILTER, BODY, initial_states(3), times=times)
    np.testing.assert_allclose(fast.states, plain.states, rtol=1e-8, atol=1e-8)


def test_each_run_may_have_its_own_law_and_body():
    laws = [replace(ADAPTIVE, gamma=Fraction(i, 10), R0=Fraction(10 + i, 10)) for i in range(1, 10)]
    bodies = [BODY, OTHER, BODY] * 3
    plain, fast = both(laws, bodies, initial_states(9), times=TIMES)
    np.testing.assert_allclose(fast.states, plain.states, rtol=1e-8, atol=1e-8)
    assert np.abs(fast.states[0] - plain.states[1]).max() > 1e-3


def test_metrics_agree():
    plain, fast = both(
        ADAPTIVE, BODY, initial_states(9), times=TIMES, metrics=MetricOptions(attitude=0.2, rate=0.2)
    )
    np.testing.assert_allclose(fast.states, plain.states, rtol=1e-8, atol=1e-8)
    tolerance = {"impulse": 3e-5, "filter_minimum_time": 1e-5, "settling_time": 1e-6}
    for name in (f.name for f in fields(EnsembleMetrics)):
        found, expected = getattr(fast.metrics, name), getattr(plain.metrics, name)
        if name in ("peak", "peak_commanded"):
            found, expected = (np.array([m[norm] for norm in MEASURED]) for m in (found, expected))
        np.testing.assert_allclose(found, expected, rtol=tolerance.get(name, 1e-8), err_msg=name)


@dataclass(frozen=True)
class Runaway(Law):
    name: ClassVar[str] = "runaway"
    gain: Fraction

    def control(self, plant, time, states, parameters) -> Control:
        del time, states
        return Control(parameters["gain"] * ca.sumsqr(plant.w) * plant.w, {})


def test_a_run_that_escapes_stops_alone_here_too():
    starts = initial_states(3)
    starts[:, 4:] = [[0.01, 0, 0], [2, 0, 0], [0.02, 0, 0]]
    plain, fast = both(Runaway(Fraction(10)), OTHER, starts, times=TIMES)
    assert fast.completed.tolist() == [True, False, True]
    np.testing.assert_array_equal(fast.states, plain.states)


def test_taylor_steps_are_few():
    (_, fast) = both(ADAPTIVE, BODY, initial_states(5))
    assert fast.evaluations.max() < 150
