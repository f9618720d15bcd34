"""Missed windows and shifted edges change the schedule exactly as they say, and keep g C1."""

from fractions import Fraction

import pytest
from intermit.models.schedule import (
    Hermite,
    Window,
    build_schedule,
    missing_in_a_row,
    shifted_edges,
    unrolled,
    without_windows,
)
from intermit.verify.schedule.facts import schedule_claims
from intermit.verify.schedule.zero_runs import longest_zero_run
from intermit.verify.verdict import Verdict

F = Fraction


def paper(overrun="0"):
    return build_schedule([Window(F("0.01"), F("3.21"))], Hermite(F(overrun)), period=F(8))


def table():
    return build_schedule([Window(F(8 * k + 1), F(8 * k + 4)) for k in range(4)], Hermite())


def smooth(schedule):
    return next(c for c in schedule_claims(schedule) if c.key == "schedule.smooth").verdict is Verdict.PROVED


def test_unrolled_is_the_same_function():
    once, thrice = paper("0.01"), unrolled(paper("0.01"), 3)
    assert thrice.period == 24
    assert len(thrice.windows) == 3
    for k in range(300):
        t = F(k, 7)
        assert once.square_integral(F(0), t) == thrice.square_integral(F(0), t)


@pytest.mark.parametrize("overrun", ["0", "0.01"])
@pytest.mark.parametrize("count", [1, 2, 3])
def test_windows_missed_in_a_row_leave_one_long_gap(overrun, count):
    schedule = missing_in_a_row(paper(overrun), count, cycles=5)
    assert smooth(schedule)
    assert len(schedule.windows) == 5 - count
    assert longest_zero_run(schedule).length == 8 * (count + 1) - F("3.2") - F(overrun)
    per_window = paper(overrun).square_integral(F(0), F(8))
    assert schedule.square_integral(F(0), F(40)) == (5 - count) * per_window


def test_missing_from_a_finite_table():
    schedule = without_windows(table(), {1, 2})
    assert [w.on for w in schedule.windows] == [1, 25]
    assert smooth(schedule)
    assert longest_zero_run(schedule).length == 21


def test_missing_what_is_not_there():
    with pytest.raises(ValueError, match="there is no window 4"):
        without_windows(table(), {4})
    with pytest.raises(ValueError, match="no window would be left"):
        without_windows(table(), range(4))
    with pytest.raises(ValueError, match="has no period"):
        unrolled(table(), 2)


def test_shifted_edges_squeeze_g_with_its_integral():
    """Integral of g^2 scales with the window; g stays inside it and C1."""
    before = table()
    after = shifted_edges(before, open_later=F("0.5"), close_earlier=F("0.25"))
    assert [w.on for w in after.windows] == [w.on + F("0.5") for w in before.windows]
    assert all(c.verdict is Verdict.PROVED for c in schedule_claims(after))
    ratio = F("2.25") / 3
    assert after.square_integral(F(0), F(40)) == ratio * before.square_integral(F(0), F(40))
    rebuilt = build_schedule(after.windows, Hermite())
    for k in range(300):
        assert after.square_integral(F(0), F(k, 8)) == rebuilt.square_integral(F(0), F(k, 8))


def test_edges_cannot_be_shifted_away():
    with pytest.raises(ValueError, match="would vanish"):
        shifted_edges(table(), open_later=F(3))
    with pytest.raises(ValueError, match="would open before 0 s"):
        shifted_edges(table(), open_later=F(-2))
    with pytest.raises(ValueError, match="still acts"):
        shifted_edges(table(), close_earlier=F(-6))
