"""`report` of a record refuses the options that only a study of a scenario reads."""

import pytest
from intermit.cli.app import run


@pytest.mark.parametrize(
    "option", [["--author", "X"], ["--date", "2026-01-01"], ["--no-optimum"], ["--compare"], ["--no-audit"]]
)
def test_option_of_a_study_is_refused_beside_a_record(option, tmp_path, capsys):
    code = run(["report", str(tmp_path / "results.json"), "-o", str(tmp_path / "out"), *option])
    assert code == 2
    name = option[0].removeprefix("--").removeprefix("no-")
    assert f"--{name} is read when a scenario is studied" in capsys.readouterr().err


def test_option_of_a_rebuild_is_not_refused(tmp_path, capsys):
    code = run(["report", str(tmp_path / "results.json"), "-o", str(tmp_path / "out"), "--force"])
    assert code == 2
    assert "is read when a scenario is studied" not in capsys.readouterr().err
