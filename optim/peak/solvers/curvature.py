"""Second derivatives of the terminal condition, reduced to the few directions that matter.

The control acts through integrals, so the Lagrangian's curvature is a smooth kernel: a handful
of its eigenvectors carry it. They are found on controls grouped to at most `GROUPS` pieces, and
only the positive ones are kept, so that the convex program stays convex. An approximation
here costs iterations, never correctness: it is used for steps, not for any check.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import lru_cache
from typing import Any, final

import numpy as np
from numpy.typing import NDArray

from ....models.types import Array
from ..transcription.propagate import right_hand_side
from ..transcription.shooting import Rollout, Sensitivity, Shooting

GROUPS = 40
"""Pieces the controls are grouped into."""
RANK = 24
"""Directions kept at most."""


@final
@dataclass(frozen=True)
class Curvature:
    """(1/2) sum_i values_i (rows_i . (v - v0))^2, values > 0, about a control v0; rows (r, n m)."""

    rows: Array
    values: Array


def lagrangian_curvature(
    shooting: Shooting,
    trajectory: Rollout,
    sensitivity: Sensitivity,
    multiplier: Array,
    size: float,
) -> Curvature:
    """Curvature of multiplier . residual by the controls, controls measured in `size`."""
    mesh, lever = shooting.mesh, shooting.scaled.control_matrix * size
    group, mass = _groups(shooting)
    m, d = lever.shape[1], lever.shape[1] * len(mass)
    inputs = np.zeros((mesh.size, 3, d))
    for index, g in zip(np.flatnonzero(mesh.open), group, strict=True):
        inputs[index, :, m * g : m * g + m] = lever / np.sqrt(mass[g])
    stacked = np.empty((mesh.size, 10, d))
    reach = np.zeros((7, d))
    for k in range(mesh.size):
        stacked[k, :7], stacked[k, 7:] = reach, inputs[k]
        reach = sensitivity.steps[k] @ reach + sensitivity.inputs[k] @ inputs[k]
    costate = np.einsum("i,kij->kj", multiplier, sensitivity.adjoint[1:])
    hessian = shooting.propagator.map_with_body(
        _step_hessian(mesh.profile.shape[1] - 1), trajectory.states[:-1].T, trajectory.torque.T, costate.T
    )
    cells = hessian.reshape(10, mesh.size, 10).transpose(1, 0, 2)
    flat = stacked.reshape(-1, d)
    reduced = flat.T @ np.matmul(cells, stacked).reshape(-1, d)
    if not np.isfinite(reduced).all():
        return Curvature(np.zeros((0, shooting.cells * m)), np.zeros(0))
    values, vectors = np.linalg.eigh((reduced + reduced.T) / 2)
    keep = np.flatnonzero(values > max(1e-4 * float(np.abs(values).max(initial=0.0)), 1e-12))[-RANK:]
    rows = np.zeros((len(keep), shooting.cells, m))
    for cell, g in enumerate(group):
        share = shooting.weights[cell] / np.sqrt(mass[g])
        rows[:, cell] = share * vectors[m * g : m * g + m, keep].T
    return Curvature(rows.reshape(len(keep), shooting.cells * m), values[keep])


def _groups(shooting: Shooting) -> tuple[NDArray[np.int64], Array]:
    """Group of each open cell (neighbours of one window, about equal weights), and each group's weight."""
    used = np.cumsum(shooting.weights) - shooting.weights / 2
    target = np.minimum((used * GROUPS).astype(np.int64), GROUPS - 1)
    cells = np.flatnonzero(shooting.mesh.open)
    breaks = np.r_[True, (np.diff(target) > 0) | (np.diff(cells) > 1)]
    group = np.cumsum(breaks) - 1
    return group.astype(np.int64), np.bincount(group, weights=shooting.weights).astype(float)


@lru_cache(maxsize=8)
def _step_hessian(degree: int) -> Any:
    """Second derivative of costate . step by (state, torque), (10, 10), at fourth order."""
    import casadi as ca

    x, torque, costate = ca.SX.sym("x", 7), ca.SX.sym("torque", 3), ca.SX.sym("costate", 7)
    h, w = ca.SX.sym("h"), ca.SX.sym("w", degree + 1)
    J, J_inverse = ca.SX.sym("J", 3, 3), ca.SX.sym("Ji", 3, 3)

    def rate(s: float, state: Any) -> Any:
        gain = sum(w[i] * s**i for i in range(degree + 1))
        return right_hand_side(J, J_inverse, state, gain * torque)

    k1 = rate(0.0, x)
    k2 = rate(0.5, x + h / 2 * k1)
    k3 = rate(0.5, x + h / 2 * k2)
    k4 = rate(1.0, x + h * k3)
    end = x + h / 6 * (k1 + 2 * k2 + 2 * k3 + k4)
    hessian, _ = ca.hessian(ca.dot(costate, end), ca.vertcat(x, torque))
    return ca.Function("bend", [x, torque, costate, h, w, J, J_inverse], [ca.densify(hessian)])
