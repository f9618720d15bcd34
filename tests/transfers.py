"""Transfers with known answers, shared by the tests of optima and bounds."""

from __future__ import annotations

import math
from collections.abc import Sequence
from fractions import Fraction

import numpy as np
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT, Norm, thrusters
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.optim.problem import TransferProblem, WindowProfile, quaternion_from_axis_angle
from problems import J1, UNIT, paper_schedule

HALF_TURN_TIME = Fraction("3.2431")
"""Bilimoria and Wie (J. Guidance 16, 1993): least time of a 180 deg turn, unit inertia, unit cube torque."""
TETRAHEDRON = thrusters([[1, 1, 1], [1, -1, -1], [-1, 1, -1], [-1, -1, 1]])


def paper_transfer(
    norm: Norm, *, body: RigidBody = J1, horizon: str = "51.22", **more: object
) -> TransferProblem:
    """120 deg about (1, 1, 1) from rest through the paper's windows."""
    return TransferProblem.through(
        paper_schedule(), body=body, horizon=horizon, attitude=(1, 1, 1, 1), norm=norm, **more
    )


def open_transfer(
    angle: float, axis: Sequence[float], horizon: Fraction, norm: Norm, *, body: RigidBody = UNIT
) -> TransferProblem:
    """Rest to rest with the thrusters always on: 4 angle / tf^2 for unit inertia, Euclidean."""
    schedule = build_schedule([Window(Fraction(0), horizon + 1)], Hermite())
    attitude = quaternion_from_axis_angle(axis, angle)
    return TransferProblem.through(schedule, body=body, horizon=horizon, attitude=attitude, norm=norm)


def random_transfer(number: int) -> TransferProblem:
    """One of a family: inertia ratios up to 3, 2 to 8 windows, 5 to 180 deg, every second one tumbling."""
    rng = np.random.default_rng(1000 + number)
    moments = rng.uniform(1, 3, 3)
    while moments.max() >= moments.sum() - moments.max():
        moments = rng.uniform(1, 3, 3)
    axes = np.linalg.qr(rng.normal(size=(3, 3)))[0]
    J = axes @ np.diag(moments) @ axes.T * 10 ** rng.uniform(-1, 2)
    count = int(rng.integers(2, 9))
    time, windows = 0.0, []
    for gap, length in zip(rng.uniform(0.2, 6, count), rng.uniform(0.5, 5, count), strict=True):
        time += gap
        windows.append(Window(Fraction(round(time, 3)), Fraction(round(time + length, 3))))
        time += length + 0.1
    horizon = Fraction(round(time + rng.uniform(-1.0, 3), 3))
    angle, axis = math.radians(rng.uniform(5, 180)), rng.normal(size=3)
    rate = np.zeros(3)
    if number % 2:
        direction = rng.normal(size=3)
        rate = direction / np.linalg.norm(direction) * rng.uniform(0, 0.5)
    return TransferProblem.through(
        build_schedule(windows, Hermite()),
        body=RigidBody.from_rows(((J + J.T) / 2).tolist()),
        horizon=horizon,
        attitude=quaternion_from_axis_angle(axis, angle),
        rate=rate.tolist(),
        norm=(EUCLIDEAN, LARGEST_COMPONENT, TETRAHEDRON)[number % 3],
        profile=WindowProfile.GAIN if number % 5 == 0 else WindowProfile.FULL,
    )
