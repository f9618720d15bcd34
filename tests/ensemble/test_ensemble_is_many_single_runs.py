"""Running together changes no run."""

from collections.abc import Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import ClassVar

import casadi as ca
import numpy as np
import pytest
from intermit.models.ensemble import Tolerances, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, Control, Law, PersistenceFilter, QuaternionPD
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import DOP853, simulate

BODY = RigidBody.from_rows([["3", "1/8", "1/4"], ["1/8", "4", "3/8"], ["1/4", "3/8", "5"]])
OTHER = RigidBody.from_rows([[6, 0, 0], [0, 7, 0], [0, 0, 8]])
WINDOW = Window(Fraction(1, 100), Fraction(321, 100))
SCHEDULE = build_schedule([WINDOW], Hermite(Fraction(1, 100)), period=Fraction(8))
HORIZON = Fraction(20)
ADAPTIVE = AdaptiveScaling(Fraction(21, 40), Fraction(1, 10), Fraction(1), Fraction(1, 5))
FILTER = PersistenceFilter(Fraction(21, 40), Fraction(1))
LAWS = (ADAPTIVE, FILTER, QuaternionPD(Fraction(1), Fraction(2)))
TIMES = np.linspace(0, 20, 101)
REFERENCE = DOP853(rtol=1e-13, atol=1e-15)


def initial_states(count, seed=5):
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(count, 4))
    q[:, 0] = np.abs(q[:, 0])
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return np.hstack([q, rng.uniform(-0.2, 0.2, (count, 3))])


def single(law, body, x):
    run = simulate(law, body, SCHEDULE, quaternion=x[:4], rate=x[4:], horizon=HORIZON, method=REFERENCE)
    return run.state(TIMES).T


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_every_run_agrees_with_its_own_simulation(law):
    starts = initial_states(7)
    result = simulate_ensemble(law, BODY, SCHEDULE, starts, horizon=HORIZON, times=TIMES)
    assert result.completed.all()
    for x, states in zip(starts, result.states, strict=True):
        truth = single(law, BODY, x)
        np.testing.assert_allclose(states, truth, rtol=1e-8, atol=1e-8)
    np.testing.assert_allclose(result.final_states, result.states[:, -1], rtol=0, atol=1e-13)


def test_each_run_may_have_its_own_law_and_body():
    laws = [replace(ADAPTIVE, gamma=Fraction(i, 10), R0=Fraction(10 + i, 10)) for i in range(1, 5)]
    bodies = [BODY, OTHER, BODY, OTHER]
    starts = initial_states(4)
    result = simulate_ensemble(laws, bodies, SCHEDULE, starts, horizon=HORIZON, times=TIMES)
    for law, body, x, states in zip(laws, bodies, starts, result.states, strict=True):
        np.testing.assert_allclose(states, single(law, body, x), rtol=1e-8, atol=1e-8)
    # the comparison is sharp enough to tell the sets apart
    assert np.abs(result.states[0] - single(laws[1], BODY, starts[0])).max() > 1e-3


def test_the_company_a_run_keeps_does_not_change_it():
    starts = initial_states(9)
    together = simulate_ensemble(ADAPTIVE, BODY, SCHEDULE, starts, horizon=HORIZON, times=TIMES)
    alone = simulate_ensemble(ADAPTIVE, BODY, SCHEDULE, starts[4], horizon=HORIZON, times=TIMES)
    np.testing.assert_allclose(together.states[4], alone.states[0], rtol=0, atol=1e-12)
    few, one = (simulate_ensemble(ADAPTIVE, BODY, SCHEDULE, x, horizon=HORIZON) for x in (starts, starts[4]))
    assert few.evaluations[4] == one.evaluations[0]


def test_stacks_on_an_executor_give_the_same_runs():
    starts = initial_states(9)
    whole = simulate_ensemble(FILTER, BODY, SCHEDULE, starts, horizon=HORIZON, times=TIMES)
    with ThreadPoolExecutor(2) as pool:
        parts = simulate_ensemble(
            FILTER, BODY, SCHEDULE, starts, horizon=HORIZON, times=TIMES, executor=pool, stack=4
        )
    np.testing.assert_allclose(parts.states, whole.states, rtol=0, atol=1e-12)


