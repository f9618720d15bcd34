"""Thrusters that cannot push every way still make the transfers that need no push that way."""

from fractions import Fraction as F

import pytest
from intermit.models.norms import thrusters
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Window, build_schedule
from intermit.models.schedule.profiles import Hermite
from intermit.optim import MultiStart, TransferProblem, minimum_peak
from intermit.optim.peak import Standing
from intermit.optim.problem import quaternion_from_axis_angle

HALF_EQUIPPED = ((1, 0, 0), (-1, 0, 0), (0, 1, 0), (0, -1, 0), (0, 0, 1))


def solve(axis, degrees, rows=HALF_EQUIPPED, starts=1):
    body = RigidBody(((F(3), F(0), F(0)), (F(0), F(2), F(0)), (F(0), F(0), F("1.5"))))
    problem = TransferProblem.through(
        build_schedule([Window(F(0), F(20))], Hermite()),
        body=body,
        horizon=20,
        attitude=quaternion_from_axis_angle(axis, degrees * 3.141592653589793 / 180),
        norm=thrusters(tuple(tuple(F(x) for x in row) for row in rows)),
    )
    return minimum_peak(problem, search=MultiStart(starts=starts))


@pytest.mark.slow
def test_a_turn_about_an_axis_with_both_jets_is_found():
    answer = solve((1, 0, 0), 40)
    assert answer.standing is Standing.CHECKED
    assert answer.peak <= 4 * 3 * 0.6981317007977318 / 20**2 * (1 + 1e-6)  # bang-bang about x alone


@pytest.mark.slow
def test_a_set_short_of_one_direction_may_still_turn_about_it():
    answer = solve((0, 0, 1), 40, rows=((0, 0, 1), (0, 1, 0), (1, 0, 0), (-1, 0, 0)))
    assert answer.standing is Standing.CHECKED
    assert (answer.history.control >= 0).all()
