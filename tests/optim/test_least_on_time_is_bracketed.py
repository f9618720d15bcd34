"""The inverse question: the on-time that suffices does, the one that fails does not, and they are close."""

from fractions import Fraction as F

import pytest
from intermit.models.norms import EUCLIDEAN
from intermit.optim.schedule_study import ScheduleFamily, least_on_time
from intermit.optim.tuning.conditions import certified_floor
from intermit.optim.tuning.front import best_possible
from missions import mission_from
from problems import J1, PERSISTENCE, TILTED, paper_schedule

MISSION = mission_from(J1, paper_schedule(as_printed=False), TILTED, horizon=F(56))
QUESTION = {"time": F(28), "norm": EUCLIDEAN, "floor": certified_floor, "resolution": F(1)}


@pytest.mark.slow
def test_bracket_holds_and_names_what_fails():
    limit = F("0.06")
    answer = least_on_time(PERSISTENCE, MISSION, F(8), torque_limit=limit, **QUESTION)
    assert answer.suffices is not None
    assert 0 < answer.suffices - answer.fails <= 1
    assert answer.floor > 0
    assert answer.optimum <= limit
    assert "torque limit" in answer.limiting
    below = ScheduleFamily().applied_to(MISSION, F(8), answer.fails)
    assert best_possible(below, F(28), EUCLIDEAN).optimum > limit


@pytest.mark.slow
def test_hopeless_limit_is_said_so():
    answer = least_on_time(PERSISTENCE, MISSION, F(8), torque_limit=F("0.001"), **QUESTION)
    assert answer.suffices is None
    assert "torque limit" in answer.limiting