def test_controller_states_may_be_given():
    starts = np.hstack([initial_states(3), [[0.4, 0.1], [0.5, 0.2], [0.6, 0.3]]])
    given = simulate_ensemble(ADAPTIVE, BODY, SCHEDULE, starts, horizon=HORIZON)
    law = replace(ADAPTIVE, R0=Fraction("0.5"), k0=Fraction("0.2"))
    own = simulate_ensemble(law, BODY, SCHEDULE, starts[1, :7], horizon=HORIZON)
    np.testing.assert_allclose(given.final_states[1], own.final_states[0], rtol=0, atol=1e-12)


@dataclass(frozen=True)
class Runaway(Law):
    """Feeds the rate back with the wrong sign, cubed: it escapes in finite time if it moves fast."""

    name: ClassVar[str] = "runaway"
    gain: Fraction

    def control(self, plant, time, states, parameters: Mapping) -> Control:
        del time, states
        return Control(parameters["gain"] * ca.sumsqr(plant.w) * plant.w, {})


def test_a_run_that_escapes_stops_alone_and_says_when():
    starts = initial_states(3)
    starts[:, 4:] = [[0.01, 0, 0], [2, 0, 0], [0.02, 0, 0]]
    result = simulate_ensemble(Runaway(Fraction(10)), OTHER, SCHEDULE, starts, horizon=HORIZON, times=TIMES)
    assert result.completed.tolist() == [True, False, True]
    assert 0 < result.stop_times[1] < 1
    assert np.isnan(result.states[1, result.stop_times[1] < TIMES]).all()
    assert np.isfinite(result.states[[0, 2]]).all()


def test_work_is_counted_and_bounded():
    """One costly run does not make the others pay, and tighter tolerances cost what order 8 costs."""
    starts = initial_states(5)
    loose, tight = (
        simulate_ensemble(
            ADAPTIVE, BODY, SCHEDULE, starts, horizon=HORIZON,
            tolerances=Tolerances(rtol=tol, atol=tol / 100),
        ).evaluations
        for tol in (1e-8, 1e-11)
    )  # fmt: skip
    assert (loose < 1500).all()
    ratio = tight / loose
    assert (ratio > 1.3).all()
    assert (ratio < 10 ** (3 / 8) * 1.3).all()


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"laws": [ADAPTIVE, FILTER]}, "law 1 is PersistenceFilter"),
        ({"laws": [ADAPTIVE] * 2, "initial_states": initial_states(3)}, "2 laws, 1 bodies, 3 states"),
        ({"initial_states": np.ones((2, 7))}, "run 0 has norm 2"),
        ({"initial_states": initial_states(2)[:, :6]}, r"7 numbers .* or 9"),
        ({"times": [3.0, 2.0]}, "ascend within"),
        ({"times": [21.0]}, r"\[0, 20\] s"),
    ],
)  # fmt: skip
def test_inputs_that_do_not_fit_are_named(change, message):
    inputs = {"laws": ADAPTIVE, "bodies": BODY, "initial_states": initial_states(2), "times": ()} | change
    with pytest.raises(ValueError, match=message):
        simulate_ensemble(schedule=SCHEDULE, horizon=HORIZON, **inputs)


@pytest.mark.slow
def test_stacks_may_go_to_other_processes():
    """Everything a stack needs travels: the interface is that of a cluster's executor too."""
    from concurrent.futures import ProcessPoolExecutor
    from multiprocessing import get_context

    starts = initial_states(5)
    laws = [replace(ADAPTIVE, gamma=Fraction(i, 10)) for i in range(1, 6)]
    here = simulate_ensemble(laws, BODY, SCHEDULE, starts, horizon=HORIZON)
    with ProcessPoolExecutor(1, mp_context=get_context("spawn")) as pool:
        there = simulate_ensemble(laws, BODY, SCHEDULE, starts, horizon=HORIZON, executor=pool, stack=3)
    np.testing.assert_allclose(there.final_states, here.final_states, rtol=0, atol=1e-12)
