"""Edges that two sums of floats write differently are one instant; true gaps stay gaps."""

from fractions import Fraction as F

import pytest

TABLE = "windows = [[0, 0.3], [{}, 0.9]]"


@pytest.mark.parametrize("edge", ["0.30000000000000004", "0.29999999999999998", "0.300000000000000001"])
def test_an_edge_off_by_rounding_touches_and_is_said(workshop, edge):
    scenario = workshop.load(schedule=TABLE.format(edge))
    first, second = scenario.schedule.windows
    assert first.off == second.on == F("0.3")
    assert any("taken as the same instant" in warning for warning in scenario.warnings)


def test_a_touching_edge_is_left_alone_without_a_word(workshop):
    assert not workshop.load(schedule=TABLE.format("0.3")).warnings


def test_a_gap_of_a_microsecond_stays_a_gap(workshop):
    scenario = workshop.load(schedule=TABLE.format("0.300001"))
    assert scenario.schedule.windows[1].on == F("0.300001")
    assert not scenario.warnings


def test_an_overlap_of_a_microsecond_is_refused(workshop):
    assert "not overlap" in workshop.complaint(schedule=TABLE.format("0.299999"))
