"""Where to start: the eigenaxis bang-bang from rest, a brake for a tumbling body, then random bends.

A start is a control; nothing is claimed about it. Bends are smooth random functions of the
window time used so far, so that different starts lead around different sides of a trap.
"""

from __future__ import annotations

import numpy as np

from ....models.types import Array
from ..transcription.history import TorqueHistory
from ..transcription.mesh import Mesh
from ..transcription.propagate import Propagator
from ..transcription.shooting import Shooting
from ..transcription.terminal import residual


def first_guess(shooting: Shooting) -> Array:
    """Eigenaxis bang-bang from rest; braking along the momentum when tumbling; (n open cells, m)."""
    torque = _eigenaxis(shooting) if shooting.scaled.problem.starts_at_rest else _brake(shooting)
    return _as_control(shooting, torque[shooting.mesh.open])


def bend(shooting: Shooting, control: Array, rng: np.random.Generator, size: float) -> Array:
    """Add a smooth random torque of about `size` times the guess's own peak."""
    used = np.cumsum(shooting.weights) - shooting.weights / 2
    basis = np.polynomial.legendre.legvander(2 * used - 1, 3)
    level = size * max(float(np.abs(control).max()), 1e-3)
    extra = basis @ rng.normal(size=(4, 3)) * level * float(np.abs(shooting.scaled.control_matrix).max())
    return control + _as_control(shooting, extra)


def control_at(history: TorqueHistory, mesh: Mesh, time: float) -> Array:
    """Control of another history at the same instants, on the open cells (its own units)."""
    middle = ((mesh.edges[1:] + mesh.edges[:-1]) / 2)[mesh.open] * time
    cell = np.clip(np.searchsorted(history.edges, middle, side="right") - 1, 0, len(history.control) - 1)
    return np.asarray(history.control[cell])


def _eigenaxis(shooting: Shooting) -> Array:
    """Speed up about the rotation vector over half of the window time, slow down over the rest."""
    error = residual(shooting.scaled.start, shooting.sign)[:3]
    impulse = shooting.mesh.impulse
    used = np.concatenate([[0.0], np.cumsum(impulse)])
    total = used[-1]
    value = _cell_mean_sign(used, total)
    rate = np.concatenate([[0.0], np.cumsum(value * impulse)])
    travel = float(((rate[1:] + rate[:-1]) / 2 * shooting.mesh.lengths).sum())
    amplitude = -(shooting.scaled.inertia @ error) / travel
    return value[:, None] * amplitude


def _cell_mean_sign(used: Array, total: float) -> Array:
    """Mean of +1 before half of the window time and -1 after it, over each cell."""
    half = total / 2
    first = np.clip(half - used[:-1], 0.0, np.diff(used))
    width = np.where(np.diff(used) > 0, np.diff(used), 1.0)
    return np.asarray(np.where(np.diff(used) > 0, 2.0 * first / width - 1.0, 0.0))


def _brake(shooting: Shooting) -> Array:
    """Oppose the momentum with a steady share of it, so that it is used up at the last window's end."""
    scaled, mesh = shooting.scaled, shooting.mesh
    start, total = float(np.linalg.norm(scaled.momentum)), float(mesh.impulse.sum())
    torque = np.zeros((mesh.size, 3))
    steps = Propagator(scaled, mesh)
    for _ in range(3):
        states = steps.states(torque)
        middle = (states[1:, 4:] + states[:-1, 4:]) / 2 @ scaled.inertia
        size = np.linalg.norm(middle, axis=1, keepdims=True)
        torque = np.where(mesh.open[:, None], -middle / np.maximum(size, 0.05 * start) * start / total, 0.0)
    return torque


def _as_control(shooting: Shooting, torque: Array) -> Array:
    """Controls that make the torques, as nearly as one-sided thrusters can."""
    B = shooting.scaled.control_matrix
    if B.shape == (3, 3) and np.array_equal(B, np.eye(3)):
        return torque
    return np.maximum(torque @ np.linalg.pinv(B).T, 0.0)
