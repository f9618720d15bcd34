"""Numbers at their ends: a command answers or refuses in one line, it never breaks or goes on for ever."""

from pathlib import Path

import pytest
from intermit.cli.app import run
from intermit.models.simulation import right_hand_side
from intermit.scenario import load_scenario
from intermit.study.simulated_run import run_law

SCENARIO = """
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]
[schedule]
period = 8
on = 0.01
on_time = 3.2
[initial]
axis = [1, 1, 1]
angle_deg = {angle}
rate = [{rate}, 0, 0]
[[law]]
type = "persistence-filter"
lambda = 0.525
R0 = 1
[simulation]
horizon = {horizon}
"""


def written(folder: Path, *, angle: str = "120", rate: str = "0", horizon: str = "56") -> str:
    path = folder / "extreme.toml"
    path.write_text(SCENARIO.format(angle=angle, rate=rate, horizon=horizon))
    return str(path)


@pytest.mark.parametrize("rate", ["1e21", "1e12", "-1e5"])
def test_a_spin_beyond_following_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], rate: str
) -> None:
    assert run(["check", "--no-search", written(tmp_path, rate=rate)]) == 2
    message = capsys.readouterr().err
    assert "initial.rate" in message
    assert "turns" in message
    assert message.count("\n") == 1


def test_the_turns_count_not_the_rate(tmp_path: Path) -> None:
    """The partner: the same spin for a thousandth of the time is followed."""
    path = written(tmp_path, rate="2300", horizon="0.05")
    assert run(["check", "--no-search", "--no-margins", path]) in {0, 1, 3}
    assert run(["check", written(tmp_path, rate="2300", horizon="56")]) == 2


@pytest.mark.parametrize("angle", ["0", "1e-12"])
def test_a_start_at_the_target_leaves_nothing_to_compare(tmp_path: Path, angle: str) -> None:
    assert run(["compare", written(tmp_path, angle=angle)]) in {0, 3}


@pytest.mark.parametrize("table", ["optimum]\nattitude_tolerance", "tolerance]\nattitude"])
def test_a_tolerance_that_no_attitude_exceeds_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], table: str
) -> None:
    path = Path(written(tmp_path))
    path.write_text(path.read_text() + f"[{table} = 1e12\n")
    assert run(["optimum", str(path)]) == 2
    assert "must be < 1" in capsys.readouterr().err


def test_a_run_far_quicker_than_its_horizon_ends(tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(right_hand_side, "MAX_EVALUATIONS", 20_000)
    path = Path(written(tmp_path))
    scenario = load_scenario(path)
    assert run_law(scenario, scenario.laws[0].build()).failure == ""
    monkeypatch.setattr(right_hand_side, "MAX_EVALUATIONS", 200)
    assert "after 200 right-hand sides" in run_law(scenario, scenario.laws[0].build()).failure


def test_more_starts_than_can_be_searched_are_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    path = Path(written(tmp_path))
    path.write_text(path.read_text() + "[optimum]\nstarts = 1000000000000\n")
    assert run(["optimum", str(path)]) == 2
    assert "optimum.starts" in capsys.readouterr().err
