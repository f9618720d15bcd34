"""`certify` and `optimum --certificate` write lower bounds that the lone checker accepts."""

import json
import subprocess
import sys
from dataclasses import replace
from fractions import Fraction
from pathlib import Path

import pytest
from intermit.cli.app import run
from intermit.optim.bounds import certified_lower_bound
from intermit.scenario import load_scenario
from intermit.study.optimum.lower_bounds import below, bound_claim, own_bound
from intermit.study.optimum.run import norm_of, transfer
from intermit.verify import checker
from intermit.verify.verdict import Verdict

SPHERE = """
[spacecraft]
inertia = [[2, 0, 0], [0, 2, 0], [0, 0, 2]]
{tolerance}
[schedule]
period = 8
on = 0.01
on_time = 3.2
shape = "hermite"

[initial]
axis = [1, 1, 1]
angle_deg = {angle}
rate = {rate}

[[law]]
type = "persistence-filter"
lambda = 0.6
R0 = 1
{optimum}
"""
OPTIMUM = '[optimum]\nfinal_time = 27.22\nnorm = "euclidean"'


def scenario(folder, name="s", *, angle=120, rate="[0, 0, 0]", tolerance="", optimum=OPTIMUM):
    path = folder / f"{name}.toml"
    path.write_text(SPHERE.format(angle=angle, rate=rate, tolerance=tolerance, optimum=optimum))
    return path


def kinds(file):
    parts = json.loads(file.read_text())["parts"]
    return [certificate["kind"] for part in parts for certificate in part["certificates"]]


@pytest.fixture(scope="module")
def certified(tmp_path_factory):
    folder = tmp_path_factory.mktemp("bounds")
    toml, file = scenario(folder), folder / "s.json"
    assert run(["certify", str(toml), "--bound", "-o", str(file)]) == 0
    return toml, file


def test_the_file_holds_the_bound_and_stands_alone(certified, capsys):
    toml, file = certified
    assert kinds(file).count("peak-lower-bound") == 1
    assert run(["recheck", str(file), "--scenario", str(toml)]) == 0
    words = capsys.readouterr().out
    assert "VALID  peak-lower-bound" in words
    assert "EQUAL" in words
    command = [sys.executable, "-I", "-S", str(Path(checker.__file__).parent), str(file)]
    assert subprocess.run(command, capture_output=True, check=False).returncode == 0


@pytest.mark.parametrize(
    "change",
    [
        {"angle": 119},
        {"rate": "[0, 0.001, 0]"},
        {"optimum": OPTIMUM.replace("27.22", "27.23")},
        {"optimum": OPTIMUM + "\nrate_tolerance = 0.001"},
        {"optimum": OPTIMUM + '\nprofile = "gain"'},
    ],
)
def test_another_transfer_is_told_apart(certified, tmp_path, capsys, change):
    assert run(["recheck", str(certified[1]), "--scenario", str(scenario(tmp_path, **change))]) == 1
    assert "transfer" in capsys.readouterr().out


def test_without_an_optimum_or_by_wish_there_is_none(tmp_path, capsys):
    for options, optimum in ((["--bound"], ""), ([], OPTIMUM)):
        file = tmp_path / "n.json"
        assert run(["certify", str(scenario(tmp_path, optimum=optimum)), "-o", str(file), *options]) == 0
        assert "peak-lower-bound" not in kinds(file)
    capsys.readouterr()


def test_a_bound_speaks_of_the_inertia_as_stated(tmp_path, capsys):
    toml, file = scenario(tmp_path, tolerance="inertia_tolerance = 0.01"), tmp_path / "t.json"
    assert run(["certify", str(toml), "--bound", "-o", str(file)]) == 0
    capsys.readouterr()
    assert run(["recheck", str(file), "--scenario", str(toml)]) == 0
    said = capsys.readouterr().out
    assert "EQUAL" in said
    assert (
        "the bound of the peak is of the nominal body alone: spacecraft.inertia_tolerance is not covered"
        in said
    )
    assert run(["recheck", str(file), "--scenario", str(scenario(tmp_path, "exact"))]) == 1
    assert "NOMINAL" not in capsys.readouterr().out


def test_optimum_writes_each_norm_and_how_to_recheck_it(tmp_path, capsys):
    toml, file, record = scenario(tmp_path), tmp_path / "o.json", tmp_path / "r.json"
    command = ["optimum", str(toml), "--starts", "1", "--norm", "euclidean", "--json", str(record)]
    assert run([*command, "--certificate", str(file)]) == 0
    assert kinds(file) == ["peak-lower-bound"]
    assert run(["recheck", str(file), "--scenario", str(toml)]) == 0
    entry = json.loads(record.read_text())["sections"]["optimum"][0]
    assert any("intermit recheck" in note for note in entry["notes"])
    peak = json.loads(file.read_text())["parts"][0]["certificates"][0]["claim"]["peak"]
    assert float(Fraction(peak)) == entry["bound"]["low"]
    capsys.readouterr()


def test_where_the_momentum_may_do_it_nothing_is_claimed(tmp_path):
    loose = OPTIMUM + "\nrate_tolerance = 10"
    claim = own_bound(load_scenario(scenario(tmp_path, rate="[3, 3, 3]", optimum=loose))).claim
    assert claim.verdict is Verdict.UNDECIDED
    assert not claim.evidence


def test_a_smaller_bound_takes_the_place_of_one_without_a_file(tmp_path):
    loaded = load_scenario(scenario(tmp_path))
    problem = transfer(loaded, norm_of(loaded, "euclidean"))
    bound = certified_lower_bound(problem)
    invented = replace(bound.best, name="invention", exact=bound.best.exact * Fraction(11, 10))
    path = invented.argument.path
    untrue = replace(invented.argument, path=replace(path, travel=path.travel * Fraction(11, 10)))
    invented = replace(invented, argument=untrue)
    claim = bound_claim(problem, replace(bound, best=invented, all=(invented, *bound.all)))
    assert claim.verdict is Verdict.PROVED
    assert "the larger bound by invention has no certificate" in claim.title
    assert claim.quantities[0].low == bound.value


def test_digits_are_rounded_down():
    for value in (0.011045353421746725, 1.0, 123456789.123, 9.9999999e-7, 0.5, 1 / 3):
        assert value * (1 - 1e-6) <= float(below(value)) <= value
