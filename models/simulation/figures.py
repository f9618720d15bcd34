"""What a run did, in one piece: settling, torque and the least filter state."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ..norms import MEASURED, Norm
from .metrics import Extremum, TorqueMetrics, filter_minimum, settling_time, torque_metrics
from .trajectory import Trajectory


@final
@dataclass(frozen=True)
class Figures:
    """Figures of merit of one run.

    Attributes
    ----------
    settling : settling time, s, or None if the run ends outside the tolerances
    torque : peaks and impulse over the part of the run that was asked about
    filter_minimum : least R over the run, or None for a law without a filter
    """

    settling: float | None
    torque: TorqueMetrics
    filter_minimum: Extremum | None


def read_figures(
    trajectory: Trajectory,
    *,
    attitude: Fraction,
    rate: Fraction,
    until_settled: bool = False,
    norms: Sequence[Norm] = MEASURED,
) -> Figures:
    """Read the figures off a run.

    Parameters
    ----------
    trajectory : Trajectory
        The run.
    attitude, rate : Fraction
        Tolerances on |bv| and on |w| (rad/s), Euclidean, within which it has settled.
    until_settled : bool
        Torque figures end at the settling time, where there is one, not at the horizon.
    norms : Sequence[Norm]
        In which the torque is measured.
    """
    settling = settling_time(trajectory, attitude=float(attitude), rate=float(rate))
    has_filter = "R" in trajectory.loop.controller_states
    return Figures(
        settling,
        torque_metrics(trajectory, settling if until_settled else None, norms),
        filter_minimum(trajectory) if has_filter else None,
    )
