"""A run's enclosure holds the run, and only a limit that is certainly exceeded is refuted."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction as F
from typing import ClassVar

import casadi as ca
import missions
import numpy as np
import pytest
from intermit.models.laws import Control, Expression, Law, PlantSymbols, QuaternionPD, TimeSymbols
from intermit.models.lowering import UnknownOperationError
from intermit.models.norms import EUCLIDEAN
from intermit.models.simulation import DOP853, simulate
from intermit.verify.filter.torque_excess import refuted_limit, start_inside
from intermit.verify.flow import run_enclosure as enclosed
from intermit.verify.flow.run_enclosure import EnclosedRun, ExactStart, NoEnclosureError
from intermit.verify.verdict import Claim, Verdict
from problems import ADAPTIVE, J1, PERSISTENCE, paper_schedule

SCHEDULE = paper_schedule()
START = ExactStart((F(1, 2),) * 4, (F(0),) * 3)
TUMBLING = ExactStart((F(3, 5), F(0), F(4, 5), F(0)), (F("0.2"), F("-0.1"), F("0.05")))
PD = QuaternionPD(F("0.2"), F(1))
LAWS = [PERSISTENCE, ADAPTIVE, PD]
QUESTION = missions.question(
    law=PERSISTENCE, body=J1, schedule=SCHEDULE, max_angle_deg=F(120), torque_limit=F(1),
    torque_norm=EUCLIDEAN,
)  # fmt: skip


def simulated(law: Law, start: ExactStart, t: F) -> np.ndarray:
    """Applied torque of an accurate simulation, N m, (3,)."""
    run = simulate(
        law, J1, SCHEDULE, quaternion=[float(x) for x in start.quaternion],
        rate=[float(x) for x in start.rate], horizon=t, method=DOP853(rtol=1e-13, atol=1e-15),
    )  # fmt: skip
    return run.signals([float(t)]).applied_torque[:, 0]


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
@pytest.mark.parametrize("start", [START, TUMBLING], ids=["rest", "tumbling"])
def test_the_enclosure_holds_an_independent_simulation(law, start):
    """The simulation's own error, 1e-10 over these seconds, is all that may lie outside."""
    for t in (F("0.7"), F("2.9"), F("8.5")):
        torque = EnclosedRun(law, J1, start).torque_at(SCHEDULE, t)
        for ball, value in zip(torque, simulated(law, start, t), strict=True):
            assert float(ball.rad()) < 1e-3
            assert abs(float(ball.mid()) - value) <= float(ball.rad()) + 1e-9


def test_a_coarse_enclosure_holds_a_fine_one(monkeypatch):
    """Both hold the same point, so they overlap; a wrong remainder would part them."""
    monkeypatch.setattr(enclosed, "LOCAL_ERROR", 1e-9)
    coarse = EnclosedRun(ADAPTIVE, J1, TUMBLING).torque_at(SCHEDULE, F(3))
    monkeypatch.setattr(enclosed, "LOCAL_ERROR", 1e-18)
    fine = EnclosedRun(ADAPTIVE, J1, TUMBLING).torque_at(SCHEDULE, F(3))
    for wide, narrow in zip(coarse, fine, strict=True):
        assert float(narrow.rad()) < 1e-6 * float(wide.rad())
        assert wide.contains(narrow.mid())


def test_the_check_above_can_fail(monkeypatch):
    """Without its remainder a coarse enclosure parts from the truth."""
    monkeypatch.setattr(enclosed, "LOCAL_ERROR", 1e-18)
    fine = EnclosedRun(ADAPTIVE, J1, TUMBLING).torque_at(SCHEDULE, F(3))
    monkeypatch.setattr(enclosed, "LOCAL_ERROR", 1e-6)
    own = EnclosedRun._coefficients

    def without_remainder(self, phase, state, tau, highest):
        found = own(self, phase, state, tau, highest)
        return [[*row[:-1], row[-1] * 0] for row in found] if highest == enclosed.ORDER else found

    monkeypatch.setattr(EnclosedRun, "_coefficients", without_remainder)
    coarse = EnclosedRun(ADAPTIVE, J1, TUMBLING).torque_at(SCHEDULE, F(3))
    assert not any(wide.contains(narrow.mid()) for wide, narrow in zip(coarse, fine, strict=True))


