"""The transfer problem keeps the user's data exact and refuses nonsense."""

from __future__ import annotations

import math
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, thrusters
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.optim.problem import (
    Terminal,
    TransferProblem,
    WindowProfile,
    quaternion_from_axis_angle,
    window_profile,
)

SCHEDULE = build_schedule(
    [Window(Fraction("0.01"), Fraction("3.21"))], Hermite(overrun=Fraction("0.01")), period=Fraction(8)
)
BODY = RigidBody.from_rows([[2, 0, 0], [0, 3, 0], [0, 0, 4]])


def test_full_profile_is_one_on_the_support_of_g():
    w = window_profile(SCHEDULE, Fraction("51.22"), WindowProfile.FULL)
    open_pieces = [p for p in w.pieces if p.shape]
    expected = [(8 * k + Fraction("0.01"), 8 * k + Fraction("3.22")) for k in range(7)]
    assert [(p.start, p.end) for p in open_pieces] == expected
    assert w.knots[-1] == Fraction("51.22")


@pytest.mark.parametrize("horizon", ["1.3", "2.9", "9", "11.22"])
def test_gain_profile_is_g_up_to_the_horizon(horizon):
    w = window_profile(SCHEDULE, Fraction(horizon), WindowProfile.GAIN)
    assert w.knots[-1] == Fraction(horizon)
    t = np.linspace(0.0, float(Fraction(horizon)), 501)[1:-1]
    value = np.zeros_like(t)
    for piece in w.pieces:
        inside = (t >= float(piece.start)) & (t < float(piece.end))
        s = (t[inside] - float(piece.start)) / float(piece.length)
        value[inside] = sum(float(c) * s**i for i, c in enumerate(piece.shape))
    assert np.abs(value - SCHEDULE.gain(t)).max() < 1e-12


def test_refusals_name_the_fault():
    common = {"body": BODY, "attitude": (1, 1, 1, 1)}
    with pytest.raises(ValueError, match="transfer time must be > 0"):
        TransferProblem.through(SCHEDULE, horizon=0, **common)
    with pytest.raises(ValueError, match="not all zero"):
        TransferProblem.through(SCHEDULE, horizon=8, body=BODY, attitude=(0, 0, 0, 0))
    with pytest.raises(ValueError, match=r"in \[0, 1\)"):
        Terminal(attitude=Fraction(2))
    with pytest.raises(ValueError, match="must give a torque"):
        thrusters([[0, 0, 0], [0, 0, 0]])


def test_angle_is_that_of_the_attitude_not_of_the_sign():
    for degrees in (60.0, 120.0, 179.0):
        q = quaternion_from_axis_angle((1, -2, 3), math.radians(degrees))
        for sign in (1, -1):
            problem = TransferProblem.through(SCHEDULE, body=BODY, horizon=8, attitude=[sign * x for x in q])
            assert math.degrees(problem.angle) == pytest.approx(degrees, rel=1e-13)


def test_six_thrusters_along_the_axes_are_the_cube():
    rows = [[s if i == j else 0 for j in range(3)] for i in range(3) for s in (1, -1)]
    set_of = thrusters(rows)
    torque = np.random.default_rng(1).normal(size=(200, 3))
    assert set_of.spans_all_directions
    np.testing.assert_allclose(set_of.peak(torque), LARGEST_COMPONENT.peak(torque), rtol=1e-14)
    np.testing.assert_allclose(set_of.support(torque), LARGEST_COMPONENT.support(torque), rtol=1e-14)


def test_four_canted_thrusters_match_a_linear_program():
    from scipy.optimize import linprog

    rows = [[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]]
    set_of = thrusters(rows)
    assert set_of.spans_all_directions
    B = set_of.control_matrix
    for torque in np.random.default_rng(2).normal(size=(30, 3)):
        lp = linprog(
            np.r_[np.zeros(4), 1.0],
            A_ub=np.c_[np.eye(4), -np.ones(4)],
            b_ub=np.zeros(4),
            A_eq=np.c_[B, np.zeros(3)],
            b_eq=torque,
        )
        assert float(set_of.peak(torque)) == pytest.approx(lp.fun, rel=1e-9)


def test_one_sided_thrusters_that_push_one_way_only_say_so():
    set_of = thrusters([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
    assert not set_of.spans_all_directions
    assert math.isinf(float(set_of.peak([-1.0, 0.0, 0.0])))
    assert float(set_of.peak([1.0, 2.0, 0.5])) == pytest.approx(2.0)


@pytest.mark.parametrize("norm", [EUCLIDEAN, LARGEST_COMPONENT])
def test_peak_and_support_are_polar(norm):
    rng = np.random.default_rng(3)
    torque, direction = rng.normal(size=(2, 500, 3))
    assert np.all((torque * direction).sum(-1) <= norm.peak(torque) * norm.support(direction) + 1e-12)
