"""[uncertainty] in scenario files: read, checked, certified, rechecked; refused where senseless."""

from fractions import Fraction as F

import intermit
import pytest
from intermit.scenario import load_scenario
from intermit.scenario.errors import ScenarioError
from intermit.study.certify.same_scenario import differences

TEXT = """
name = "uncertain"
[spacecraft]
inertia = [[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]]
[schedule]
period = 8
on = 0.01
on_time = 3.2
shape = "ramps"
ramp_up = 0.5
ramp_down = 0.5
[initial]
axis = [1, 1, 1]
angle_deg = 90
[[law]]
type = "{law}"
{parameters}
[simulation]
horizon = 16
[uncertainty]
{table}
"""
FILTER = ("persistence-filter", "lambda = 0.525\nR0 = 1")
PD = ("quaternion-pd", "proportional = 1\nderivative = 2")


def scenario(tmp_path, table, law=FILTER):
    path = tmp_path / "s.toml"
    path.write_text(TEXT.format(table=table, law=law[0], parameters=law[1]))
    return path


def claims(path, **options):
    study = intermit.check(path, margins=False, search=False, **options)
    return {claim.key: claim for case in study.cases for claim in case.claims}


def test_a_check_speaks_of_every_body(tmp_path):
    found = claims(scenario(tmp_path, "inertia_relative = 0.02\nthrust_error = [-0.03, 0]"))
    assert found["robust.floor"].verdict.value == "PROVED"
    assert found["robust.convergence"].verdict.value == "PROVED"
    assert "0.97 to 1" in found["robust.convergence"].statement
    assert found["convergence"].verdict.value == "PROVED"
    assert any(q.name == "members_floor" for q in found["robust.floor"].quantities)


def test_a_disturbance_asks_for_a_bound(tmp_path):
    found = claims(scenario(tmp_path, "disturbance = 0.001"))
    assert found["robust.ultimate"].verdict.value == "PROVED"
    assert "robust.convergence" not in found


def test_nothing_uncertain_asks_nothing(tmp_path):
    assert not any(key.startswith("robust") for key in claims(scenario(tmp_path, "")))


def test_another_law_is_undecided_in_its_own_words(tmp_path):
    claim = claims(scenario(tmp_path, "inertia_relative = 0.02", PD))["robust.convergence"]
    assert claim.verdict.value == "UNDECIDED"
    assert "quaternion-pd" in claim.reason
    assert any(q.name == "members_last_angle" for q in claim.quantities)


def test_the_channel_in_the_way_is_named(tmp_path):
    claim = claims(scenario(tmp_path, "inertia_relative = 0.3\ndisturbance = 0.0001"))["robust.ultimate"]
    assert claim.verdict.value == "UNDECIDED"
    assert "without inertia_relative it is proved" in claim.next_step


def test_certificates_of_every_body_are_rechecked(tmp_path):
    certified = intermit.certify(scenario(tmp_path, "inertia_relative = 0.02"))
    assert "robust-floor" in {certificate.kind for certificate in certified.certificates}
    assert intermit.recheck(certified).valid
    assert differences(certified.text, load_scenario(tmp_path / "s.toml")) == ()
    other = load_scenario(scenario(tmp_path, "inertia_relative = 0.025"))
    assert any("uncertainty" in gap for gap in differences(certified.text, other))


@pytest.mark.parametrize(
    ("table", "words"),
    [
        ("inertia_relative = 1", "inertia_relative must lie in"),
        ("inertia_scale = [-1, 0]", "inertia_scale must be"),
        ("thrust_error = [0.1, 0.2]", "thrust_error must be"),
        ("thrust_error = -0.1", "must be >= 0"),
        ("thrust_error = [1, 2, 3]", "number or"),
        ("misalignment_deg = 40", "misalignment_deg must lie in"),
        ("disturbance = -1", "must be >= 0"),
        ("inertia_tolerance = 5", "not positive definite"),
        ("inertia_tolerance = [1, 2]", "three rows"),
        ('thrust_error_varies = "often"', "thrust_error_varies"),
        ("delays = 1", "delays"),
    ],
)
def test_senseless_tables_are_refused_in_one_line(tmp_path, table, words):
    with pytest.raises(ScenarioError, match=r"uncertainty") as error:
        load_scenario(scenario(tmp_path, table))
    assert words in str(error.value)
    assert "\n" not in str(error.value)


def test_one_number_stands_for_both_sides(tmp_path):
    read = load_scenario(scenario(tmp_path, "inertia_scale = 0.05")).uncertainty
    assert read.inertia_scale == (F(-1, 20), F(1, 20))


def test_two_meanings_of_a_tolerance_are_refused(tmp_path):
    path = scenario(tmp_path, "inertia_tolerance = 0.01")
    path.write_text(path.read_text().replace("[schedule]", "inertia_tolerance = 0.01\n[schedule]", 1))
    with pytest.raises(ScenarioError, match="knows the true inertia"):
        load_scenario(path)


def test_a_tolerance_the_controller_knows_is_said_left_out(tmp_path):
    """`spacecraft.inertia_tolerance` is no channel: beside others a claim must not seem to hold over it."""
    path = scenario(tmp_path, "disturbance = 0.001", PD)
    words = "spacecraft.inertia_tolerance is not covered here"
    assert words not in claims(path)["robust.ultimate"].statement
    path.write_text(path.read_text().replace("[spacecraft]", "[spacecraft]\ninertia_tolerance = 0.01"))
    assert words in claims(path)["robust.ultimate"].statement
