"""compare, tune, sweep and paper: a table on stdout, a valid record in the file, one-line errors."""

import json
from pathlib import Path

import pytest
from intermit.cli.app import run

EXAMPLES = Path(__file__).parents[2] / "examples"

SMALL = f"""
extends = "{EXAMPLES / "paper.toml"}"
[[law]]
type = "persistence-filter"
label = "filter"
[compare]
norms = ["euclidean"]
[tune]
evaluations = 60
settle = 28
[study]
periods = [8]
duty_cycles = [0.4]
"""


@pytest.fixture
def scenario(tmp_path):
    path = tmp_path / "small.toml"
    path.write_text(SMALL)
    return path


def record(path):
    document = json.loads(path.read_text())
    assert document["format"] == "intermit-record"
    return document["sections"]


@pytest.mark.slow
def test_compare_orders_every_row_and_takes_a_law_of_ones_own(scenario, tmp_path, capsys):
    out = tmp_path / "compare.json"
    own = f"{EXAMPLES / 'momentum_pd.py'}:MomentumPD,stiffness=0.08,damping=0.4"
    assert run(["compare", str(scenario), "--law", own, "--json", str(out)]) == 0
    assert "certified bound" in capsys.readouterr().out
    tables = {t["key"]: t for t in record(out)["comparison"]["tables"]}
    assert [row["law"] for row in tables["laws"]["rows"]] == ["filter", "MomentumPD"]
    for row in tables["terms_euclidean"]["rows"]:
        assert row["bound"]["low"] <= row["optimum"]["high"] <= row["peak"]["high"]
        assert row["bound"]["rigorous"]
        assert not row["optimum"]["rigorous"]


SHORT = "\n[simulation]\nhorizon = 10\n"


def test_a_law_that_does_not_settle_is_not_called_compared(scenario, tmp_path, capsys):
    """Partner: the same law over the paper's horizon is compared, exit code 0, above."""
    out = tmp_path / "compare.json"
    scenario.write_text(SMALL + SHORT)
    assert run(["compare", str(scenario), "--json", str(out)]) == 3
    said = " ".join(capsys.readouterr().out.split())
    assert "filter does not settle by 10 s: |bv| = 0.0498" in said
    assert "--at-horizon" in said
    assert "was checked" not in said
    assert [t["key"] for t in record(out)["comparison"]["tables"]] == ["laws"]


@pytest.mark.slow
def test_a_law_that_does_not_settle_is_compared_as_near(scenario, tmp_path, capsys):
    out = tmp_path / "compare.json"
    scenario.write_text(SMALL + SHORT)
    assert run(["compare", str(scenario), "--at-horizon", "--json", str(out)]) == 0
    assert "compared with coming as near" in " ".join(capsys.readouterr().out.split())
    (row,) = record(out)["comparison"]["tables"][1]["rows"]
    assert 0 < row["bound"]["low"] <= row["optimum"]["high"] <= row["peak"]["high"]


@pytest.mark.slow
def test_the_profile_of_the_comparison_is_heeded(scenario, tmp_path, capsys):
    """Through w = g the command's peak is compared; it exceeds that of the torque g u."""
    peaks = []
    for profile in ("window", "gain"):
        out = tmp_path / f"{profile}.json"
        norms = 'norms = ["euclidean"]'
        scenario.write_text(SMALL.replace(norms, f'{norms}\nprofile = "{profile}"'))
        assert run(["compare", str(scenario), "--json", str(out)]) == 0
        (row,) = record(out)["comparison"]["tables"][1]["rows"]
        assert row["bound"]["low"] <= row["optimum"]["high"] <= row["peak"]["high"]
        peaks.append(row["peak"]["low"])
    assert "Peak command u" in " ".join(capsys.readouterr().out.split())
    assert peaks[1] > peaks[0]


