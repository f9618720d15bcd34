"""`intermit optimum` prints checked least peaks, writes a valid record, and says why where it cannot."""

from __future__ import annotations

import json
from pathlib import Path

import numpy as np
import pytest
from intermit.cli.app import run
from intermit.reports.record import read_record
from intermit.scenario import load_scenario
from intermit.study.optimum.record import optimum_record
from intermit.study.optimum.run import OptimumOptions, run_optimum

SCENARIO = """
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]
[schedule]
period = 8
on = 0.01
on_time = 3.2
[initial]
axis = [1, 1, 1]
angle_deg = 60
rate = {rate}
[optimum]
final_time = {final_time}
{more}
"""


def scenario(folder: Path, *, final_time: float = 11.21, rate: str = "[0, 0, 0]", more: str = "") -> Path:
    path = folder / "case.toml"
    path.write_text(SCENARIO.format(final_time=final_time, rate=rate, more=more))
    return path


def test_both_norms_are_solved_and_written(tmp_path, capsys):
    record = tmp_path / "found.json"
    path = scenario(tmp_path, more="starts = 1")
    assert run(["optimum", str(path), "--no-bound", "--json", str(record)]) == 0
    said = capsys.readouterr().out
    assert said.count("CHECKED") == 2
    written = read_record(record)
    entries = written.document["sections"]["optimum"]
    assert [e["norm"] for e in entries] == ["component", "euclidean"]
    for entry in entries:
        torque = written.array(entry["arrays"]["torque"])
        size = np.abs(torque).max() if entry["norm"] == "component" else np.linalg.norm(torque, axis=1).max()
        assert entry["value"]["low"] <= size * (1 + 1e-9)
        assert size == pytest.approx(entry["value"]["high"], rel=1e-5)
        end = written.array(entry["arrays"]["quaternion"])[-1]
        assert np.linalg.norm(end[1:]) < 1e-7


def test_same_scenario_same_record(tmp_path):
    loaded = load_scenario(scenario(tmp_path, more="starts = 2"))
    options = OptimumOptions(norms=("component",), bound=False)
    first, second = (optimum_record(run_optimum(loaded, options)).to_json() for _ in range(2))
    assert first == second
    assert json.loads(first)["provenance"]["seeds"] == {"starts": 1}


def test_bound_below_optimum_and_an_inversion_stops_the_run(tmp_path, capsys, monkeypatch):
    from dataclasses import replace

    import intermit.optim.bounds as bounds

    path = scenario(tmp_path, more="starts = 1\nnorm = 'euclidean'")
    study = run_optimum(load_scenario(path), OptimumOptions(norms=("euclidean",)))
    optimum = study.optima[0]
    assert optimum.bound.value <= optimum.answer.peak
    assert 0 < optimum.gap < 0.015
    honest = bounds.certified_lower_bound

    def inflated(problem):
        found = honest(problem)
        return replace(found, best=replace(found.best, exact=found.best.exact * 2))

    monkeypatch.setattr(bounds, "certified_lower_bound", inflated)
    assert run(["optimum", str(path), "--norm", "euclidean"]) == 70
    assert "lies below its certified bound" in capsys.readouterr().err


def test_no_window_before_the_final_time_is_impossible(tmp_path, capsys):
    assert run(["optimum", str(scenario(tmp_path, final_time=0.005))]) == 1
    assert "no thruster window opens before tf = 0.005 s" in capsys.readouterr().out


def test_momentum_that_the_windows_cannot_absorb_is_explained(tmp_path, capsys):
    path = scenario(tmp_path, final_time=3.3, rate="[2, 0, 0]", more="torque_limit = 0.5\nstarts = 1")
    assert run(["optimum", str(path), "--norm", "component", "--no-bound"]) == 1
    said = capsys.readouterr().out
    assert "cannot absorb the start's" in said
    assert "limit 0.5 N m" in said


def test_least_time_within_the_limit(tmp_path, capsys):
    path = scenario(tmp_path, more="torque_limit = 0.2\nstarts = 1")
    assert run(["optimum", str(path), "--norm", "component", "--no-bound", "--least-time"]) == 0
    said = capsys.readouterr().out
    assert "limit 0.2 N m is enough" in said
    assert "least time within 0.2 N m: " in said


def test_least_impulse_within_the_limit(tmp_path, capsys):
    record = tmp_path / "found.json"
    path = scenario(tmp_path, more="torque_limit = 0.2\nstarts = 1")
    command = ["optimum", str(path), "--norm", "component", "--no-bound", "--least-impulse"]
    assert run([*command, "--json", str(record)]) == 0
    said = capsys.readouterr().out
    assert "least impulse within 0.2 N m: " in said
    assert "N m s (CHECKED; " in said
    notes = read_record(record).document["sections"]["optimum"][0]["notes"]
    assert any(note.startswith("Least impulse within 0.2 N m: ") for note in notes)


@pytest.mark.parametrize("question", ["--least-time", "--least-impulse"])
def test_a_question_within_a_limit_needs_a_limit(tmp_path, capsys, question):
    assert run(["optimum", str(scenario(tmp_path)), "--no-bound", question]) == 2
    assert "optimum.torque_limit" in capsys.readouterr().err


def test_limit_not_met_is_told_from_peak_not_found(tmp_path, capsys):
    path = scenario(tmp_path, more="torque_limit = 0.06\nstarts = 1")
    assert run(["optimum", str(path), "--norm", "component", "--no-bound"]) == 3
    said = capsys.readouterr().out
    assert "1 found and checked but above its limit." in said
    assert "the least found needs 0.0" in said
    path = scenario(tmp_path, more="torque_limit = 0.001\nstarts = 1")
    assert run(["optimum", str(path), "--no-bound"]) == 1
    assert "1 impossible within its limit; 1 found and checked." in capsys.readouterr().out
    one_way = scenario(tmp_path, more="thrusters = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]\nstarts = 1")
    assert run(["optimum", str(one_way), "--no-bound"]) == 3
    assert "1 left open." in capsys.readouterr().out


def test_thrusters_give_a_force(tmp_path, capsys):
    axes = "thrusters = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]\nstarts = 1"
    assert run(["optimum", str(scenario(tmp_path, more=axes)), "--no-bound"]) == 0
    assert "4 one-sided thrusters" in capsys.readouterr().out


def test_a_norm_that_does_not_exist_is_refused(tmp_path, capsys):
    assert run(["optimum", str(scenario(tmp_path)), "--norm", "taxicab"]) == 2
    assert "expected component, euclidean or thrusters" in capsys.readouterr().err
    assert run(["optimum", str(scenario(tmp_path)), "--norm", "thrusters"]) == 2
