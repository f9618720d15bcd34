"""Large angles with a rate: the bound of the angle nears 2 pi, and the floor is proved near the truth."""

from fractions import Fraction as F

import pytest
from intermit.models.laws import PersistenceFilter
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify.filter.certify import certify_floor
from intermit.verify.filter.comparison import TANGENTS, BodyBounds, angle_factor, rate_factor
from intermit.verify.filter.sets import InitialSet

BODY = RigidBody.from_rows(
    [["2.651", "0.5286", "-0.7713"], ["0.5286", "2.6675", "0.4032"], ["-0.7713", "0.4032", "2.1744"]]
)
SCHEDULE = build_schedule([Window(F("4.22"), F("9.8"))], Hermite(), period=F("10.04"))
LAW = PersistenceFilter(F("0.7009"), F("1.37"))
LEAST_FOUND = 0.04912
"""s, over 300 adversarial starts, 8 periods, of an independent fixed-step integration."""


def test_a_set_of_200_degrees_with_a_rate_is_certified_tightly():
    bounds = BodyBounds.of(BODY)
    initial = InitialSet.from_bounds(bounds, max_angle_deg=F(200), max_weighted_rate=F("0.49"))
    floor = certify_floor(LAW, bounds, SCHEDULE, initial)
    assert floor.failed_at is None
    assert 0.9 * LEAST_FOUND <= floor.value <= LEAST_FOUND


@pytest.mark.parametrize("form", [1, 7, 32, TANGENTS])
def test_a_tangent_bounds_the_factor_and_touches_it(form):
    touched = 2 * (1 - (form / TANGENTS) ** 2)
    for S in [k / 50 for k in range(101)]:
        assert rate_factor(S, str(form)) >= (1 - S / 2) ** 0.5 - 1e-15
    assert rate_factor(touched, str(form)) == pytest.approx(form / TANGENTS, abs=1e-14)


def test_tangents_are_sharper_near_a_full_turn():
    S = 1.85
    best = min(rate_factor(S, str(form)) for form in range(1, TANGENTS + 1))
    assert best < 1.001 * (1 - S / 2) ** 0.5
    assert angle_factor(S) > 1.5 * best