def test_a_start_from_which_no_torque_is_needed_has_no_ratio(scenario, tmp_path):
    out = tmp_path / "compare.json"
    scenario.write_text(SMALL + "[initial]\naxis = [1, 1, 1]\nangle_deg = 1\n")
    assert run(["compare", str(scenario), "--json", str(out)]) == 0
    (row,) = record(out)["comparison"]["tables"][1]["rows"]
    assert row["optimum"]["high"] == 0
    assert row.get("ratio") is None


@pytest.mark.slow
def test_tune_reports_parameters_and_history(scenario, tmp_path):
    out = tmp_path / "tune.json"
    assert run(["tune", str(scenario), "--json", str(out)]) == 0
    tables = {t["key"]: t for t in record(out)["tuning"]["tables"]}
    assert [row["name"] for row in tables["parameters"]["rows"]] == ["lambda", "R0"]
    again = tmp_path / "again.json"
    assert run(["tune", str(scenario), "--json", str(again)]) == 0
    assert out.read_bytes() == again.read_bytes()


@pytest.mark.slow
def test_front_has_a_certified_band_below_every_law(scenario, tmp_path, capsys):
    out = tmp_path / "front.json"
    words = ["--front", "--settle", "28,36", "--peak-norm", "euclidean", "--json", str(out)]
    assert run(["tune", str(scenario), *words]) == 0
    capsys.readouterr()
    rows = record(out)["front"]["tables"][0]["rows"]
    assert len(rows) == 2
    for row in rows:
        assert row["bound"]["low"] <= row["optimum"]["high"] <= row["law1"]["high"]
    assert rows[1]["optimum"]["high"] < rows[0]["optimum"]["low"]


@pytest.mark.slow
def test_a_law_without_certificate_is_tuned_and_said_so(tmp_path, capsys):
    path = tmp_path / "pd.toml"
    pd = 'type = "quaternion-pd"\nlabel = "PD"\nproportional = 0.5\nderivative = 1.6'
    path.write_text(SMALL.replace('type = "persistence-filter"\nlabel = "filter"', pd))
    assert run(["tune", str(path), "--settle", "40"]) == 0
    assert "nothing is proved of it" in " ".join(capsys.readouterr().out.split())


@pytest.mark.slow
def test_sweep_reports_each_case(scenario, tmp_path):
    out = tmp_path / "sweep.json"
    assert run(["sweep", str(scenario), "--peak-norm", "euclidean", "--json", str(out)]) == 0
    rows = record(out)["schedule_study"]["tables"][0]["rows"]
    assert len(rows) == 1
    assert rows[0]["floor"]["rigorous"]


def test_a_sweep_over_too_many_windows_is_refused(scenario, capsys):
    scenario.write_text(SMALL + "[optimum]\nfinal_time = 1e12\n")
    assert run(["sweep", str(scenario)]) == 2
    assert "125000000000 windows open before 1e+12 s" in capsys.readouterr().err


def test_paper_reports_its_statements(tmp_path):
    out = tmp_path / "paper.json"
    assert run(["paper", "--no-survey", "--json", str(out)]) == 0
    section = record(out)["paper_claims"]
    assert len(section["tables"][0]["rows"]) == 5
    assert {f["key"] for f in section["figures"]} >= {"gain", "body1_torque", "body2_torque", "states_R"}


@pytest.mark.parametrize(
    ("words", "says"),
    [
        (["tune", "--settle", "soon"], "--settle"),
        (["tune", "--settle", "-1"], "> 0 s"),
        (["tune", "--settle", "20", "--peak-norm", "sum"], "--peak-norm"),
        (["tune", "--settle", "20,28"], "one time"),
        (["tune", "--front"], "--front needs"),
        (["tune", "--settle", "1e12"], "tune.settle: 1e+12 s lie beyond the run, which ends at 56 s"),
        (["tune", "--front", "--settle", "20,57"], "tune.settle: 57 s lie beyond the run"),
    ],
)
def test_bad_words_are_one_line(scenario, words, says, capsys):
    if words == ["tune", "--front"]:
        words = ["tune", "--front", "--settle", ""]
    assert run([words[0], str(scenario), *words[1:]]) == 2
    error = capsys.readouterr().err.strip()
    assert says in error
    assert "\n" not in error
