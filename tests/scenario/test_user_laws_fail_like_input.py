"""Whatever a user's law does wrong is bad input: one line with file, class and line, exit code 2."""

import json
import signal

import pytest
from intermit.cli.app import run

SCENARIO = """
[spacecraft]
inertia = [[3, 0, 0], [0, 2.5, 0], [0, 0, 2]]
[schedule]
period = 8
on_time = 4
[initial]
axis = [1, 1, 1]
angle_deg = 60
[[law]]
type = "user"
file = "own.py"
class = "Own"
parameters = { kp = 0.1, kd = 0.3 }
[simulation]
horizon = 16
[check]
samples = 512
"""
HEAD = """
from dataclasses import dataclass
from fractions import Fraction
from typing import ClassVar
import sys
import casadi as ca
import numpy as np
from intermit.models.laws import Control, Law
{before}

@dataclass(frozen=True)
class Own(Law):
    name: ClassVar[str] = "own"
    kp: Fraction
    kd: Fraction

    {extra}

    def control(self, plant, time, states, p):
        {body}
"""
GOOD = 'return Control(-p["kp"] * plant.bv - p["kd"] * plant.w)'


@pytest.fixture
def attempt(tmp_path, capfd):
    def try_it(body=GOOD, before="", extra="pass", command=("check",)):
        (tmp_path / "own.py").write_text(HEAD.format(body=body, before=before, extra=extra))
        scenario = tmp_path / "own.toml"
        scenario.write_text(SCENARIO)
        code = run([command[0], str(scenario), *command[1:]])
        return code, capfd.readouterr()

    return try_it


WRONG = {
    "exit 0": ("sys.exit(0)", "asked the program to end"),
    "exit text": ("sys.exit('bye')", "asked the program to end"),
    "raises": ("raise KeyError('kp')", "KeyError"),
    "generator": ("raise GeneratorExit", "GeneratorExit"),
    "python if": ("return Control(plant.bv if plant.b0 > 0 else -plant.bv)", "casadi.if_else"),
    "python min": ("return Control(min(plant.b0, 1) * plant.bv)", "casadi.if_else"),
    "list": ("return Control([-plant.bv[i] for i in range(3)])", "casadi.vertcat"),
    "numpy": ("return Control(np.sin(plant.bv))", "casadi.sin"),
    "none": ("return None", "must return a Control"),
    "scalar": ("return Control(plant.b0)", "shape (3,)"),
    "0/0": ("return Control(-plant.bv / ca.norm_2(plant.bv))", "at the target attitude"),
    "recursion": ("return self.control(plant, time, states, p)", "without end"),
    "own interrupt": ("raise KeyboardInterrupt", "line 20: Own.control: KeyboardInterrupt"),
    "math": ("import math; return Control(-math.sin(plant.b0) * plant.bv)", "use casadi.sin"),
    "float": ("return Control(-float(plant.b0) * plant.bv)", "turn a symbol into nan"),
    "int": ("return Control(-int(plant.b0) * plant.bv)", "casadi.floor"),
    "stray symbol": ("return Control(plant.bv * ca.SX.sym('z'))", "uses the symbol z"),
}


@pytest.mark.parametrize("case", WRONG)
def test_a_wrong_law_is_bad_input_in_one_line(attempt, case):
    body, words = WRONG[case]
    code, said = attempt(body)
    assert code == 2
    assert said.out == ""
    (line,) = said.err.splitlines()
    assert "own.py" in line
    assert "Own" in line
    assert words in line


@pytest.mark.parametrize("case", ["list", "none", "scalar", "stray symbol"])
def test_what_control_returns_is_named_with_its_line(attempt, case):
    assert "own.py line 19: Own" in attempt(WRONG[case][0])[1].err


@pytest.mark.parametrize(
    "command",
    [["certify", "-o", "never.json"], ["compare"], ["tune", "--settle", "10"], ["check", "--json", "-"]],
)
def test_every_command_says_it_alike(attempt, command):
    code, said = attempt("sys.exit(0)", command=command)
    assert code == 2
    assert "own.py line 20: Own.control" in said.err


def test_a_file_that_ends_the_program_is_bad_input(attempt):
    code, said = attempt(before="sys.exit(0)")
    assert code == 2
    assert "own.py line 9" in said.err


@pytest.mark.parametrize("member", ["controller_states", "signals", "parameters"])
def test_a_property_that_raises_is_named(attempt, member):
    code, said = attempt(extra=f"@property\n    def {member}(self):\n        raise ValueError('no')")
    assert code == 2
    assert f"Own.{member}" in said.err
    assert "line" in said.err


EXTRAS = {
    "name": ("name = 5", "Own.name must be a text, received 5"),
    "list as V": ("def storage(self, *_):\n        return [1]", "or None; received list"),
    "states": (
        "def controller_states(self):\n        return ()",
        "17: Own.controller_states is a method",
    ),
    "signals": ("def signals(self):\n        return ()", "line 17: Own.signals is a method"),
    "parameters": ("def parameters(self):\n        return {}", "write @property above it"),
}


@pytest.mark.parametrize("case", EXTRAS)
def test_a_wrong_member_is_bad_input_in_one_line(attempt, case):
    extra, words = EXTRAS[case]
    code, said = attempt(extra=extra)
    assert code == 2
    assert words in said.err
    assert said.err.count("\n") == 1


def test_a_press_of_ctrl_c_within_a_law_is_an_interrupt(attempt):
    """The partner of the law that raises one itself: here the signal arrives while it runs."""
    # a shell may start its background jobs with interrupts ignored
    before = signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        code, said = attempt("import os, signal; os.kill(os.getpid(), signal.SIGINT); " + GOOD)
    finally:
        signal.signal(signal.SIGINT, before)
    assert code == 130
    assert "interrupted" in said.err


def test_a_law_without_a_number_at_its_start_is_named(attempt):
    """1 at the target, no number beyond 51 deg: the run starts at 60 deg."""
    root = 'return Control(-ca.sqrt(plant.b0 - 0.9) * plant.bv - p["kd"] * plant.w)'
    code, said = attempt(root, command=("check", "--no-search", "--no-margins"))
    assert code == 3
    text = " ".join(said.out.split())
    assert "the law is not a number there" in text
    assert "quaternion (0.866025, 0.288675, 0.288675, 0.288675)" in text


def test_an_error_that_comes_late_is_still_bad_input(attempt):
    """The storage function is asked for after loading and running: the guard stands in the class."""
    code, said = attempt(extra="def storage(self, *_):\n        sys.exit(0)")
    assert code == 2
    assert "Own.storage" in said.err


def test_a_good_law_runs_and_its_prints_stay_out_of_the_record(attempt, tmp_path, capfd):
    (tmp_path / "own.py").write_text(HEAD.format(body=f"print('hello'); {GOOD}", before="", extra="pass"))
    (tmp_path / "own.toml").write_text(SCENARIO)
    out = tmp_path / "record.json"
    code = run(["check", str(tmp_path / "own.toml"), "--json", str(out)])
    said = capfd.readouterr()
    assert code in (0, 1, 3)
    assert "hello" not in said.out
    assert "hello" in said.err
    json.loads(out.read_text())
