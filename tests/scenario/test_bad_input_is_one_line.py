"""Bad input is refused in one line that names the file and the key or CSV line."""

import os

import pytest
from intermit.scenario import ScenarioError, load_scenario

INERTIA = "inertia = [[{}, 0, 0], [0, {}, 0], [0, 0, {}]]"


def test_the_sound_scenario_loads(workshop):
    assert workshop.load().warnings == ()


BAD_TABLES = {
    "overlapping windows": (
        {"schedule": "windows = [[0.01, 3.21], [8.01, 16.21], [16.01, 19.21]]"},
        "scenario.toml: schedule.windows[3]: opens (16.01 s) before the window above it closes (16.21 s): "
        "windows must be in order and not overlap",
    ),
    "off before on": (
        {"schedule": "windows = [[0.01, 3.21], [8.01, 7.21]]"},
        "scenario.toml: schedule.windows[2]: closes (7.21 s) before it opens (8.01 s)",
    ),
    "negative time": (
        {"schedule": "windows = [[-0.01, 3.21]]"},
        "scenario.toml: schedule.windows[1]: opens at -0.01 s: times start at 0 s "
        "(or at initial.time, if it is given)",
    ),
    "window after the period": (
        {"schedule": "windows = [[0.01, 3.21], [8.01, 11.21]]\nperiod = 11"},
        "scenario.toml: schedule.windows[2]: closes (11.21 s) after the period ends (11 s)",
    ),
    "no windows": (
        {"schedule": "windows = []"},
        "scenario.toml: schedule.windows: is empty: give at least one [on, off] pair",
    ),
    "a window of three numbers": (
        {"schedule": "windows = [[0.01, 3.21, 4.0]]"},
        "scenario.toml: schedule.windows[1]: expected 2 entries, received 3",
    ),
    "no form of schedule": (
        {"schedule": "period = 8"},
        "scenario.toml: schedule: expected exactly one of windows, csv, on_time (with period), thrust; "
        "received none of them",
    ),
    "two forms of schedule": (
        {"schedule": 'csv = "a.csv"\nperiod = 8\non_time = 3.2'},
        "scenario.toml: schedule: expected exactly one of windows, csv, on_time (with period), thrust; "
        "received csv and on_time",
    ),
    "on-time beyond the period": (
        {"schedule": "period = 3\non = 0.01\non_time = 3.2"},
        "scenario.toml: schedule.on_time: on + on_time = 3.21 s goes beyond the period of 3 s",
    ),
    "on-time without period": (
        {"schedule": "on_time = 3.2"},
        "scenario.toml: schedule.period: required with on_time, but missing",
    ),
    "ramps that do not fit": (
        {"schedule": 'windows = [[1, 2]]\nshape = "ramps"\nramp_up = 0.6\nramp_down = 0.6'},
        "scenario.toml: schedule: ramp_up + ramp_down = 1.2 s does not fit in the window [1, 2] s",
    ),
    "ramps without a ramp": (
        {"schedule": 'windows = [[1, 2]]\nshape = "ramps"\nramp_up = 0.5'},
        "scenario.toml: schedule.ramp_down: required with shape = 'ramps', but missing",
    ),
    "an unknown shape": (
        {"schedule": 'windows = [[1, 2]]\nshape = "boxcar"'},
        'scenario.toml: schedule.shape: expected "hermite", "hermite-as-printed" or "ramps", '
        "received 'boxcar'",
    ),
    "inertia not symmetric": (
        {"spacecraft": "inertia = [[3, 0.2, 0], [0.1, 3, 0], [0, 0, 2]]"},
        "scenario.toml: spacecraft.inertia: inertia must be symmetric: "
        "entry (2,1) is 0.1, entry (1,2) is 0.2",
    ),
    "inertia not positive definite": (
        {"spacecraft": INERTIA.format(3, -1, 2)},
        "scenario.toml: spacecraft.inertia: inertia must be positive definite",
    ),
    "inertia of two rows": (
        {"spacecraft": "inertia = [[1, 0, 0], [0, 1, 0]]"},
        "scenario.toml: spacecraft.inertia: expected three rows of three numbers, [[3, 0, 0], [0, 2.5, 0], "
        "[0, 0, 2]] for instance (or inertia_moments with inertia_products), received [[1, 0, 0], [0, 1, 0]]",
    ),
    "a period of no length": (
        {"schedule": "windows = [[0, 1], [2, 2]]"},
        "scenario.toml: schedule.windows[2]: is empty: it opens and closes at 2 s",
    ),
    "a key with another unit": (
        {"initial": "axis = [1, 1, 1]\nangle_deg = 60\nrate_deg_s = [1, 0, 0]"},
        "scenario.toml: initial.rate_deg_s: unknown key (did you mean 'rate', in rad/s?)",
    ),
    "an angle in radians": (
        {"initial": "axis = [1, 1, 1]\nangle_rad = 1"},
        "scenario.toml: initial.angle_rad: unknown key (did you mean 'angle_deg', in deg?)",
    ),
    "a number with its unit": (
        {"schedule": 'period = "8 s"\non_time = 3'},
        "scenario.toml: schedule.period: expected a number, received '8 s': write it alone, in s",
    ),
    "a law misspelt": (
        {"law": 'type = "persistence_filter"\nlambda = 1'},
        'scenario.toml: law[1].type: expected one of "adaptive-scaling", "adaptive-scaling-as-printed", '
        '"persistence-filter", "persistence-filter-as-printed", "quaternion-pd", "user", received '
        "'persistence_filter' (did you mean \"persistence-filter\"?)",
    ),
    "no inertia": (
        {"spacecraft": ""},
        "scenario.toml: spacecraft.inertia: required, but missing (or give inertia_moments with "
        "inertia_products)",
    ),
    "inertia beyond following": (
        {"spacecraft": INERTIA.format(3, "1e12", 2)},
        "scenario.toml: spacecraft.inertia: principal inertias from 2 to 1e+12 kg m^2: their ratio is 5e+11, "
        "and beyond 1e+06 no motion can be followed in double precision",
    ),
    "no spacecraft": ({"spacecraft": None}, "scenario.toml: spacecraft: required, but missing"),
    "negative tolerance": (
        {"spacecraft": INERTIA.format(3, 3, 2) + "\ninertia_tolerance = -0.1"},
        "scenario.toml: spacecraft.inertia_tolerance: must be >= 0, received -0.1",
    ),
    "quaternion not unit": (
        {"initial": "quaternion = [0.5, 0.5, 0.5, 0.6]"},
        "scenario.toml: initial.quaternion: must be a unit quaternion, scalar first, received norm 1.053565",
    ),
    "quaternion and axis": (
        {"initial": "quaternion = [1, 0, 0, 0]\naxis = [1, 0, 0]\nangle_deg = 3"},
        "scenario.toml: initial: expected either quaternion, or axis with angle_deg",
    ),
    "zero axis": (
        {"initial": "axis = [0, 0, 0]\nangle_deg = 3"},
        "scenario.toml: initial.axis: must not be zero",
    ),
    "no start": (
        {"initial": None},
        "scenario.toml: initial: required (or [initial_set]), but missing",
    ),
    "a start outside its set": (
        {"initial_set": "max_angle_deg = 90"},
        "scenario.toml: initial_set.max_angle_deg: "
        "the initial state's error angle, 120 deg, lies outside 90 deg",
    ),
    "a turning start in a set at rest": (
        {
            "initial_set": "max_angle_deg = 120",
            "initial": "axis = [1, 1, 1]\nangle_deg = 120\nrate = [0, 0.1, 0]",
        },
        "scenario.toml: initial_set.max_rate: required (or max_weighted_rate) since the initial state turns, "
        "but missing",
    ),
    "a start that turns too fast for its set": (
        {
            "initial_set": "max_angle_deg = 120\nmax_weighted_rate = 0.1",
            "initial": "axis = [1, 1, 1]\nangle_deg = 120\nrate = [0, 0.1, 0]",
        },
        "scenario.toml: initial_set.max_weighted_rate: the initial state's sqrt(w' J w), "
        "0.163095 sqrt(kg m^2)/s, lies outside 0.1",
    ),
    "negative lambda": (
        {"law": 'type = "persistence-filter"\nlambda = -0.5\nR0 = 1'},
        "scenario.toml: law[1].lambda: must be > 0, received -0.5",
    ),
    "lambda missing": (
        {"law": 'type = "persistence-filter"\nR0 = 1'},
        "scenario.toml: law[1].lambda: required (here or in [law_defaults]), but missing",
    ),
    "a parameter of another law": (
        {"law": 'type = "persistence-filter"\nlambda = 0.5\nR0 = 1\ngamma = 0.1'},
        'scenario.toml: law[1].gamma: a law of type "persistence-filter" '
        "has no such parameter (it has lambda, R0)",
    ),
    "an unknown law": (
        {"law": 'type = "bang-bang"'},
        'scenario.toml: law[1].type: expected one of "adaptive-scaling", "adaptive-scaling-as-printed", '
        '"persistence-filter", "persistence-filter-as-printed", "quaternion-pd", "user", '
        "received 'bang-bang'",
    ),
    "nan": (
        {"initial": "quaternion = [0.5, 0.5, 0.5, nan]"},
        "scenario.toml: initial.quaternion[4]: expected a finite number, received NaN",
    ),
    "inf": (
        {"schedule": "windows = [[0.01, inf]]"},
        "scenario.toml: schedule.windows[1][2]: expected a finite number, received Infinity",
    ),
    "a number out of any range": (
        {"law": 'type = "persistence-filter"\nlambda = 1e999999\nR0 = 1'},
        "scenario.toml: law[1].lambda: expected 0 or a number between 1e-30 and 1e30 with at most 60 digits, "
        "received 1e+999999",
    ),
    "a text where a number belongs": (
        {"law": 'type = "persistence-filter"\nlambda = "fast"\nR0 = 1'},
        "scenario.toml: law[1].lambda: expected a number, received 'fast': write it alone, in 1/s",
    ),
    "true where a number belongs": (
        {"law": 'type = "persistence-filter"\nlambda = true\nR0 = 1'},
        "scenario.toml: law[1].lambda: expected a number, received true",
    ),
    "more samples than there are points": (
        {"check": "samples = 1073741825"},
        "scenario.toml: check.samples: expected at most 1073741824 (distinct points), received 1073741825",
    ),
    "an unknown key": (
        {"spacecraft": INERTIA.format(3, 3, 2) + "\ninertai = 3"},
        "scenario.toml: spacecraft.inertai: unknown key (did you mean 'inertia', in kg m^2?)",
    ),
    "an unknown table": (
        {"tolerances": "attitude = 0.1"},
        "scenario.toml: tolerances: unknown key (did you mean 'tolerance'?)",
    ),
    "a number where a table belongs": (
        {"head": "tolerance = 3"},
        "scenario.toml: tolerance: expected a table, received 3",
    ),
    "line breaks in what is quoted": (
        {"law": 'type = "a\\nb\\u001b[31m"'},
        'scenario.toml: law[1].type: expected one of "adaptive-scaling", "adaptive-scaling-as-printed", '
        '"persistence-filter", "persistence-filter-as-printed", "quaternion-pd", "user", '
        "received 'a\\nb\\x1b[31m'",
    ),
}


