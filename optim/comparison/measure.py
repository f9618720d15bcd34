"""What a law did on a transfer: settling, peaks, impulse, least filter state, from one accurate run."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.laws import Law
from ...models.norms import Norm
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ...models.simulation import (
    DOP853,
    Figures,
    Trajectory,
    peak_commanded_torque,
    peak_torque,
    read_figures,
    simulate,
)
from ...models.types import Array


@final
@dataclass(frozen=True)
class Task:
    """The work every law is given.

    Attributes
    ----------
    body, schedule : what is turned, and through which windows
    quaternion : (4,), scalar first, unit; error attitude at the start
    rate : (3,), rad/s
    attitude_tolerance, rate_tolerance : settled means |bv| and |w| (rad/s) within these, Euclidean,
        for good
    horizon : end of the run, s
    """

    body: RigidBody
    schedule: Schedule
    quaternion: tuple[float, float, float, float]
    rate: tuple[Fraction, Fraction, Fraction]
    attitude_tolerance: Fraction
    rate_tolerance: Fraction
    horizon: Fraction

    @property
    def rate_array(self) -> Array:
        """Start rate, rad/s, (3,)."""
        return np.array([float(x) for x in self.rate])


@final
@dataclass(frozen=True)
class Goal:
    """What a law did, as an end that any controller can be asked for.

    Attributes
    ----------
    time : transfer time, s
    attitude, rate : Euclidean balls of |bv| and |w| (rad/s) around rest at the target
    """

    time: Fraction
    attitude: Fraction
    rate: Fraction


@final
@dataclass(frozen=True, eq=False)
class LawRun:
    """One law on a task; its torque figures are over [0, settling], or the whole run if it never settles."""

    label: str
    law: Law
    task: Task
    trajectory: Trajectory
    figures: Figures

    def peak(self, norm: Norm, *, commanded: bool = False) -> float:
        """Peak of the torque g u, or of the command u, in a norm and its unit."""
        torque = self.figures.torque
        known, measure = (
            (torque.peak_commanded, peak_commanded_torque) if commanded else (torque.peak, peak_torque)
        )
        found = known[norm] if norm in known else measure(self.trajectory, norm, until=torque.until)
        return found.value

    @property
    def end(self) -> tuple[float, float]:
        """|bv| and |w| (rad/s) at the end of the run."""
        state = self.trajectory.state(self.trajectory.end)
        return float(np.linalg.norm(state[1:4])), float(np.linalg.norm(state[4:7]))

    @property
    def goal(self) -> Goal | None:
        """Within the task's tolerances by the settling time; None if it never settles or starts there."""
        settling = self.figures.settling
        if settling is None or settling <= 0:
            return None
        return Goal(Fraction(settling), self.task.attitude_tolerance, self.task.rate_tolerance)

    @property
    def end_goal(self) -> Goal | None:
        """As near as it came by its horizon; None if its start is as near.

        The balls are wider by a millionth, so that the law's own torque, rounded, reaches them.
        """
        attitude, rate = (Fraction(x) * (1 + WIDER) for x in self.end)
        start = float(np.linalg.norm(self.task.quaternion[1:])), float(np.linalg.norm(self.task.rate_array))
        if attitude >= 1 or (start[0] <= attitude and start[1] <= rate):
            return None
        return Goal(self.task.horizon, attitude, rate)


WIDER = Fraction(1, 10**6)
"""By how much the balls that a law's end is put into are wider than it."""
ACCURATE = DOP853(rtol=1e-11, atol=1e-13)
"""Every reported number comes from a run at this setting: relative error below 1e-10."""


def run_law(label: str, law: Law, task: Task, *, method: DOP853 = ACCURATE) -> LawRun:
    """Simulate a law on a task and read off its figures of merit.

    Raises
    ------
    SimulationError
        If the run cannot be carried to the task's horizon.
    """
    trajectory = simulate(
        law, task.body, task.schedule, quaternion=task.quaternion, rate=task.rate_array,
        horizon=task.horizon, method=method,
    )  # fmt: skip
    figures = read_figures(
        trajectory, attitude=task.attitude_tolerance, rate=task.rate_tolerance, until_settled=True
    )
    return LawRun(label=label, law=law, task=task, trajectory=trajectory, figures=figures)
