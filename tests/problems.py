"""Shared problems with known answers: the paper's bodies and schedules, and exact relations on them."""

from __future__ import annotations

from fractions import Fraction as F

import numpy as np
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Schedule, Window, build_schedule

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
J2 = RigidBody.from_rows([["20", "1.2", "0.9"], ["1.2", "17", "1.4"], ["0.9", "1.4", "15"]])
UNIT = RigidBody.from_rows([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
DIAG123 = RigidBody.from_rows([[1, 0, 0], [0, 2, 0], [0, 0, 3]])


def paper_schedule(*, as_printed: bool = True) -> Schedule:
    """Period 8 s, on 3.2 s from 0.01 s; g as printed overruns its window by 0.01 s."""
    return build_schedule(
        [Window(F("0.01"), F("3.21"))], Hermite(F("0.01") if as_printed else F(0)), period=F(8)
    )


REST = np.zeros(3)
TILTED = np.array([0.5, 0.5, 0.5, 0.5])
"""120 deg about (1, 1, 1)."""

ADAPTIVE = AdaptiveScaling(lambda_=F("0.525"), gamma=F("0.1"), R0=F(1), k0=F("0.2"))
PERSISTENCE = PersistenceFilter(lambda_=F("0.525"), R0=F(1))

CONVERGED_FILTER_FLOOR = 0.149646
"""Least converged R for lambda = 0.525 and g as printed, six digits (closed form)."""


def random_quaternion(rng: np.random.Generator) -> np.ndarray:
    """Uniform on the sphere."""
    q = rng.normal(size=4)
    return q / np.linalg.norm(q)
