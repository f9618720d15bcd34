"""What a law did on a transfer: settling, peaks, impulse, least filter state, from one accurate run."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.laws import Law
from ...models.mission import Mission
from ...models.norms import Norm
from ...models.simulation import (
    DOP853,
    Figures,
    Trajectory,
    peak_commanded_torque,
    peak_torque,
    read_mission_figures,
    simulate_mission,
)


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
    """One law on a mission; torque figures are over [0, settling], or the whole run if it never settles."""

    label: str
    law: Law
    mission: Mission
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
        """Within the mission's tolerances by the settling time; None if it never settles or starts there."""
        settling = self.figures.settling
        if settling is None or settling <= 0:
            return None
        return Goal(Fraction(settling), self.mission.tolerance.attitude, self.mission.tolerance.rate)

    @property
    def end_goal(self) -> Goal | None:
        """As near as it came by its horizon; None if its start is as near.

        The balls are wider by a millionth, so that the law's own torque, rounded, reaches them.
        """
        attitude, rate = (Fraction(x) * (1 + WIDER) for x in self.end)
        begin = self.mission.start
        start = float(np.linalg.norm(begin.quaternion[1:])), float(np.linalg.norm(begin.rate))
        if attitude >= 1 or (start[0] <= attitude and start[1] <= rate):
            return None
        return Goal(self.mission.horizon, attitude, rate)


WIDER = Fraction(1, 10**6)
"""By how much the balls that a law's end is put into are wider than it."""
ACCURATE = DOP853(rtol=1e-11, atol=1e-13)
"""Every reported number comes from a run at this setting: relative error below 1e-10."""


def run_law(label: str, law: Law, mission: Mission, *, method: DOP853 = ACCURATE) -> LawRun:
    """Simulate a law on a mission and read off its figures of merit.

    Raises
    ------
    SimulationError
        If the run cannot be carried to the mission's horizon.
    """
    trajectory = simulate_mission(law, mission, method=method)
    figures = read_mission_figures(trajectory, mission, until_settled=True)
    return LawRun(label=label, law=law, mission=mission, trajectory=trajectory, figures=figures)
