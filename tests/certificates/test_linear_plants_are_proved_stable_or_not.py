"""Floquet multipliers of linear plants: enclosed, proved on the right side of 1, never on the wrong one."""

import json
from dataclasses import replace
from fractions import Fraction as F
from math import exp
from pathlib import Path

import intermit
import numpy as np
import pytest
from intermit.cli.app import run
from intermit.models.linear import LinearPlant
from intermit.models.schedule import Hermite, Ramps, Window, build_schedule
from intermit.scenario import load_scenario
from intermit.study.check.makers import scenario_claims
from intermit.verify import checker
from intermit.verify.certificates import as_text, certificate_text
from intermit.verify.certificates.schedule import schedule_data
from intermit.verify.linear.stability import (
    SpectralRadius,
    _not_told,
    spectral_radius,
    stability_claim,
    steps_needed,
)
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
    assert float(radius) < 1e-24
    assert np.abs(found - np.array([[float(x) for x in row] for row in centre])).max() < 1e-11


def test_a_stabilised_oscillator_is_proved():
    claim = stability_claim(plant([[0, 1], [-1, 0.05]], [[0], [1]], [[0, 1]]))
    assert claim.verdict is Verdict.PROVED
    assert claim.quantities[0].high < 1


def test_a_free_oscillator_is_refuted_with_a_growing_direction():
    claim = stability_claim(plant([[0, 1], [-1, 0.05]], [[0], [1]], [[0, 0.05]]))
    assert claim.verdict is Verdict.REFUTED
    assert claim.witness.violation.low > 0


@pytest.mark.parametrize(
    ("A", "B", "K"),
    [
        ([[0, 1], [-1, 0]], [[0], [0]], [[0, 0]]),  # an oscillator that nothing drives
        ([[0, 1], [0, 0]], [[0], [1]], [[0, 0]]),  # a double integrator without feedback
        ([[-1, 0], [0, 0]], [[1], [0]], [[1, 0]]),  # a mode that the thrusters do not reach
        (
            [[-1, 0, 0], [0, 0, 2], [0, -2, 0]],
            [[1], [0], [0]],
            [[1, 3, 3]],
        ),  # an oscillation, likewise
        ([[-1, 0], [5, 0]], [[1], [1]], [[1, 0]]),  # a mode that the feedback does not see
        ([["1e-12"]], [[1]], [[0]]),
    ],
)
def test_a_multiplier_of_modulus_one_or_more_is_refuted_exactly(A, B, K):
    claim = stability_claim(LinearPlant.from_rows(A, B, K, paper_schedule()))
    assert claim.verdict is Verdict.REFUTED
    certificate = claim.evidence[0].details["certificate"]
    assert certificate.kind == "floquet-liouville"
    file = json.loads(certificate_text([certificate]))
    (entry,) = file["parts"][0]["certificates"]
    entry["claim"]["growth"] = "1/7"
    assert not checker.check_text(json.dumps(file))[0].valid


@pytest.mark.parametrize("period", [500, 5700])
def test_a_slow_double_integrator_is_proved_stable(period):
    """800 kg m^2, a firing of 60 s: multipliers 0.86515 and 0.37526 for a period of 500 s."""
    schedule = build_schedule([Window(F(100), F(160))], Hermite(), period=F(period))
    plant = LinearPlant.from_rows([[0, 1], [0, 0]], [[0], ["0.00125"]], [["0.005", 20]], schedule)
    truth = np.abs(plant.floquet().multipliers).max()
    claim = stability_claim(plant)
    assert claim.verdict is (Verdict.PROVED if truth < 1 else Verdict.REFUTED)
    assert claim.quantities[0].low <= truth <= claim.quantities[0].high


def test_random_plants_are_decided_as_their_multipliers_say():
    rng, decided = np.random.default_rng(5), 0
    for _ in range(40):
        n = int(rng.integers(1, 4))
        scale = 10.0 ** rng.uniform(-3, 2)
        A = np.round(rng.normal(size=(n, n)) * scale, 6) - np.eye(n) * round(scale * rng.uniform(0, 2), 6)
        B, K = np.round(rng.normal(size=(n, 1)), 3), np.round(rng.normal(size=(1, n)) * scale, 6)
        found = plant(A, B, K)
        claim = stability_claim(found)
        if claim.verdict is Verdict.UNDECIDED:
            continue
        decided += 1
        with np.errstate(over="ignore"):
            truth = np.abs(found.floquet().multipliers).max() if scale < 10 else None
        if truth is not None and abs(truth - 1) > 1e-6:
            assert (claim.verdict is Verdict.PROVED) == (truth < 1)
    assert decided >= 30