@pytest.mark.parametrize(("tables", "message"), BAD_TABLES.values(), ids=BAD_TABLES)
def test_bad_table(workshop, tables, message):
    assert workshop.complaint(**tables) == message


def test_triangle_inequality_is_only_a_warning(workshop):
    (warning,) = workshop.load(spacecraft=INERTIA.format(1, 1, 3)).warnings
    assert warning.startswith("scenario.toml: spacecraft.inertia: breaks the triangle inequality")
    assert workshop.load(spacecraft=INERTIA.format(1, 2, 3)).warnings == ()


def test_the_long_way_round_is_a_warning(workshop):
    (warning,) = workshop.load(initial="axis = [0, 0, 1]\nangle_deg = 240").warnings
    assert "error angle up to 240 deg" in warning
    assert workshop.load(initial="axis = [0, 0, 1]\nangle_deg = 180").warnings == ()


BAD_CSV = {
    "overlap": ("on,off\n0,3\n2,5\n", " line 3: opens (2 s) before the window above it closes (3 s): "
                "windows must be in order and not overlap"),
    "off before on": ("0,3\n5,4\n", " line 2: closes (4 s) before it opens (5 s)"),
    "empty": ("", ": is empty: expected rows 'on,off'"),
    "comments only": ("# nothing\n\n", ": is empty: expected rows 'on,off'"),
    "header only": ("on,off\n", ": has a header and no rows: expected rows 'on,off'"),
    "other columns": ("a,b\n3,0\n", " line 1: expected the header 'on,off' or 'on,duration', received 'a,b'"),
    "not a number": ("0,3\n8,x\n", " line 2: expected a number, received 'x'"),
    "a hole": ("0,3\n8,\n", " line 2: expected a number, received ''"),
    "nan": ("0,3\nnan,9\n", " line 2: expected a finite number, received 'nan'"),
    "inf": ("0,inf\n", " line 1: expected a finite number, received 'inf'"),
    "three columns": ("0,3,4\n", " line 1: expected two numbers, 'on,off', received '0,3,4'"),
    "spaces": ("0 3\n", " line 1: expected two numbers, 'on,off', received '0 3' (cells are separated by "
              "commas here)"),
    "huge": ("0,1e9999\n", " line 1: expected 0 or a number between 1e-30 and 1e30 with at most 60 digits, "
             "received 1e+9999"),
}  # fmt: skip


