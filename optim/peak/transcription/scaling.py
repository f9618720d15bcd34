"""Units in which every transfer looks alike: transfer time 1, mean inertia 1, peak near 1.

Least peaks obey p(c J) = c p(J) and p(s t) = p(t) / s^2 exactly, so solving in these units loses
nothing and makes one set of solver tolerances fit satellites of every size.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import numpy as np

from ....models.types import Array
from ...problem import TransferProblem


@final
@dataclass(frozen=True)
class Units:
    """Size of one solver unit: s, kg m^2 and (for controls) the norm's unit, N m or N."""

    time: float
    inertia: float
    control: float

    @property
    def torque(self) -> float:
        """One solver unit of torque, N m: inertia / time^2."""
        return self.inertia / self.time**2


@final
@dataclass(frozen=True)
class ScaledProblem:
    """A transfer in solver units: horizon 1, inertia of mean 1.

    Attributes
    ----------
    inertia, inverse_inertia : (3, 3)
    start : (7,)
        Quaternion and rate.
    control_matrix : (3, m)
        Torque in solver units for one unit of each control.
    """

    problem: TransferProblem
    units: Units
    inertia: Array
    inverse_inertia: Array
    start: Array
    control_matrix: Array
    attitude_tolerance: float
    rate_tolerance: float

    @property
    def momentum(self) -> Array:
        """J w at the start, (3,), solver units."""
        return np.asarray(self.inertia @ self.start[4:])


def scale(problem: TransferProblem) -> ScaledProblem:
    """Express a transfer in solver units.

    The attitude tolerance on |bv| = sin(Phi/2) becomes one on the rotation vector's length,
    Phi <= 2 asin(tolerance), which is the same set.
    """
    time = float(problem.horizon)
    inertia = float(np.trace(problem.body.inertia)) / 3.0
    torque = inertia / time**2
    B = problem.norm.control_matrix
    lever = float(np.abs(B).max())
    units = Units(time=time, inertia=inertia, control=torque / lever)
    return ScaledProblem(
        problem=problem,
        units=units,
        inertia=problem.body.inertia / inertia,
        inverse_inertia=problem.body.inverse_inertia * inertia,
        start=np.r_[problem.unit_attitude, problem.start_rate * time],
        control_matrix=B / lever,
        attitude_tolerance=2.0 * float(np.arcsin(float(problem.terminal.attitude))),
        rate_tolerance=float(problem.terminal.rate) * time,
    )
