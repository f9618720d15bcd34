"""A long table: every claim covers all of its windows, or says up to when it speaks."""

from fractions import Fraction as F

import missions
import pytest
from intermit.models.schedule import Ramps, Window, build_schedule
from intermit.verify.filter.answer import MAX_TABLE_WINDOWS, answer
from intermit.verify.schedule.excitation import excitation_claim
from intermit.verify.schedule.facts import schedule_claims
from intermit.verify.verdict import Verdict
from problems import J1, PERSISTENCE


def table(count, **options):
    windows = [Window(F(8 * k + 1), F(8 * k + 4)) for k in range(count)]
    return build_schedule(windows, Ramps(F(1), F(1)), **options)


def claims(schedule):
    question = missions.question(
        law=PERSISTENCE, body=J1, schedule=schedule, max_angle_deg=F(90), torque_limit=F(1000)
    )
    return {claim.key: claim for claim in answer(question).claims}


def test_more_than_a_hundred_windows_are_all_covered():
    schedule = table(130)
    found = claims(schedule)
    for key in ("filter.floor", "torque.limit"):
        assert found[key].verdict is Verdict.PROVED
        assert "on [0, 1036 s]" in found[key].statement


def test_of_a_longer_table_the_claims_say_up_to_when_they_speak():
    schedule = table(MAX_TABLE_WINDOWS + 30)
    found = claims(schedule)
    end = f"[0, {8 * (MAX_TABLE_WINDOWS - 1) + 4} s]"
    for key in ("filter.floor", "torque.limit"):
        assert found[key].verdict is Verdict.PROVED
        assert end in found[key].statement
    assert found["convergence"].verdict is Verdict.UNDECIDED
    assert end in found["convergence"].next_step


def test_a_long_period_is_undecided_and_says_why():
    found = claims(table(130, period=F(1040)))
    for key in ("filter.floor", "convergence", "torque.limit"):
        assert found[key].verdict is Verdict.UNDECIDED
        assert "certified on [0, 80" in found[key].reason


@pytest.mark.parametrize("count", [130, 500])
def test_facts_of_the_schedule_see_the_last_window(count):
    """One flaw, in the last window: it is found wherever it is."""
    windows = [Window(F(8 * k + 1), F(8 * k + 4)) for k in range(count)]
    good = build_schedule(windows, Ramps(F(1), F(1)))
    assert all(c.verdict is Verdict.PROVED for c in (*schedule_claims(good), excitation_claim(good)))
    last = build_schedule([*windows[:-1], Window(windows[-1].on, F(8 * count + 8))], Ramps(F(1), F(1)))
    flawed = type(good)(windows=good.windows, profile=last.profile)
    verdicts = {c.key: c.verdict for c in schedule_claims(flawed)}
    assert verdicts["schedule.support"] is Verdict.REFUTED
