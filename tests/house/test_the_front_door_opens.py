"""Everything the command line does is one call at the root, with the command line's own answers."""

from pathlib import Path

import intermit
import pytest
from intermit.verify.verdict import Verdict

PAPER = Path(intermit.__file__).parent / "examples" / "paper.toml"
DOOR = ("bound", "certify", "check", "compare", "load", "optimum", "recheck", "report", "simulate", "tune")


def test_the_door_is_what_the_commands_are():
    assert set(DOOR) <= set(intermit.__all__)
    assert all(getattr(intermit, name).__doc__ for name in DOOR)


def test_a_path_and_a_scenario_are_taken_alike():
    scenario = intermit.load(PAPER)
    run, again = (
        intermit.simulate(scenario, "persistence filter"),
        intermit.simulate(PAPER, "persistence filter"),
    )
    assert run.figures.settling == again.figures.settling
    assert run.trajectory.state(1.0).shape == (8,)


@pytest.mark.slow
def test_claims_certificates_and_their_recheck():
    study = intermit.check(PAPER, margins=False, search=False)
    proved = {c.key for c in study.all_claims if c.verdict is Verdict.PROVED}
    assert {"filter.floor", "convergence"} <= proved
    findings = intermit.recheck(intermit.certify(PAPER).text)
    assert findings
    assert all(finding.valid for finding in findings)


def test_what_is_wrong_is_one_error(tmp_path):
    with pytest.raises(intermit.ScenarioError, match="no such file"):
        intermit.check(tmp_path / "none.toml")
    with pytest.raises(intermit.ScenarioError, match="no law labelled"):
        intermit.simulate(PAPER, "nobody")
