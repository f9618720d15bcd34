"""CSV and MATLAB files hold the record's own numbers, to the last bit, under names any program takes."""

import io

import numpy as np
import pytest
from hostile_text import HOSTILE
from intermit.reports import Record
from intermit.reports.exports import export_files
from intermit.reports.exports.matfile import mat_bytes
from intermit.reports.exports.series import series_of
from respoken import respoken
from scipy.io import loadmat


def test_csv_reads_back_exactly(record: Record) -> None:
    files = export_files(record)
    for series in series_of(record):
        text = files[f"series/{series.name}.csv"].decode("ascii")
        title, head = text.splitlines()[:2]
        assert title.startswith("# ")
        names = [name.split(" [")[0] for name in head.split(",")]
        values = np.loadtxt(io.StringIO(text), delimiter=",", skiprows=2)
        assert names == [name for name, _, _ in series.columns]
        assert np.array_equal(values, np.column_stack([v for _, _, v in series.columns]))
    assert "torque_0 [N m]" in files["series/run-1-1-adaptive-scaling-gamma-0-1.csv"].decode()


def test_mat_reads_back_exactly(record: Record) -> None:
    loaded = loadmat(io.BytesIO(export_files(record)["series.mat"]), squeeze_me=True)
    for series in series_of(record):
        held = loaded[series.name.replace("-", "_")]
        for name, _, values in series.columns:
            assert np.array_equal(held[name].item(), values)


def test_every_run_certificate_and_optimum_is_there(record: Record) -> None:
    names = [s.name for s in series_of(record)]
    assert len(names) == len(set(names)) == 1 + 2 + 2 + 2


@pytest.mark.parametrize("kind", HOSTILE)
def test_hostile_names_make_plain_files(record: Record, kind: str) -> None:
    files = export_files(respoken(record, HOSTILE[kind]))
    for name, data in files.items():
        assert name.isascii()
        assert ".." not in name
        assert len(name) < 80
        if name.endswith(".csv"):
            first, head = data.decode("ascii").split("\n")[:2]
            assert first.startswith("# ")
            assert head.startswith("time")
    assert loadmat(io.BytesIO(files["series.mat"]))


def test_what_the_format_cannot_hold_is_refused() -> None:
    with pytest.raises(ValueError, match="more than 63"):
        mat_bytes({"a": {"x" * 64: np.zeros(3)}})
