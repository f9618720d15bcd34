"""Units on pages and in exported columns are those of J in kg m^2 and Omega in rad/s."""

from types import SimpleNamespace

import numpy as np
import pytest
from intermit.reports.content import runs
from intermit.reports.content.blocks import charts_of
from intermit.reports.content.chapters import chapters
from intermit.reports.record.base import unit_of
from intermit.reports.record.runs import BoundArrays, RunArrays


def test_chart_of_storage_has_the_units_of_its_columns(monkeypatch):
    values = np.array([2.0, 1.0])
    run = SimpleNamespace(
        key="law", label="law", time=np.array([0.0, 1.0]), array=lambda r: None if "bound" in r else values
    )
    monkeypatch.setattr(runs, "runs_of", lambda _: [run])
    monkeypatch.setattr(runs, "shaded", lambda _: ())
    chapter = runs.storage_chapter(None)
    charts = [chart for block in chapter.blocks for chart in block.charts]
    assert [chart.y.unit for chart in charts] == ["kg m^2/s", "kg m^2/s^2"]


def test_each_unit_stands_in_its_field():
    """V is of the dimension of Omega'J (kg m^2/s); its derivative has one more second."""
    storage, rate = (unit_of(RunArrays, name) for name in ("storage", "storage_rate"))
    assert rate == f"{storage}^2"
    assert unit_of(RunArrays, "storage_bound") == storage == "kg m^2/s"
    assert unit_of(BoundArrays, "rate_bound") == "kg^1/2 m rad/s"
    assert unit_of(BoundArrays, "speed_bound") == unit_of(RunArrays, "rate") == "rad/s"
    assert unit_of(BoundArrays, "torque_bound") == unit_of(RunArrays, "torque") == "N m"
    with pytest.raises(KeyError):
        unit_of(RunArrays, "invented")


@pytest.mark.parametrize(
    ("key", "chapter", "unit"),
    [
        ("bound-torque", "torque", "N m"),
        ("bound-speed", "attitude", "rad/s"),
        ("bound-angle", "attitude", "rad"),
    ],
)
def test_bounds_over_time_have_a_figure_with_their_unit(record, key, chapter, unit):
    (found,) = (c for c in chapters(record) if c.key == chapter)
    (chart,) = (c for c in charts_of([found]) if c.key == key)
    assert chart.y.unit == unit
    assert len(chart.lines) == len(record.sections.cases)
