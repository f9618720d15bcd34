"""What extreme members do from one start: figures of simulated runs, which prove nothing."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.ensemble import Tolerances, simulate_ensemble
from ...models.laws import Law
from ...models.members import DrawnMember, draw_members
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ...models.types import Array
from ...models.uncertainty import Uncertainty

MEMBERS = 24
OUTPUTS = 400
FLYING = Tolerances(rtol=1e-8, atol=1e-10)
"""Figures of members are shown to a few digits."""


@final
@dataclass(frozen=True)
class MembersFound:
    """Figures of members flown from one start.

    Attributes
    ----------
    count : members flown
    horizon : end of the runs, s
    least_filter : least R, s; None for a law without filter
    largest_angle : largest error angle 2 acos(b0), rad
    last_angle, last_rate : largest error angle (rad) and rate (rad/s) over the last tenth of the runs
    stopped : runs that ended before the horizon
    """

    count: int
    horizon: float
    least_filter: float | None
    largest_angle: float
    last_angle: float
    last_rate: float
    stopped: int


def fly_members(
    law: Law,
    believed: RigidBody,
    schedule: Schedule,
    uncertainty: Uncertainty,
    start: Array,
    horizon: Fraction,
    *,
    seed: int,
    count: int = MEMBERS,
) -> MembersFound:
    """Fly extreme members from a start, (7,): unit quaternion and rate, rad/s."""
    members = draw_members(law, believed, uncertainty, count, np.random.default_rng(seed))
    times = np.linspace(0.0, float(horizon), OUTPUTS + 1)[1:]
    groups: dict[str, list[DrawnMember]] = {}
    for member in members:
        groups.setdefault(member.law.toward, []).append(member)
    runs = [
        simulate_ensemble(
            [m.law for m in group], [m.body for m in group], schedule, start,
            horizon=horizon, times=times, tolerances=FLYING,
        )
        for group in groups.values()
    ]  # fmt: skip
    states = np.concatenate([run.states for run in runs])
    names = runs[0].state_names
    angle = 2 * np.arctan2(np.linalg.norm(states[:, :, 1:4], axis=2), states[:, :, 0])
    rate = np.linalg.norm(states[:, :, 4:7], axis=2)
    late = times >= 0.9 * float(horizon)
    return MembersFound(
        count=count,
        horizon=float(horizon),
        least_filter=float(np.nanmin(states[:, :, names.index("R")])) if "R" in names else None,
        largest_angle=float(np.nanmax(angle)),
        last_angle=float(np.nanmax(angle[:, late])),
        last_rate=float(np.nanmax(rate[:, late])),
        stopped=int(sum((~run.completed).sum() for run in runs)),
    )
