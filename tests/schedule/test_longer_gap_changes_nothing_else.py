"""A longer gap moves what comes later and leaves every integral of g^2 as it was."""

from __future__ import annotations

from fractions import Fraction as F

import pytest
from intermit.models.schedule import Hermite, Schedule, Window, build_schedule, longer_gap
from intermit.verify.schedule.zero_runs import longest_zero_run

ONE = build_schedule([Window(F(1, 100), F(321, 100))], Hermite(), period=F(8))
THREE = build_schedule([Window(F(0), F(2)), Window(F(3), F(5)), Window(F(9), F(10))], Hermite())
UP_TO_THE_END = build_schedule([Window(F(2), F(4))], Hermite(), period=F(4))


@pytest.mark.parametrize("schedule", [ONE, THREE, UP_TO_THE_END])
@pytest.mark.parametrize("extra", [F(0), F(1, 3), F(20)])
def test_only_the_gap_grows(schedule: Schedule, extra: F) -> None:
    run = longest_zero_run(schedule)
    assert run is not None
    longer = longer_gap(schedule, run.on, extra)
    grown = longest_zero_run(longer)
    assert grown is not None
    assert grown.length == run.length + extra
    assert longer.end == schedule.end + extra
    assert longer.square_integral(F(0), longer.end) == schedule.square_integral(F(0), schedule.end)
    assert [w.length for w in longer.windows] == [w.length for w in schedule.windows]


def test_a_gap_cannot_shrink_nor_open_where_g_acts() -> None:
    with pytest.raises(ValueError, match="only grow"):
        longer_gap(ONE, F(321, 100), F(-1))
    with pytest.raises(ValueError, match="g acts"):
        longer_gap(ONE, F(1, 100), F(1))
    with pytest.raises(ValueError, match="at a knot"):
        longer_gap(ONE, F(5), F(1))
