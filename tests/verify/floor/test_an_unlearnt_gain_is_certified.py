"""k(0) = 0: the gain's lower bound stays zero while g opens, then learns; what learns nothing is said."""

from dataclasses import replace
from fractions import Fraction as F

import missions
import numpy as np
import pytest
from intermit.models.ensemble import MetricOptions, simulate_ensemble
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.filter.answer import answer
from intermit.verify.filter.certify import FloorOptions, certify_floor
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.sets import InitialSet
from intermit.verify.verdict import Verdict
from problems import ADAPTIVE, J1, TILTED, paper_schedule

LAW = replace(ADAPTIVE, k0=F(0))
QUESTION = missions.question(
    law=LAW, body=J1, schedule=paper_schedule(), max_angle_deg=F(60), options=FloorOptions(max_bins=2)
)


@pytest.mark.parametrize("rate", [F(0), F(1, 10)])
def test_a_start_away_from_the_target_has_a_floor_for_all_time(rate):
    start = InitialSet.from_state(J1, [F(1, 2)] * 4, [rate, F(0), F(0)])
    floor = certify_floor(LAW, BodyBounds.of(J1), paper_schedule(), start)
    assert floor.horizon is None
    state = np.array([[*TILTED, float(rate), 0, 0]])
    run = simulate_ensemble(LAW, J1, paper_schedule(), state, horizon=F(80), metrics=MetricOptions())
    simulated = run.metrics.filter_minimum[0]
    # one state, one bin: the comparison systems lose a third of R, not more
    assert simulated / 1.5 <= floor.value <= simulated


def test_the_checker_follows_a_gain_that_is_held_at_zero():
    windows = [Window(F(8 * k) + F("0.01"), F(8 * k) + F("3.21")) for k in range(2)]
    table = build_schedule(windows, Hermite())
    found = answer(missions.other(QUESTION, schedule=table))
    (claim, *_) = found.claims
    assert claim.verdict is Verdict.PROVED
    assert any("held" in step.modes for w in found.floor.flowpipes for step in w.steps)
    (finding,) = checker.check_text(certificate_text([claim.evidence[0].details["certificate"]]))
    assert finding.valid


def test_a_set_holding_the_target_is_undecided_truly():
    for claim in answer(QUESTION).claims:
        assert claim.verdict is Verdict.UNDECIDED
        assert "k(0) = 0" in claim.reason
        assert claim.next_step == "take k0 > 0"
