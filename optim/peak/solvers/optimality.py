"""Optimality as one number: the duality gap of the problem linearised about the answer.

For any multiplier y of the terminal residual r (with derivative G), normalised so that
sum_k support(-G_k' y) = 1, the linearised problem cannot do better than

    dual(y) = y . (r - G v) - tolerance . |y|.

(peak - dual) / peak is therefore >= 0 at a feasible control, and zero exactly when the
conditions of Karush, Kuhn and Tucker hold: stationarity and complementarity in one residual,
computed from the answer alone, outside any solver.
"""

from __future__ import annotations

import numpy as np

from ....models.types import Array
from ..transcription.shooting import Rollout, Sensitivity, Shooting


def dual_value(
    shooting: Shooting, trajectory: Rollout, sensitivity: Sensitivity, multiplier: Array
) -> tuple[float, Array]:
    """Lower bound of the linearised problem from a multiplier, and that multiplier normalised."""
    norm = shooting.scaled.problem.norm
    costate = -np.einsum("i,ikm->km", multiplier, sensitivity.terminal)
    total = float(norm.control_support(costate).sum())
    if total <= 0.0:
        return 0.0, np.zeros(6)
    y = multiplier / total
    return linearised_offset(shooting, trajectory, sensitivity, y), y


def linearised_offset(
    shooting: Shooting, trajectory: Rollout, sensitivity: Sensitivity, multiplier: Array
) -> float:
    """Return y . (r - G v) - tolerance . |y|: what a multiplier makes of the terminal rows alone."""
    offset = trajectory.residual - np.einsum("ikm,km->i", sensitivity.terminal, trajectory.control)
    value = float(multiplier @ offset)
    for block, tolerance in enumerate(shooting.tolerances):
        value -= tolerance * float(np.linalg.norm(multiplier[3 * block : 3 * block + 3]))
    return value
