"""[uncertainty] in scenario files: read, checked, certified, rechecked; refused where senseless."""

from fractions import Fraction as F
from math import degrees

import missions
import pytest
from intermit.models.rigid_body import RigidBody
from intermit.models.uncertainty import Uncertainty
from intermit.verify.filter.certify import certify_floor
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.recognise import NoComparisonError
from intermit.verify.filter.sets import InitialSet
from intermit.verify.robust.answer import certify_robust_floor
from intermit.verify.robust.consequences import consequences
from intermit.verify.robust.inertia_set import relative_error
from robust_attack import ADAPTIVE, BODY, LAW, SCHEDULE, TOLERANCE, attack, question


def test_nothing_uncertain_gives_the_nominal_floor():
    floor = certify_robust_floor(question())
    bounds = BodyBounds.of(BODY)
    initial = InitialSet.from_bounds(bounds, max_angle_deg=F(120), max_weighted_rate=F(3, 10))
    nominal = certify_floor(LAW, bounds, SCHEDULE, initial)
    # the slacks of the two proofs, 3e-4 and 2e-4 of the rates, differ
    assert floor.value == pytest.approx(nominal.value, rel=1e-3)


@pytest.mark.parametrize(
    "channels",
    [
        {"inertia_relative": F(3, 100)},
        {"inertia_relative": F(4, 100), "rate": F(0)},
        {"inertia_scale": (F(-10, 100), F(0)), "thrust_error_varies": "never"},
        {"inertia_relative": F(2, 100), "thrust_error": (F(-5, 100), F(0))},
        {"inertia_relative": F(7, 100), "angle": 60, "rate": F(1, 10)},
        {"misalignment_deg": F(1)},
    ],
    ids=["shape", "shape at rest", "scale", "low thrust", "small set", "turned"],
)
def test_attitude_and_rate_converge_for_every_body(channels):
    floor = certify_robust_floor(question(**channels))
    found = consequences(floor)
    assert floor.failed_at is None
    assert floor.repeats
    assert found.ratio is not None
    assert found.ratio < 0.95


def test_a_larger_set_has_a_lower_floor():
    floors = [certify_robust_floor(question(inertia_relative=F(k, 100))).value for k in (0, 1, 2, 3)]
    assert floors == sorted(floors, reverse=True)
    assert floors[0] > floors[-1]


def test_a_disturbance_ends_in_a_bound_in_proportion_to_it():
    angles = []
    for newton_metres in (F(1, 200), F(1, 100)):
        found = consequences(certify_robust_floor(question(disturbance=newton_metres)))
        assert found.ratio is None
        angles.append(degrees(found.ultimate.angle))
    assert angles[1] / angles[0] == pytest.approx(2, rel=0.02)


def test_a_constant_torque_comes_near_the_bound():
    q = question(disturbance=F(1, 100))
    floor = certify_robust_floor(q)
    worst = attack(q, floor, runs=16, periods=9, seed=2)
    assert 0.85 < worst["late"] <= 1 + TOLERANCE


def test_a_thrust_factor_for_all_time_is_an_inertia():
    """(1 + d) u on J is u on J/(1 + d): the same bins, the same proof."""
    low = certify_robust_floor(question(thrust_error=(F(0), F(1, 10)), thrust_error_varies="never"))
    scale = (1 / (1 + F(1, 10)) - 1, F(0))
    heavy = certify_robust_floor(question(inertia_scale=scale))
    assert low.value == heavy.value


def test_too_much_is_not_proved():
    assert certify_robust_floor(question(inertia_relative=F(15, 100))).failed_at is not None


def test_a_tolerance_of_a_singular_inertia_is_refused():
    tolerance = ((F(3), F(0), F(0)), (F(0), F(3), F(0)), (F(0), F(0), F(3)))
    with pytest.raises(ValueError, match="singular"):
        certify_robust_floor(question(inertia_tolerance=tolerance))


def test_entries_are_turned_into_the_least_relative_error():
    tolerance = tuple(tuple(x / 50 for x in row) for row in BODY.exact_inertia)
    assert float(relative_error(BODY, tolerance)) == pytest.approx(0.0242, abs=5e-3)
    diagonal = RigidBody.from_rows([[1, 0, 0], [0, 2, 0], [0, 0, 2]])
    assert relative_error(diagonal, ((F(1, 10), 0, 0), (0, 0, 0), (0, 0, 0))) == pytest.approx(0.1, abs=2e-6)


def test_a_law_that_learns_is_certified_for_every_body():
    floor = certify_robust_floor(question(law=ADAPTIVE, inertia_relative=F(2, 100)))
    found = consequences(floor)
    assert floor.repeats
    assert floor.value > 0.145
    assert found.ratio < 0.4


def test_a_disturbance_keeps_a_gain_growing():
    """Nothing holds for all time: the bounds end at the horizon asked for."""
    floor = certify_robust_floor(question(law=ADAPTIVE, disturbance=F(1, 100)))
    assert floor.failed_at is None
    assert not floor.repeats
    assert floor.horizon == 56


def test_a_law_of_other_equations_is_refused():
    from intermit.models.laws import QuaternionPD

    with pytest.raises(NoComparisonError):
        certify_robust_floor(missions.robust(
            law=QuaternionPD(F(1), F(1)), body=BODY, schedule=SCHEDULE, uncertainty=Uncertainty(),
            max_angle_deg=F(10),
        ))  # fmt: skip