@pytest.mark.parametrize(("text", "message"), BAD_CSV.values(), ids=BAD_CSV)
def test_bad_csv(workshop, text, message):
    (workshop.folder / "w.csv").write_text(text)
    assert workshop.complaint(schedule='csv = "w.csv"') == f"scenario.toml: schedule.csv: w.csv{message}"


def test_csv_that_is_no_text(workshop):
    (workshop.folder / "w.csv").write_bytes(b"on,off\n0,3\xff\n")
    complaint = workshop.complaint(schedule='csv = "w.csv"')
    assert complaint == "scenario.toml: schedule.csv: w.csv: is not UTF-8 text (byte 11): save it as UTF-8"


def test_csv_that_is_missing_or_a_directory_or_huge(workshop):
    start = "scenario.toml: schedule.csv: w.csv: "
    assert workshop.complaint(schedule='csv = "w.csv"') == start + "no such file"
    (workshop.folder / "d.csv").mkdir()
    complaint = workshop.complaint(schedule='csv = "d.csv"')
    assert complaint == "scenario.toml: schedule.csv: d.csv: is a directory, expected a file"
    with (workshop.folder / "w.csv").open("w") as stream:
        stream.truncate(100 * 2**20)
    complaint = workshop.complaint(schedule='csv = "w.csv"')
    assert complaint == start + "has 100.0 MB: files over 10 MB are refused"


