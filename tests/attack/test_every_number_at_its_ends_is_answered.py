"""Every number of a scenario at its ends, for every question: an answer or one line, never a break or a hang.

The whole takes hours (`soak`); the first of each kind is part of every run.
"""

import subprocess
import sys
from pathlib import Path

import pytest

NUMBERS = {
    "spacecraft.inertia": "[[3, 0, 0], [0, 2.5, 0], [0, 0, 2]]",
    "schedule.period": "8",
    "schedule.on": "0.01",
    "schedule.on_time": "3.2",
    "schedule.thruster_rise": "0.01",
    "initial.axis": "[1, 1, 1]",
    "initial.angle_deg": "120",
    "initial.rate": "[0, 0, 0]",
    "simulation.horizon": "56",
    "simulation.output_step": "0.1",
    "tolerance.attitude": "0.01",
    "tolerance.rate": "0.01",
    "limits.torque": "0.1",
    "check.samples": "256",
    "check.pe_window": "9",
    "optimum.final_time": "27.22",
    "optimum.starts": "1",
    "optimum.attitude_tolerance": "0",
    "tune.settle": "40",
    "tune.evaluations": "20",
    "study.periods": "[8]",
    "study.duty_cycles": "[0.4]",
    "law.lambda": "0.525",
    "law.R0": "1",
}
ENDS = ("0", "-1", "1e-300", "1e-12", "1e12", "1e300", "1000000000000000000000", "[]")
COMMANDS = ("check", "optimum", "compare", "tune", "sweep")
FREE = {(f"initial.{name}", "-1") for name in ("axis", "angle_deg", "rate")}
FREE |= {("study.periods", "[]"), ("study.duty_cycles", "[]")}
"""Ends that mean something: a start may be negative, and an empty list stands for the default."""
QUICK = [(key, end) for key in NUMBERS for end in ("-1", "1e300", "[]") if (key, end) not in FREE]


def scenario_text(changed: str, value: str) -> str:
    old = NUMBERS[changed]
    inner = old if value == "[]" else old.replace("3,", f"{value},") if old.startswith("[[") else value
    if old.startswith("[") and not old.startswith("[[") and value != "[]":
        inner = f"[{', '.join([value] * (old.count(',') + 1))}]"
    if value == "[]":
        inner = "[]"
    tables: dict[str, list[str]] = {}
    for key, number in (NUMBERS | {changed: inner}).items():
        table, name = key.split(".")
        tables.setdefault(table, []).append(f"{name} = {number}")
    heads = {"law": '[[law]]\ntype = "persistence-filter"'}
    return "\n".join("\n".join([heads.get(t, f"[{t}]"), *lines]) for t, lines in tables.items())


@pytest.mark.parametrize(("key", "end"), QUICK)
def test_a_number_that_cannot_be_is_refused_in_one_line(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], key: str, end: str
) -> None:
    from intermit.cli.app import run

    path = tmp_path / "scenario.toml"
    path.write_text(scenario_text(key, end))
    assert run(["check", str(path)]) == 2
    assert capsys.readouterr().err.count("\n") == 1


@pytest.mark.soak
@pytest.mark.parametrize("command", COMMANDS)
@pytest.mark.parametrize("key", NUMBERS)
@pytest.mark.parametrize("end", ENDS)
def test_every_end_is_answered(tmp_path: Path, command: str, key: str, end: str) -> None:
    path = tmp_path / "scenario.toml"
    path.write_text(scenario_text(key, end))
    done = subprocess.run(
        [sys.executable, "-m", "intermit", command, str(path)],
        cwd=tmp_path, capture_output=True, text=True, timeout=120, check=False,
    )  # fmt: skip
    assert done.returncode in {0, 1, 2, 3}, done.stderr
    assert "Traceback" not in done.stderr
    assert "Warning:" not in done.stderr
