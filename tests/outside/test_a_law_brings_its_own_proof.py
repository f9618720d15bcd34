"""A law in a file of its own, with its own comparison system, is proved, certified, rechecked and reported.

No file of the package knows it. A law, a system or a part of the checker that is off by a sign or by 3 %
proves nothing.
"""

import json
import re
import shutil
import subprocess
import sys
from fractions import Fraction as F
from pathlib import Path

import intermit
import missions
import numpy as np
import pytest
from intermit.cli.app import run
from intermit.scenario.laws import LawChoice
from intermit.verify import checker
from intermit.verify.certificates import certificate_text
from intermit.verify.filter.answer import answer
from intermit.verify.verdict import Verdict
from problems import J1, paper_schedule

HERE = Path(__file__).parent
LAW, PART = HERE / "sliding_law.py", HERE / "sliding_part.py"
CHECKER = Path(checker.__file__).parent
SCENARIO = """
name = "A law from outside"
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]
[schedule]
period = 8
on = 0.01
on_time = 3.2
thruster_rise = 0.01
thruster_fall = 0.01
[initial]
axis = [1, 1, 1]
angle_deg = 120
[initial_set]
max_angle_deg = 120
max_weighted_rate = 0.3
[limits]
torque = 10
[[law]]
type = "user"
file = "sliding_law.py"
class = "SlidingLaw"
label = "sliding"
parameters = { kappa = 0.3, delta = 0.4 }
[simulation]
horizon = 40
[check]
samples = 256
"""


@pytest.fixture
def folder(tmp_path):
    """The law's two files and a scenario; nothing else is written anywhere."""
    shutil.copy(LAW, tmp_path)
    shutil.copy(PART, tmp_path)
    (tmp_path / "s.toml").write_text(SCENARIO)
    return tmp_path


def claims_of(folder):
    choice = LawChoice(
        "user", "x", (("kappa", F("0.3")), ("delta", F("0.4"))), folder / LAW.name, "SlidingLaw", "law"
    )
    question = missions.question(
        law=choice.build(),
        body=J1,
        schedule=paper_schedule(),
        max_angle_deg=F(120),
        max_weighted_rate=F("0.3"),
        torque_limit=F(10),
    )
    return answer(question)


def alone(*arguments):
    """The checker with nothing but Python."""
    command = [sys.executable, "-I", "-S", str(CHECKER), *map(str, arguments)]
    return subprocess.run(command, capture_output=True, text=True, check=False)


def test_it_is_proved_certified_and_rechecked(folder, capsys):
    study = intermit.check(folder / "s.toml", simulate=False, margins=False)
    (case,) = study.cases
    verdicts = {claim.key: claim.verdict for claim in case.claims}
    assert verdicts["convergence"] is verdicts["torque.limit"] is Verdict.PROVED
    assert "filter.floor" not in verdicts, "the law has no filter"
    assert not [key for key in verdicts if key.startswith("lambda")]
    file = folder / "c.json"
    assert run(["certify", str(folder / "s.toml"), "-o", str(file)]) == 0
    done = alone("--with", PART, file)
    assert done.returncode == 0, done.stdout + done.stderr
    assert "VALID  comparison  (trusting the part sliding_part.py, sha256 " in done.stdout
    assert "J Omega' = -Omega x J w - delta g^2 J Omega" in done.stdout
    assert "by a part from outside" in done.stdout
    capsys.readouterr()
    assert run(["recheck", str(file), "--with", str(PART), "--scenario", str(folder / "s.toml")]) == 0
    assert "EQUAL" in capsys.readouterr().out
    assert intermit.recheck(file, parts=[PART]).valid


def test_a_part_that_is_not_named_is_not_trusted(folder):
    claims_of(folder)  # has read the part in this process
    file = folder / "c.json"
    assert run(["certify", str(folder / "s.toml"), "-o", str(file)]) == 0
    assert alone(file).returncode == 1
    assert "knows no comparison system 'sliding': name its part with --with" in alone(file).stdout
    assert not intermit.recheck(file).valid
    other = json.loads(file.read_text())
    for part in other["parts"]:
        for certificate in part["certificates"]:
            certificate["witness"].pop("system", None)
    file.write_text(json.dumps(other))
    assert alone(file).returncode == 1
    assert alone("--with", PART, file).returncode == 0, "a system is found by the equations, not by its name"