def test_finite_tables_are_undecided():
    finite = build_schedule([Window(F(0), F(1))], Hermite())
    assert stability_claim(plant([[-1]], [[1]], [[0]], finite)).verdict is Verdict.UNDECIDED
    with pytest.raises(ValueError, match="period"):
        spectral_radius(plant([[-1]], [[1]], [[0]], finite))


@pytest.mark.parametrize("speed", ["1e3", "1e4", "1e30"])
def test_a_stiff_plant_is_proved_without_its_monodromy_matrix(speed):
    claim = stability_claim(LinearPlant.from_rows([["-" + speed]], [["1"]], [["0"]], paper_schedule()))
    assert claim.verdict is Verdict.PROVED
    file = json.loads(certificate_text([claim.evidence[0].details["certificate"]]))
    assert file["parts"][0]["certificates"][0]["kind"] == "floquet-lyapunov"
    file["parts"][0]["data"]["plant"]["A"] = [[speed]]
    assert not checker.check_text(json.dumps(file))[0].valid


def test_a_plant_too_fast_to_enclose_is_undecided_with_its_size():
    fast = LinearPlant.from_rows(
        [["-1e6", "2e6"], ["-2e6", "1"]], [["1"], ["0"]], [["0", "3e6"]], paper_schedule()
    )
    claim = stability_claim(fast)
    assert claim.verdict is Verdict.UNDECIDED
    assert "steps (at most" in claim.reason


@pytest.mark.parametrize(
    ("modes", "period", "gains"),
    [
        ([("3", "0.03")], "8", ("0.1", "0.5")),
        ([("10", "0.1")], "20", ("0.02", "0.3")),
        ([("2", "0.02"), ("7", "0.07")], "20", ("0.02", "0.3")),
    ],
)
def test_flexible_modes_beside_an_axis_are_proved(modes, period, gains):
    """A double integrator under PD control through windows shakes modes of small damping."""
    n, zero = 2 + 2 * len(modes), "0"
    A = [[zero] * n for _ in range(n)]
    B, K = [["0"], ["1"]], [[*gains, *[zero] * (n - 2)]]
    A[0][1] = "1"
    for i, (frequency, damping) in enumerate(modes):
        j = 2 + 2 * i
        A[j][j + 1], A[j + 1][j], A[j + 1][j + 1] = "1", str(-(F(frequency) ** 2)), "-" + damping
        B += [["0"], ["-0.1"]]
    on = F("0.4") * F(period)
    windows = [Window(F("0.01"), F("0.01") + on)]
    schedule = build_schedule(windows, Ramps(on / 20, on / 20), period=F(period))
    stable = LinearPlant.from_rows(A, B, K, schedule)
    found = stability_claim(stable)
    assert found.verdict is Verdict.PROVED
    A[-1][-1] = "0.01"  # the partner: the last mode now grows by itself
    assert stability_claim(LinearPlant.from_rows(A, B, K, schedule)).verdict is Verdict.REFUTED


def test_multipliers_far_below_one_are_proved_small():
    schedule = build_schedule([Window(F(1), F(281))], Ramps(F(140), F(70)), period=F(600))
    swung = LinearPlant.from_rows([["0", "1"], ["-1", "0.02"]], [["0"], ["1"]], [["0", "0.3"]], schedule)
    assert stability_claim(swung).verdict is Verdict.PROVED


def test_ramps_of_a_thrust_that_nothing_feels_are_no_steps():
    schedule = build_schedule([Window(F(1), F(29))], Ramps(F(14), F(7)), period=F(60))
    free = LinearPlant.from_rows([["0", "1"], ["-400", "-0.4"]], [["0"], ["1"]], [["0", "0"]], schedule)
    assert steps_needed(free, [F(1), F(1)]) < 100
    felt = LinearPlant.from_rows([["0", "1"], ["-400", "-0.4"]], [["0"], ["1"]], [["0", "1"]], schedule)
    assert steps_needed(felt, [F(1), F(1)]) > 10_000
    assert stability_claim(free).verdict is Verdict.PROVED


def test_the_reason_is_the_enclosure_only_where_it_is_wide():
    radius = SpectralRadius(F(0), None, (), 0.9, 1e-3)
    assert "enclosed too widely" in _not_told(radius)
    assert "no quadratic function" in _not_told(replace(radius, width=1e-20))


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
