"""Units on pages and in exported columns are those of J in kg m^2 and Omega in rad/s."""

from types import SimpleNamespace

import numpy as np
from intermit.reports.content import runs
from intermit.reports.exports.series import UNITS


def test_chart_of_storage_has_the_units_of_its_columns(monkeypatch):
    values = np.array([2.0, 1.0])
    run = SimpleNamespace(
        key="law", label="law", time=np.array([0.0, 1.0]), array=lambda r: None if "bound" in r else values
    )
    monkeypatch.setattr(runs, "runs_of", lambda _: [run])
    monkeypatch.setattr(runs, "shaded", lambda _: ())
    chapter = runs.storage_chapter(None)
    charts = [chart for block in chapter.blocks for chart in block.charts]
    assert [chart.y.unit for chart in charts] == [UNITS["storage"], UNITS["storage_rate"]]
    # V is of the dimension of Omega'J (kg m^2/s); its derivative has one more second.
    assert UNITS["storage_rate"] == f"{UNITS['storage']}^2"
    assert UNITS["storage_bound"] == UNITS["storage"] == "kg m^2/s"
    assert UNITS["rate_bound"] == "kg^1/2 m rad/s"