def test_scenario_file_that_is_no_scenario(tmp_path):
    def complaint(path):
        with pytest.raises(ScenarioError) as caught:
            load_scenario(path)
        assert "\n" not in str(caught.value)
        return str(caught.value).replace(str(tmp_path) + "/", "")

    assert complaint(tmp_path / "none.toml") == "none.toml: no such file"
    assert complaint(tmp_path / "a\nb.toml") == "a\\nb.toml: no such file"
    folder = tmp_path / "folder.toml"
    folder.mkdir()
    assert complaint(folder) == "folder.toml: is a directory, expected a file"
    big = tmp_path / "big.toml"
    with big.open("w") as stream:
        stream.truncate(100 * 2**20)
    assert complaint(big) == "big.toml: has 100.0 MB: files over 10 MB are refused"
    latin = tmp_path / "latin.toml"
    latin.write_bytes(b'name = "\xe9"')
    assert complaint(latin) == "latin.toml: is not UTF-8 text (byte 9): save it as UTF-8"
    broken = tmp_path / "broken.toml"
    broken.write_text("name = ")
    assert complaint(broken) == "broken.toml: is not valid TOML: Invalid value (at end of document)"
    deep = tmp_path / "deep.toml"
    deep.write_text("a = " + "[" * 100_000)
    assert complaint(deep) == "deep.toml: is not valid TOML: nested too deeply"
    digits = tmp_path / "digits.toml"
    digits.write_text("a = " + "1" * 10_000)
    assert complaint(digits).startswith("digits.toml: holds a number that cannot be read")
    pipe = tmp_path / "pipe.toml"
    os.mkfifo(pipe)
    assert complaint(pipe) == "pipe.toml: is not a regular file"
    empty = tmp_path / "empty.toml"
    empty.write_text("")
    assert complaint(empty) == "empty.toml: spacecraft: required, but missing (and 1 more problem)"


