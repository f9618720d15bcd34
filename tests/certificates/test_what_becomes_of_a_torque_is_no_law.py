"""A law that says what its thrusters make of its torque, or adds a torque, loses the proofs about g u."""

from dataclasses import dataclass
from fractions import Fraction as F

import casadi as ca
import numpy as np
import pytest
from intermit.models.ensemble import simulate_ensemble
from intermit.models.laws import Control, Law, PersistenceFilter
from intermit.models.simulation import simulate
from intermit.models.uncertain import Member
from intermit.verify.filter.recognise import NoComparisonError, compared_law
from intermit.verify.lyapunov.claims import lyapunov_claims
from intermit.verify.verdict import Verdict
from problems import J1, paper_schedule


def law_with(thrust=None, disturbance=None):
    """The persistence filter, whose torque becomes something else."""

    @dataclass(frozen=True)
    class Other(Law):
        name = "other"
        lambda_: F = F(21, 40)
        R0: F = F(1)
        controller_states = PersistenceFilter.controller_states

        def control(self, plant, time, states, parameters):
            c = PersistenceFilter.control(self, plant, time, states, parameters)
            return Control(c.torque, c.state_rates, c.gain, c.gain_rate, thrust, disturbance)

    return Other()


@pytest.mark.parametrize(
    "change",
    [{"thrust": ca.SX.zeros(3, 3)}, {"disturbance": ca.SX([0.1, 0, 0])}],
    ids=["no thrust", "a push"],
)
def test_such_a_law_is_proved_nothing(change):
    assert compared_law(law_with()).decay == F(21, 40)
    with pytest.raises(NoComparisonError, match="what its thrusters make"):
        compared_law(law_with(**change))
    claims = lyapunov_claims(law_with(**change), J1, tolerance=None, schedule=paper_schedule())
    # refuted by a state of the loop as it moves, or undecided
    assert not any(c.verdict is Verdict.PROVED for c in claims if c.key.startswith("lyapunov"))


def test_a_disturbance_acts_in_coasts_of_single_runs_too():
    """From rest before the first window, where g = 0: a body that is pushed does not stay at rest."""
    law = Member.of(PersistenceFilter(F(21, 40), F(1)), J1, disturbance=np.array([0.01, 0.0, -0.02]))
    start, horizon = np.array([1.0, 0, 0, 0, 0, 0, 0]), F(24)
    run = simulate(law, J1, paper_schedule(), quaternion=start[:4], rate=start[4:], horizon=horizon)
    many = simulate_ensemble(law, J1, paper_schedule(), start, horizon=horizon)
    assert run.state([float(horizon)])[:, -1] == pytest.approx(many.final_states[0], abs=1e-7)
    assert np.linalg.norm(run.state([7.0])[4:7]) > 1e-3
