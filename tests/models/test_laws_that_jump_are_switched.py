"""A law that jumps is integrated from switch to switch; where it would slide it is refused, at once."""

from dataclasses import dataclass
from fractions import Fraction
from typing import Any, ClassVar

import casadi as ca
import numpy as np
import pytest
from intermit.models.ensemble import simulate_ensemble
from intermit.models.laws import Control, Law
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import SimulationError, simulate

SCHEDULE = build_schedule([Window(Fraction(1, 100), Fraction(321, 100))], Hermite(), period=Fraction(8))
TURNED = np.array([0.5, 0.5, 0.5, 0.5])


def body() -> RigidBody:
    entries = (("3.05", "0.14", "0.05"), ("0.14", "2.66", "0.12"), ("0.05", "0.12", "2.18"))
    return RigidBody(tuple(tuple(map(Fraction, row)) for row in entries))


@dataclass(frozen=True)
class Bang(Law):
    """-limit sign(bv + kd w)."""

    name: ClassVar[str] = "bang"
    kd: Fraction = Fraction(2)
    limit: Fraction = Fraction(1, 20)

    def control(self, plant: Any, time: Any, states: Any, parameters: Any) -> Control:
        return Control(-parameters["limit"] * ca.sign(plant.bv + parameters["kd"] * plant.w))


@dataclass(frozen=True)
class Steps(Law):
    """PD whose torque is rounded down to multiples of `bit`."""

    name: ClassVar[str] = "steps"
    bit: Fraction = Fraction(1, 100)

    def control(self, plant: Any, time: Any, states: Any, parameters: Any) -> Control:
        u = -0.2 * plant.bv - 0.6 * plant.w
        return Control(parameters["bit"] * ca.floor(u / parameters["bit"]))


@dataclass(frozen=True)
class Flip(Law):
    """PD whose first torque flips where b1 passes a level: crossed, never slid along."""

    name: ClassVar[str] = "flip"
    level: Fraction = Fraction(49, 100)
    spelled: str = "sign"

    def control(self, plant: Any, time: Any, states: Any, parameters: Any) -> Control:
        side = plant.bv[0] - parameters["level"]
        flip = ca.sign(side) if self.spelled == "sign" else ca.if_else(side >= 0, 1, -1)
        return Control(-0.2 * plant.bv - 0.6 * plant.w + ca.vertcat(0.02 * flip, 0, 0))


def run(law: Law, horizon: int = 56) -> Any:
    return simulate(law, body(), SCHEDULE, quaternion=TURNED, rate=np.zeros(3), horizon=Fraction(horizon))


def test_a_switch_is_located_on_its_surface() -> None:
    trajectory = run(Flip(), 8)
    phase_starts = {float(s.phase.origin) for s in trajectory.segments}
    switches = [s for s in trajectory.segments if float(s.phase.start) not in phase_starts]
    assert switches
    for segment in switches:
        # bisected to the spacing of times: |b1 - level| <= |b1'| ulp(8), and |b1'| < 1
        assert abs(segment.states[1, 0] - 0.49) < 1e-14
    assert trajectory.end == 8.0


def test_a_jump_means_the_same_however_it_is_spelled() -> None:
    first, second = run(Flip(), 8), run(Flip(spelled="if_else"), 8)
    assert np.allclose(first.state(8.0), second.state(8.0), rtol=0, atol=1e-10)


def test_the_integral_of_a_switched_torque_is_exact() -> None:
    """Near-equal to the run that steps over the jump with steps shrunk to nothing: an ensemble's."""
    ensemble = simulate_ensemble(Flip(), body(), SCHEDULE, [*TURNED, 0, 0, 0], horizon=Fraction(8))
    assert ensemble.completed.all()
    assert np.allclose(run(Flip(), 8).state(8.0), ensemble.final_states[0], rtol=0, atol=1e-7)


@pytest.mark.parametrize("law", [Bang(), Steps()])
def test_sliding_is_refused_with_the_instant_and_the_remedy(law: Law) -> None:
    with pytest.raises(SimulationError, match=r"stopped at t = \d.*dead band or a hysteresis"):
        run(law)


def test_a_chattering_run_of_an_ensemble_stops_alone() -> None:
    result = simulate_ensemble(Bang(), body(), SCHEDULE, [*TURNED, 0, 0, 0], horizon=Fraction(40))
    assert not result.completed.any()
    assert 30 < result.stop_times[0] < 40
