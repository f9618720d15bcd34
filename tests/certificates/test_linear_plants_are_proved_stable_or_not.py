"""Floquet multipliers of linear plants: enclosed, proved on the right side of 1, never on the wrong one."""

import json
from fractions import Fraction as F
from math import exp
from pathlib import Path

import intermit
import numpy as np
import pytest
from intermit.cli.app import run
from intermit.models.linear import LinearPlant
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.scenario import load_scenario
from intermit.study.check.run import scenario_claims
from intermit.verify import checker
from intermit.verify.certificates import as_text, certificate_text
from intermit.verify.certificates.schedule import schedule_data
from intermit.verify.linear.stability import spectral_radius, stability_claim
from intermit.verify.verdict import Verdict
from problems import paper_schedule

INTEGRAL = 2.405  # of the printed g over a period: ramps of 0.8 s and 0.81 s, plateau of 1.6 s


def plant(A, B, K, schedule=None):
    return LinearPlant(
        np.array(A, float), np.array(B, float), np.array(K, float), schedule or paper_schedule()
    )


def scalar(a, k):
    return plant([[a]], [[1]], [[k]])


@pytest.mark.parametrize(("a", "k"), [(0.1, 0.8), (0.5, 0.8), (-0.2, 0.0), (0.25, 0.9)])
def test_scalar_plants_have_the_exact_multiplier(a, k):
    """x(T) = x(0) exp(a T - k integral of g)."""
    found = spectral_radius(scalar(a, k))
    exact = exp(8 * a - k * INTEGRAL)
    assert found.low < exact < found.high
    assert found.high / found.low < 1 + 1e-8


def test_monodromy_is_enclosed():
    """Centre within its radius of a Taylor solution, and far from another plant's."""
    A, F_ = [[0.0, 1.0], [-1.0, 0.1]], [[0.0, 0.0], [0.4, 0.7]]
    schedule = paper_schedule()
    profile = checker.read_profile(checker.Node({"schedule": as_text(schedule_data(schedule))}, "data"))
    exact = [[[F(x) for x in row] for row in M] for M in (A, F_)]
    centre, radius = checker.monodromy(*exact, profile)
    found = plant(A, [[0], [1]], [[0.4, 0.7]]).transition(F(0), F(8))
    assert float(radius) < 1e-13
    assert np.abs(found - np.array([[float(x) for x in row] for row in centre])).max() < 1e-11


def test_a_stabilised_oscillator_is_proved():
    claim = stability_claim(plant([[0, 1], [-1, 0.05]], [[0], [1]], [[0, 1]]))
    assert claim.verdict is Verdict.PROVED
    assert claim.quantities[0].high < 1


def test_a_free_oscillator_is_refuted_with_a_growing_direction():
    claim = stability_claim(plant([[0, 1], [-1, 0.05]], [[0], [1]], [[0, 0.05]]))
    assert claim.verdict is Verdict.REFUTED
    assert claim.witness.violation.low > 0


def test_the_boundary_is_undecided():
    claim = stability_claim(plant([[0, 1], [-1, 0]], [[0], [0]], [[0, 0]]))
    assert claim.verdict is Verdict.UNDECIDED


def test_finite_tables_are_undecided():
    finite = build_schedule([Window(F(0), F(1))], Hermite())
    assert stability_claim(plant([[-1]], [[1]], [[0]], finite)).verdict is Verdict.UNDECIDED
    with pytest.raises(ValueError, match="period"):
        spectral_radius(plant([[-1]], [[1]], [[0]], finite))


def test_a_plant_too_fast_to_enclose_is_undecided():
    for speed in ("1e3", "1e30"):
        claim = stability_claim(LinearPlant.from_rows([["-" + speed]], [["1"]], [["0"]], paper_schedule()))
        assert claim.verdict is Verdict.UNDECIDED
        assert "steps" in claim.reason


def test_decimals_are_proved_as_written():
    """0.05 is 1/20, not the nearest float, in the certificate's data."""
    claim = stability_claim(LinearPlant.from_rows([["-0.05"]], [["1"]], [["0.1"]], paper_schedule()))
    certificate = claim.evidence[0].details["certificate"]
    assert certificate.data["plant"]["A"] == ((F(-1, 20),),)
    with pytest.raises(ValueError, match="one length"):
        LinearPlant.from_rows([[1, 2], [3]], [[1], [1]], [[1, 1]], paper_schedule())


STABLE = """
[linear]
A = [[0, 1], [-1, 0.05]]
B = [[0], [1]]
K = [[0, {damping}]]

[[law]]
type = "persistence-filter"
"""


@pytest.mark.parametrize(("damping", "verdict", "code"), [("1", "PROVED", 0), ("0.05", "REFUTED", 1)])
def test_a_scenarios_plant_is_checked_certified_and_rechecked(tmp_path, capsys, damping, verdict, code):
    example = Path(intermit.__file__).parent / "examples" / "paper.toml"
    toml, file = tmp_path / "plant.toml", tmp_path / "plant.json"
    toml.write_text(f'extends = "{example}"\n' + STABLE.format(damping=damping))
    scenario = load_scenario(toml)
    claim = {c.key: c for c in scenario_claims(scenario)}["linear.stable"]
    assert claim.verdict.value == verdict
    assert claim.verdict.exit_code == code
    assert run(["certify", str(toml), "-o", str(file)]) == 0
    assert run(["recheck", str(file), "--scenario", str(toml)]) == 0
    assert "VALID  floquet" in capsys.readouterr().out
    toml.write_text(toml.read_text().replace(f"0, {damping}", "0, 0.9"))
    assert run(["recheck", str(file), "--scenario", str(toml)]) == 1
    assert "plant" in capsys.readouterr().out


def certificate_of(claim):
    return json.loads(certificate_text([claim.evidence[0].details["certificate"]]))


def verdict(document, change):
    fresh = json.loads(json.dumps(document))
    change(fresh["parts"][0]["data"], fresh["parts"][0]["certificates"][0])
    return all(f.valid for f in checker.check_text(json.dumps(fresh)))


def test_more_than_was_proved_is_refused():
    document = certificate_of(stability_claim(plant([[0, 1], [-1, 0.05]], [[0], [1]], [[0, 1]])))

    def tighter(_, c):
        c["claim"]["radius"] = str(F(c["claim"]["radius"]) * F(999, 1000))

    def other_side(_, c):
        c["claim"]["side"] = "above"

    def weaker_gain(data, _):
        data["plant"]["K"][0][1] = "0.9"

    def corrupted(_, c):
        c["witness"]["P"][0][0] = "-1"

    def skewed(_, c):
        c["witness"]["P"][0][1] = "0.3"

    assert verdict(document, lambda *_: None)
    for change in (tighter, other_side, weaker_gain, corrupted, skewed):
        assert not verdict(document, change), change.__name__


def test_growth_needs_a_direction_of_growth():
    document = certificate_of(stability_claim(plant([[0.2, 0], [0, -1]], [[0], [1]], [[0, 1]])))

    def other_direction(_, c):
        c["witness"]["x"] = ["0", "1"]

    assert verdict(document, lambda *_: None)
    assert not verdict(document, other_direction)