@dataclass(frozen=True)
class Clipped(Law):
    """u = -min(stiffness b0, 1) J bv: an operation without a power series."""

    name: ClassVar[str] = "clipped"
    stiffness: F

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Proportional, with a clipped gain."""
        return Control(-ca.fmin(parameters["stiffness"] * plant.b0, 1) * (plant.J @ plant.bv))


def test_a_law_without_a_series_is_refused_by_name():
    with pytest.raises(UnknownOperationError, match="fmin"):
        EnclosedRun(Clipped(F(1)), J1, START).torque_at(SCHEDULE, F(1))


@dataclass(frozen=True)
class Pointed(Law):
    """u = -stiffness J bv / |bv|^2: a pole at the target."""

    name: ClassVar[str] = "pointed"
    stiffness: F

    def control(
        self,
        plant: PlantSymbols,
        time: TimeSymbols,
        states: Mapping[str, Expression],
        parameters: Mapping[str, Expression],
    ) -> Control:
        """Proportional, divided by |bv|^2."""
        return Control(-parameters["stiffness"] / ca.sumsqr(plant.bv) * (plant.J @ plant.bv))


def test_a_start_at_a_pole_is_given_up_not_crashed_on():
    target = ExactStart((F(1), F(0), F(0), F(0)), (F("0.1"), F(0), F(0)))
    with pytest.raises(NoEnclosureError):
        EnclosedRun(Pointed(F(1)), J1, target).torque_at(SCHEDULE, F(1))


def test_a_run_too_quick_for_any_step_is_given_up(monkeypatch):
    """No box is ever accepted: steps are halved to the end, and the instant is named."""
    monkeypatch.setattr(enclosed, "LOCAL_ERROR", 0.0)
    with pytest.raises(NoEnclosureError, match="no step is short enough at t = 0 s"):
        EnclosedRun(PERSISTENCE, J1, START).torque_at(SCHEDULE, F(3))


def test_an_enclosure_that_grows_too_wide_is_given_up(monkeypatch):
    monkeypatch.setattr(enclosed, "WIDEST", 1e-14)
    with pytest.raises(NoEnclosureError, match="too wide"):
        EnclosedRun(PERSISTENCE, J1, START).torque_at(SCHEDULE, F(3))


OPEN = Claim("torque.limit", "", "", Verdict.UNDECIDED, reason="too cautious", next_step="raise the limit")


@pytest.mark.parametrize("law", LAWS, ids=lambda law: law.name)
def test_limit_is_refuted_just_below_the_torque_only(law):
    t = 1.25
    size = float(np.linalg.norm(simulated(law, START, F(t))))
    for factor, verdict in ((1 - 1e-5, Verdict.REFUTED), (1 + 1e-5, Verdict.UNDECIDED)):
        question = missions.other(QUESTION, law=law, torque_limit=F(size * factor))
        claim = refuted_limit(OPEN, question, quaternion=(0.5,) * 4, rate=(F(0),) * 3, at=t)
        assert claim.verdict is verdict
        if verdict is Verdict.REFUTED:
            assert claim.witness.violation.low <= 1e-5 * size * 1.01
            assert claim.witness.values["quaternion"][0] >= 0.5


def test_the_witness_lies_in_the_set():
    third = 1 / np.sqrt(3)
    edge = (np.cos(np.pi / 3), *(np.sin(np.pi / 3) * third,) * 3)
    start = start_inside(QUESTION, edge, (F(0),) * 3)
    assert start is not None
    assert start.quaternion[0] >= F(1, 2)
    assert sum(x * x for x in start.quaternion) == 1
    beyond = (np.cos(1.06), *(np.sin(1.06) * third,) * 3)
    assert start_inside(QUESTION, beyond, (F(0),) * 3) is None
    assert start_inside(QUESTION, edge, (F("0.01"), F(0), F(0))) is None
    assert (
        start_inside(missions.other(QUESTION, max_rate=F("0.01")), edge, (F("0.01"), F(0), F(0))) is not None
    )
