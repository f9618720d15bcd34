"""An interrupt ends a study at once and brings what was found: printed by the command line, exit code 130."""

from fractions import Fraction as F
from pathlib import Path

import numpy as np
import pytest
from intermit.cli.app import run
from intermit.cli.console import progress_line
from intermit.models.types import Interrupted
from intermit.optim.tuning.search import DifferentialEvolution, Outcomes
from intermit.optim.tuning.space import SearchSpace
from intermit.scenario import load_scenario
from intermit.study.check import run as check
from intermit.study.compare import run as compare
from intermit.study.optimum import run as optimum
from intermit.study.options import CheckOptions
from problems import PERSISTENCE

SCENARIO = """
[spacecraft]
inertia = [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
[schedule]
windows = [[0, 10]]
[initial]
axis = [0, 0, 1]
angle_deg = 30
[[law]]
type = "quaternion-pd"
label = "first"
proportional = 1
derivative = 2.5
[[law]]
type = "quaternion-pd"
label = "second"
proportional = 2
derivative = 2.5
[check]
samples = 256
[optimum]
starts = 1
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    file = tmp_path / "s.toml"
    file.write_text(SCENARIO)
    return file


def once(function):
    """The function, interrupted when it is called again."""
    calls = []

    def called(*arguments, **options):
        calls.append(arguments)
        if len(calls) > 1:
            raise KeyboardInterrupt
        return function(*arguments, **options)

    return called


def test_a_check_keeps_its_schedule_and_the_laws_that_are_done(path, monkeypatch):
    monkeypatch.setattr(check, "run_law", once(check.run_law))
    with pytest.raises(Interrupted) as stopped:
        check.run_check(load_scenario(path), CheckOptions(search=False))
    assert stopped.value.found.claims
    assert "second" in stopped.value.left_out


@pytest.mark.parametrize(
    ("command", "module", "name", "words"),
    [
        ("optimum", optimum, "_solved", ("largest component", "not finished: Euclidean")),
        ("compare", compare, "_row", ("first", "not finished: second")),
        ("check", check, "run_law", ("windows ordered and disjoint", "not finished: first, second")),
    ],
)
def test_a_command_prints_it_and_ends_with_130(path, monkeypatch, capsys, command, module, name, words):
    monkeypatch.setattr(module, name, once(getattr(module, name)))
    assert run([command, str(path)]) == 130
    said = capsys.readouterr()
    assert all(word in said.out for word in words)
    assert "Interrupted: what follows was found until then" in said.out
    assert said.err.strip().endswith("interrupted")


def test_an_interrupt_before_anything_is_found_says_only_that(path, monkeypatch, capsys):
    def stop(*_arguments):
        raise KeyboardInterrupt

    monkeypatch.setattr(optimum, "_solved", stop)
    assert run(["optimum", str(path)]) == 130
    assert capsys.readouterr().out == ""


def test_a_search_keeps_its_candidates():
    def evaluate(candidates):
        return Outcomes(np.ones(len(candidates)), np.zeros(len(candidates)))

    space = SearchSpace.around(PERSISTENCE, None)
    method = DifferentialEvolution(evaluations=40, population=10, polish=0)
    with pytest.raises(Interrupted) as stopped:
        method.run(space, once(evaluate))
    assert len(stopped.value.found.trials) == 10
    assert "10 of 40" in stopped.value.left_out
    assert all(isinstance(v, F) for _, v in stopped.value.found.trials[0].parameters)


def test_the_time_left_is_told_only_where_it_is_known():
    assert progress_line("x", 0.25, 10) == "x: 25 % after 10 s, about 30 s left"
    assert progress_line("", 0.0, 10) == "at work: 0 % after 10 s"
