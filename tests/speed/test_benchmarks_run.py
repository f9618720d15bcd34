"""The benchmarks run, name who is missing, and their competitors compute the same thing."""

import subprocess
import sys
from pathlib import Path

import pytest

BENCHMARKS = Path(__file__).resolve().parents[2] / "benchmarks"
pytestmark = pytest.mark.skipif(not BENCHMARKS.exists(), reason="benchmarks are not beside the tests")


def run(*arguments):
    done = subprocess.run(
        [sys.executable, *arguments], capture_output=True, text=True, check=True, cwd=BENCHMARKS
    )
    return done.stdout


def test_a_missing_competitor_is_named_and_the_others_race():
    code = """
from common import Contender, Missing, need, race
def absent(): need("a_package_that_nobody_has")
times, missing = race([Contender("here", lambda: lambda: 7), Contender("away", absent)], 3)
print([t.name for t in times], times[0].answer, len(times[0].rounds), missing)
"""
    out = run("-c", code)
    assert out.strip() == "['here'] 7 3 ['away: skipped, a_package_that_nobody_has is not installed']"


@pytest.mark.slow
def test_the_sample_race_is_bit_identical():
    lines = {
        line.split("|")[1].strip(): line
        for line in run("samples.py", "8192", "1").splitlines()
        if "|" in line
    }
    assert "bit-identical" in lines["intermit, default"]
    assert "bit-identical" not in lines["numpy by hand, whole arrays"]  # typed apart, so it can differ


@pytest.mark.slow
def test_the_trajectory_race_keeps_everyone_accurate():
    rows = [
        line.split("|") for line in run("trajectories.py", "8", "1").splitlines() if line.startswith("| ")
    ]
    errors = {row[1].strip(): float(row[4]) for row in rows[1:]}
    assert len(errors) >= 6
    assert max(errors.values()) <= 1e-8
