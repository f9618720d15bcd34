"""`intermit certify` writes what `intermit recheck` and the lone checker accept, and nothing else passes."""

import json
import subprocess
import sys
from pathlib import Path

import intermit
import pytest
from intermit.cli.app import run
from intermit.verify import checker

EXAMPLES = Path(intermit.__file__).parent / "examples"
PERSISTENCE = """
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]
{tolerance}
[schedule]
period = 8
on = 0.01
on_time = 3.2
shape = "hermite"

[initial]
axis = [1, 1, 1]
angle_deg = 120
rate = [0, 0, 0]

[[law]]
type = "persistence-filter"
lambda = {lam}
R0 = {R0}
"""


def scenario(folder, name, *, lam="0.525", R0="1.0", tolerance=""):
    path = folder / f"{name}.toml"
    path.write_text(PERSISTENCE.format(lam=lam, R0=R0, tolerance=tolerance))
    return path


@pytest.fixture(scope="module")
def certified(tmp_path_factory):
    folder = tmp_path_factory.mktemp("certified")
    toml, file = scenario(folder, "s"), folder / "s.json"
    assert run(["certify", str(toml), "-o", str(file)]) == 0
    return toml, file


def test_what_certify_writes_is_accepted(certified, capsys):
    toml, file = certified
    assert run(["recheck", str(file), "--scenario", str(toml)]) == 0
    words = capsys.readouterr().out
    assert "VALID  lyapunov-derivative" in words
    assert "INVALID" not in words
    assert "EQUAL" in words
    command = [sys.executable, "-I", "-S", str(Path(checker.__file__).parent), str(file)]
    assert subprocess.run(command, capture_output=True, check=False).returncode == 0


@pytest.mark.parametrize(
    ("change", "word"),
    [
        ({"lam": "0.526"}, "parameters.lambda"),
        ({"R0": "2"}, "parameters.R0"),
        ({"tolerance": "inertia_tolerance = 0.01"}, "inertia_tolerance"),
    ],
)
def test_another_scenario_is_told_apart(certified, tmp_path, capsys, change, word):
    _, file = certified
    other = scenario(tmp_path, "other", **change)
    assert run(["recheck", str(file), "--scenario", str(other)]) == 1
    assert word in capsys.readouterr().out


def test_same_law_in_other_words_is_the_same(certified, tmp_path):
    toml, file = certified
    document = json.loads(file.read_text())
    for part in document["parts"]:
        if "law" in part["data"]:
            part["data"]["law"]["program"].append("v999 = const 7")
    changed = tmp_path / "changed.json"
    changed.write_text(json.dumps(document))
    assert run(["recheck", str(changed), "--scenario", str(toml)]) == 0


def test_corrupted_and_missing_files_have_their_codes(certified, tmp_path, capsys):
    _, file = certified
    broken = tmp_path / "broken.json"
    broken.write_text(file.read_text().replace('"rate": "', '"rate": "1'))
    assert run(["recheck", str(broken)]) == 1
    assert run(["recheck", str(tmp_path / "absent.json")]) == 2
    (tmp_path / "latin.json").write_bytes(b"\xff\xfe{")
    assert run(["recheck", str(tmp_path / "latin.json")]) == 2
    capsys.readouterr()


def test_a_law_that_proves_nothing_still_writes_what_is_certain(tmp_path, capsys):
    toml = tmp_path / "pd.toml"
    text = PERSISTENCE.format(lam="0.5", R0="1", tolerance="")
    text = (
        text[: text.index("[[law]]")] + '[[law]]\ntype = "quaternion-pd"\nproportional = 1\nderivative = 1\n'
    )
    toml.write_text(text)
    code = run(["certify", str(toml), "-o", str(tmp_path / "pd.json")])
    assert code in (0, 3)
    assert (tmp_path / "pd.json").exists() == (code == 0)
    capsys.readouterr()


def test_a_tolerance_that_reaches_no_inertia_is_bad_input(tmp_path, capsys):
    toml = scenario(tmp_path, "wide", tolerance="inertia_tolerance = 3")
    assert run(["certify", str(toml), "-o", str(tmp_path / "wide.json")]) == 2
    assert "not positive definite" in capsys.readouterr().err
    assert not (tmp_path / "wide.json").exists()