def test_its_bounds_hold_along_runs(folder):
    found = claims_of(folder)
    assert found.convergence is not None
    assert found.torque is not None
    run_ = intermit.simulate(folder / "s.toml")
    t = np.linspace(0, 40, 4001)
    state, torque = run_.trajectory.state(t), run_.trajectory.signals(t).applied_torque
    assert np.linalg.norm(state[4:7], axis=0).max() <= found.convergence.largest_rate
    assert np.linalg.norm(torque, axis=0).max() <= found.torque.applied
    assert np.linalg.norm(torque, axis=0).max() > 0.1 * found.torque.applied, "the bound says something"


LAW_MUTANTS = {
    "damping 3 % less": ("- delta * g * (J @ Omega)", "- 0.97 * delta * g * (J @ Omega)"),
    "term of the wrong sign": (
        "- 2 * kappa * g * (J @ plant.bv_rate)",
        "+ 2 * kappa * g * (J @ plant.bv_rate)",
    ),
    "no inertia in one term": ("(J @ plant.bv_rate)", "plant.bv_rate"),
}
SYSTEM_MUTANTS = {
    "decays 3 % too fast": ("-n.delta * G * y", "-1.03 * n.delta * G * y"),
    "pulled 3 % too hard": ("- n.kappa * G * s * (2 - S) / 2", "- 1.03 * n.kappa * G * s * (2 - S) / 2"),
    "driven 3 % too little": ("drift - n.kappa", "0.97 * drift - n.kappa"),
    "driven by the wrong sign": ("drift - n.kappa", "-drift - n.kappa"),
    "decays without the gain": ("-n.delta * G * y", "-n.delta * y"),
}
PART_MUTANTS = {
    "decays 3 % too fast": (".times(self.delta)", ".times(self.delta * Fraction(103, 100))"),
    "pulled 3 % too hard": ("self.slope * HALF", "self.slope * HALF * Fraction(103, 100)"),
    "driven 3 % too little": (
        "drift.times(self.setting.c)",
        "drift.times(self.setting.c * Fraction(97, 100))",
    ),
}


def mutate(path, old, new):
    text = path.read_text()
    assert text.count(old) == 1
    path.write_text(text.replace(old, new))


@pytest.mark.parametrize("change", LAW_MUTANTS.values(), ids=LAW_MUTANTS)
def test_other_equations_lose_the_proof(folder, change):
    mutate(folder / LAW.name, *change)
    found = claims_of(folder)
    assert {claim.verdict for claim in found.claims} == {Verdict.UNDECIDED}
    assert "its torque does not give J Omega'" in found.claims[0].reason


@pytest.mark.parametrize("change", SYSTEM_MUTANTS.values(), ids=SYSTEM_MUTANTS)
def test_a_system_that_its_motion_contradicts_is_not_used(folder, change):
    mutate(folder / LAW.name, *change)
    found = claims_of(folder)
    assert {claim.verdict for claim in found.claims} == {Verdict.UNDECIDED}
    assert "contradicted by its motion" in found.claims[0].reason
    assert "SlidingLaw.proofs" in found.claims[0].next_step


@pytest.mark.parametrize("change", SYSTEM_MUTANTS.values(), ids=SYSTEM_MUTANTS)
def test_its_part_of_the_checker_refuses_it_too(folder, change, monkeypatch):
    """As if the trial had seen nothing."""
    from intermit.verify.filter import known_proofs

    monkeypatch.setattr(known_proofs, "require_sound", lambda *_: None)
    mutate(folder / LAW.name, *change)
    found = claims_of(folder)
    assert {claim.verdict for claim in found.claims} == {Verdict.UNDECIDED}
    reason = found.claims[0].reason
    assert "is not proved on" in reason or "no further step could be proved" in reason


@pytest.mark.parametrize("name", PART_MUTANTS)
def test_one_mistake_in_both_is_seen_by_the_motion(folder, name):
    mutate(folder / PART.name, *PART_MUTANTS[name])
    assert claims_of(folder).claims[0].verdict is Verdict.PROVED, (
        "a part that asks less accepts what is right"
    )
    mutate(folder / LAW.name, *SYSTEM_MUTANTS[name])
    assert {claim.verdict for claim in claims_of(folder).claims} == {Verdict.UNDECIDED}


@pytest.mark.parametrize("line", ["    part = PART\n", '    system_name = "sliding"\n'])
def test_a_system_without_its_part_proves_nothing(folder, line):
    mutate(folder / LAW.name, line, "")
    found = claims_of(folder)
    assert {claim.verdict for claim in found.claims} == {Verdict.UNDECIDED}
    assert "has no part of the checker" in found.claims[0].reason