AT_REST = ": g must be C1 with no thrust before and after the record"
BAD_THRUST = {
    "times not increasing": (
        "0,0\n1,1\n1,0\n",
        "",
        ": t.csv line 3: time 1 s does not come after 1 s in the row above it",
    ),
    "negative time": (
        "-1,0\n1,1\n2,0\n",
        "",
        ": t.csv line 1: time -1 s: times start at 0 s (or at initial.time, if it is given)",
    ),
    "beyond the period": (
        "0,0\n1,1\n9,0\n",
        "period = 8\n",
        ": t.csv line 3: time 9 s comes after the period ends (8 s)",
    ),
    "header only": (
        "time,thrust\n",
        "",
        ": t.csv: has a header and no rows: expected rows 'time,thrust'",
    ),
    "wrong header": (
        "on,off\n0,0\n",
        "",
        ": t.csv line 1: expected the header 'time,thrust', received 'on,off'",
    ),
    "no thrust": ("0,0\n1,0\n2,0\n", "", ": t.csv: no sample shows any thrust"),
    "two samples": ("0,0\n1,1\n", "", ": t.csv: expected at least three thrust samples, received 2"),
    "thrust at the start": (
        "0,1\n1,1\n2,0\n",
        "",
        ": t.csv: the first sample (0 s) must be zero, received g = 1" + AT_REST,
    ),
    "thrust at the end": (
        "0,0\n1,1\n2,0.5\n",
        "",
        ": t.csv: the last sample (2 s) must be zero, received g = 0.5" + AT_REST,
    ),
}


@pytest.mark.parametrize(("text", "extra", "message"), BAD_THRUST.values(), ids=BAD_THRUST)
def test_bad_thrust_samples(workshop, text, extra, message):
    (workshop.folder / "t.csv").write_text(text)
    schedule = extra + 'thrust = { csv = "t.csv", zero_below = 0.02 }'
    assert workshop.complaint(schedule=schedule) == f"scenario.toml: schedule.thrust.csv{message}"


def test_thrust_needs_its_threshold(workshop):
    complaint = workshop.complaint(schedule='thrust = { csv = "t.csv" }')
    assert complaint == "scenario.toml: schedule.thrust.zero_below: required, but missing"
    complaint = workshop.complaint(schedule='thrust = { csv = "t.csv", zero_below = 0 }\nshape = "hermite"')
    assert complaint == "scenario.toml: schedule.shape: thrust samples have their own shape: remove it"
