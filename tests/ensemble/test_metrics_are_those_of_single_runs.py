"""Figures of merit of an ensemble are those of each run on its own."""

from fractions import Fraction

import numpy as np
import pytest
from intermit.models.ensemble import MetricOptions, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, PersistenceFilter, QuaternionPD
from intermit.models.norms import MEASURED
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import DOP853, filter_minimum, settling_time, simulate, torque_metrics

BODY = RigidBody.from_rows([["3", "1/8", "1/4"], ["1/8", "4", "3/8"], ["1/4", "3/8", "5"]])
SCHEDULE = build_schedule([Window(Fraction(1, 100), Fraction(321, 100))], Hermite(), period=Fraction(8))
LAWS = (
    AdaptiveScaling(Fraction(21, 40), Fraction(1, 10), Fraction(1), Fraction(1, 5)),
    PersistenceFilter(Fraction(21, 40), Fraction(1)),
    QuaternionPD(Fraction(1), Fraction(4)),
)
HORIZON = Fraction(40)
OPTIONS = MetricOptions(attitude=0.05, rate=0.05)


def initial_states(count, seed=11):
    rng = np.random.default_rng(seed)
    q = rng.normal(size=(count, 4))
    q[:, 0] = np.abs(q[:, 0]) + 1
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    return np.hstack([q, rng.uniform(-0.1, 0.1, (count, 3))])


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_metrics_agree(law):
    starts = initial_states(4)
    found = simulate_ensemble(law, BODY, SCHEDULE, starts, horizon=HORIZON, metrics=OPTIONS).metrics
    for i, x in enumerate(starts):
        run = simulate(
            law, BODY, SCHEDULE, quaternion=x[:4], rate=x[4:], horizon=HORIZON,
            method=DOP853(rtol=1e-12, atol=1e-14),
        )  # fmt: skip
        torque = torque_metrics(run)
        for norm in MEASURED:
            assert found.peak[norm][i] == pytest.approx(torque.peak[norm].value, rel=1e-8)
            assert found.peak_commanded[norm][i] == pytest.approx(torque.peak_commanded[norm].value, rel=1e-8)
        # both integrate |tau| step by step with 8 Gauss points; its corners near zero torque cost digits
        assert found.impulse[i] == pytest.approx(torque.impulse, rel=3e-5)
        settled = settling_time(run, attitude=OPTIONS.attitude, rate=OPTIONS.rate)
        assert found.settling_time[i] == pytest.approx(
            settled if settled is not None else np.nan, abs=1e-6, nan_ok=True
        )
        if "R" in run.loop.state_names:
            least = filter_minimum(run)
            assert found.filter_minimum[i] == pytest.approx(least.value, rel=1e-8)
            assert found.filter_minimum_time[i] == pytest.approx(least.time, abs=1e-4)
        else:
            assert np.isnan(found.filter_minimum[i])


def test_settled_at_the_start_at_target_and_never_if_short():
    starts = np.array([[1.0, 0, 0, 0, 0, 0, 0], [0.6, 0.8, 0, 0, 0, 0, 0]])
    found = simulate_ensemble(LAWS[1], BODY, SCHEDULE, starts, horizon=Fraction(2), metrics=OPTIONS).metrics
    assert found.settling_time[0] == 0.0
    assert np.isnan(found.settling_time[1])
    assert found.impulse[0] == 0.0
    assert found.impulse[1] > 0


def test_metrics_of_stacks_are_joined_in_order():
    starts = initial_states(5)
    whole, parts = (
        simulate_ensemble(
            LAWS[0], BODY, SCHEDULE, starts, horizon=Fraction(9), metrics=OPTIONS, stack=s
        ).metrics
        for s in (8, 2)
    )
    for norm in MEASURED:
        np.testing.assert_allclose(parts.peak[norm], whole.peak[norm], rtol=1e-12)
    np.testing.assert_allclose(parts.filter_minimum, whole.filter_minimum, rtol=1e-12)
