"""A mission flown by a law, and the figures read off the run by the mission's own measures."""

from __future__ import annotations

from numpy.typing import ArrayLike

from ..closed_loop import Saturation
from ..laws import Law
from ..mission import Mission
from ..norms import MEASURED
from .figures import Figures, read_figures
from .integrate import DOP853, simulate
from .trajectory import Trajectory


def simulate_mission(
    law: Law,
    mission: Mission,
    *,
    controller: ArrayLike | None = None,
    saturate: bool = False,
    method: DOP853 | None = None,
) -> Trajectory:
    """Simulate a law from the mission's start to its horizon, on the body that the controller believes in.

    Parameters
    ----------
    law, mission : Law, Mission
        What is simulated.
    controller : ArrayLike, optional
        (m,) controller states at the start; by default the law's own initial values.
    saturate : bool
        Hold the torque within the mission's limit, if it has one; no claim covers such a run.
    method : DOP853, optional
        Integrator and its tolerances.

    Raises
    ------
    SimulationError
        If the run cannot be carried to the horizon.
    """
    limit = mission.limit
    return simulate(
        law,
        mission.body,
        mission.schedule,
        quaternion=mission.start.quaternion,
        rate=mission.start.rate,
        horizon=mission.horizon,
        controller=controller,
        saturation=Saturation(limit.torque, limit.norm) if saturate and limit is not None else None,
        method=method,
    )


def read_mission_figures(trajectory: Trajectory, mission: Mission, *, until_settled: bool = False) -> Figures:
    """Read the figures off a run: settled as the mission says, torques in its limit's norm too.

    Parameters
    ----------
    trajectory, mission : Trajectory, Mission
        The run, and what it was to do.
    until_settled : bool
        Torque figures end at the settling time, where there is one, not at the horizon.
    """
    settled, own = mission.tolerance, () if mission.limit is None else (mission.limit.norm,)
    return read_figures(
        trajectory,
        attitude=settled.attitude,
        rate=settled.rate,
        until_settled=until_settled,
        norms=tuple(dict.fromkeys((*MEASURED, *own))),
    )
