"""Columns by name, units by header, separators by what stands there: read rightly or refused."""

from fractions import Fraction as F

import pytest
from intermit.scenario.csv_tables import read_rows
from intermit.scenario.errors import ScenarioError
from intermit.scenario.schedules import WINDOW_COLUMNS
from intermit.scenario.thrust import SAMPLE_COLUMNS

WINDOWS = [(F("0.01"), F("3.21")), (F("8.01"), F("11.21"))]


@pytest.fixture
def read(tmp_path):
    def windows(text, forms=WINDOW_COLUMNS, encoding="utf-8"):
        path = tmp_path / "w.csv"
        path.write_bytes(text.encode(encoding))
        table = read_rows(path, "key", forms)
        ends = [row.second + (row.first if table.form == 1 else 0) for row in table.rows]
        return [(row.first, end) for row, end in zip(table.rows, ends, strict=True)]

    return windows


@pytest.mark.parametrize(
    "text",
    [
        "0.01,3.21\n8.01,11.21\n",
        "on,off\n0.01,3.21\n8.01,11.21\n",
        "off,on\n3.21,0.01\n11.21,8.01\n",
        "on_ms,off_ms\n10,3210\n8010,11210\n",
        "On [ms];Off [ms]\n10;3210\n8010;11210\n",
        "start (us)\tstop (us)\n10000\t3210000\n8010000\t11210000\n",
        "on_s,off_ms\n0.01,3210\n8.01,11210\n",
        "on/s,off/s\n0.01,3.21\n8.01,11.21\n",
        "on;off\n0,01;3,21\n8,01;11,21\n",
        "start,stop\n0.01,3.21\n8.01,11.21\n",
        "on,duration\n0.01,3.2\n8.01,3.2\n",
        "duration_ms,on_s\n3200,0.01\n3200,8.01\n",
        "# on,off of thruster 1, in s\n0.01,3.21\n8.01,11.21\n",
        "start,end\n1e-2,3.21\n8.01,11.21\n",
        ",on,off\n0,0.01,3.21\n1,8.01,11.21\n",
        "id,thruster,on,off,note\n1,A,0.01,3.21,x\n2,B,8.01,11.21,\n",
        '"on","off"\n"0.01","3.21"\n"8.01","11.21"\n',
        "\ufeffon,off\r\n0.01,3.21\r\n\r\n8.01,11.21\r\n",
        "# windows\non,off  # s\n0.01,3.21,\n8.01,11.21,\n",
        "Window Start [s],Window End [s]\n0.01,3.21\n8.01,11.21\n",
        "onMs,offMs\n10,3210\n8010,11210\n",
        "startTime [ms],endTime [ms]\n10,3210\n8010,11210\n",
        "on (in ms),off (in ms)\n10,3210\n8010,11210\n",
        "on.ms,off.ms\n10,3210\n8010,11210\n",
        "valve open time,valve close time\n0.01,3.21\n8.01,11.21\n",
        "burn_start,burn_end\n0.01,3.21\n8.01,11.21\n",
        "on_time,off_time\n0.01,3.21\n8.01,11.21\n",
        "Time On (s);Time Off (s)\n0.01;3.21\n8.01;11.21\n",
        "start,on_time\n0.01,3.2\n8.01,3.2\n",
        "sep=,\non,off\n0.01,3.21\n8.01,11.21\n",
        '"sep=;"\r\non;off\r\n0.01;3.21\r\n8.01;11.21\r\n',
    ],
)
def test_what_spreadsheets_write_is_read_exactly(read, text):
    assert read(text) == WINDOWS


def test_utf_16_is_read_by_its_mark_others_are_refused(read):
    text = "on [µs],off [µs]\n10000,3210000\n8010000,11210000\n"
    assert read(text, encoding="utf-16") == read(text, encoding="utf-8-sig") == WINDOWS
    for encoding in ("latin-1", "utf-32"):
        with pytest.raises(ScenarioError, match="save it as UTF-8"):
            read(text, encoding=encoding)


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("on_duration,off_duration\n0.01,3.2\n", "a duration needs the instant"),
        ("on_time,off_time\n0.01,3.2\n", "may be instants or durations"),
        ("on_time,off_time\n3.2,4.8\n3.2,4.8\n", "may be instants or durations"),
        ("on_time_ms,off_time\n10,3210\n8010,11210\n", "only one of"),
        ("on_ticks,off_ticks\n10,3210\n", "'on_ticks' does not end in a unit that is known: ns"),
        ("onMS,offMS\n10,3210\n", "'onMS' does not end in a unit"),
        ("on Ms,off Ms\n10,3210\n", "'on Ms' does not end in a unit"),
        ("on;off\n0.01,3.21\n", "received '0.01,3.21' (cells are separated by semicolons here)"),
        ("on [ticks],off [ticks]\n10,3210\n", "the unit 'ticks' of 'on' is none of ns, us, ms, s"),
        ("on,onn\n1,2\n", "did you mean 'on' for 'onn'"),
        ("on,off,duration\n1,2,1\n", "in more than one way"),
        ("on,start,off\n1,1,2\n", "in more than one way"),
        ("on,off\n1\n", "expected two numbers"),
        ("on_ms,off\n10,3.2\n", "only one of"),
        ("on,duration [ms]\n1,3200\n", "only one of"),
        ("# on_ms,off_ms\n10,3210\n", "a comment speaks of 'ms'"),
        ("# times in ms\non,off\n10,3210\n", "a comment speaks of 'ms'"),
        ("on;off\n1,000;2,000\n", "decimal or thousands"),
        ("on,off\n2020-03-30T21:59:34,2020-03-30T22:06:16\n", "give schedule.epoch"),
        ("on,off\n1,5,2,5\n", "expected two numbers"),
        ('on,off\n"0.01,3.21\n', "cannot be split into cells"),
        ("0.01;3.21;4\n", "expected two numbers"),
        ("on,off\n1 000,1 003\n", "expected a number"),
    ],
)
def test_what_could_mean_two_things_is_refused(read, text, words):
    with pytest.raises(ScenarioError, match=r"w\.csv line \d+") as caught:
        read(text)
    assert words in str(caught.value)


def test_thrust_keeps_its_unit_and_unknown_ones_are_refused(read):
    """Only the ratio to full thrust counts, which the scenario states in the unit of the column."""
    assert read("time [ms],thrust [mN]\n0,0\n500,20\n", SAMPLE_COLUMNS) == [(0, 0), (F(1, 2), 20)]
    assert read("t_s,torque (mN m)\n0,0\n1,20\n", SAMPLE_COLUMNS) == [(0, 0), (1, 20)]
    with pytest.raises(ScenarioError, match="the unit 'lbf'"):
        read("time,thrust [lbf]\n0,0\n1,2\n", SAMPLE_COLUMNS)