@pytest.mark.parametrize(
    "change",
    [
        ("-n.delta * G * y", "-np.sqrt(n.delta) ** 2 * G * y"),
        ("cosine_gap", "cosine_gab"),
        ("kappa, delta = PART.module.numbers_of(data)", "kappa, delta = 1 / 0, 1"),
    ],
    ids=["not + - * /", "bounds of another name", "an error"],
)
def test_a_proof_that_fails_is_refused_with_what_it_said(folder, change):
    mutate(folder / LAW.name, *change)
    found = claims_of(folder)
    assert {claim.verdict for claim in found.claims} == {Verdict.UNDECIDED}
    assert "that law SlidingLaw brings fails (" in found.claims[0].reason


def test_a_part_cannot_replace_what_the_checker_has(folder):
    source = (folder / PART.name).read_text()
    with pytest.raises(ValueError, match="has an entry"):
        checker.read_part(source.replace('"sliding"', '"persistence-filter"'), "x.py")
    with pytest.raises(ValueError, match="brings neither"):
        checker.read_part("x = 1", "x.py")
    assert alone("--with", "absent.py", "c.json").returncode == 2


FORGERIES = {
    "shrinks 3 % faster": ("claim.ratio", "0.97"),
    "settles 3 % sooner": ("claim.settling.time", "0.97"),
    "3 % less torque": ("claim.torque", "0.97"),
    "another gain": ("data.parameters.kappa", "1.03"),
    "less damping": ("data.parameters.delta", "0.97"),
    "a larger set": ("data.initial_set.max_angle_deg", "1.03"),
    "a lighter body": ("data.inertia.2.2", "0.9"),
    "a tighter bound": ("witness.bins.0.steps.3.bounds.s.2", "0.5"),
    "a faster decay": ("witness.bins.0.tail.ratio", "0.97"),
}


@pytest.mark.parametrize(("path", "factor"), FORGERIES.values(), ids=FORGERIES)
def test_a_forged_certificate_is_refused(path, factor, certified):
    part, file = checker.read_part(PART.read_text(), PART.name), json.loads(certified)
    assert all(found.valid for found in checker.check_text(json.dumps(file), (part,)))
    (entry,) = file["parts"]
    place = {**entry["certificates"][0], "data": entry["data"]}
    *road, last = (int(step) if step.isdigit() else step for step in path.split("."))
    for step in road:
        place = place[step]
    place[last] = str(F(place[last]) * F(factor))
    assert not all(found.valid for found in checker.check_text(json.dumps(file), (part,)))


@pytest.fixture(scope="module")
def certified(tmp_path_factory):
    """The certificate's text."""
    folder = tmp_path_factory.mktemp("law")
    shutil.copy(LAW, folder)
    shutil.copy(PART, folder)
    (evidence, *_) = claims_of(folder).claims[0].evidence
    return certificate_text([evidence.details["certificate"]])


@pytest.mark.slow
def test_it_is_reported(folder):
    out = folder / "out"
    assert run(["report", str(folder / "s.toml"), "-o", str(out), "--no-optimum"]) in (0, 3)
    page = next(out.rglob("*.html")).read_text()
    assert "Sliding law" in page
    assert "PROVED" in page
    record = json.loads(next(out.rglob("results.json")).read_text())
    (case,) = record["sections"]["cases"]
    assert [p["unit"] for p in case["parameters"]] == ["1/s", "1/s"]
    (certified,) = case["certificates"]
    assert certified["arrays"].get("angle_bound")
    assert not certified["arrays"].get("filter_floor"), "the law has no filter"


def test_the_page_shows_these_files():
    page = (Path(__file__).parents[2] / "docs" / "how-to" / "add-a-law.md").read_text(encoding="utf-8")
    blocks = re.findall(r"^```py\n(.*?)^```", page, flags=re.DOTALL | re.MULTILINE)
    assert len(blocks) > 8
    both, shown = flat(LAW.read_text() + PART.read_text()), [flat(block) for block in blocks]
    assert [block for block in shown if block not in both] == []
    assert sum(map(len, shown)) > 0.7 * len(both), "all that matters is shown"


def flat(text):
    """Lines without indentation: a method stands on the page without its class; the formatter joins lines."""
    return re.sub(r"[\s,]+", " ", text)
