"""Two laws simulated apart from the package, for records that tests make.

The equations of motion are typed again on purpose: an independent check, and the tests of the
pages must not wait for, or fail with, the simulator.
"""

from __future__ import annotations

from functools import cache
from typing import Any

import numpy as np
from numpy.typing import NDArray
from scipy.integrate import solve_ivp

Array = NDArray[np.float64]


J1 = np.array([[3.05, 0.14, 0.05], [0.14, 2.66, 0.12], [0.05, 0.12, 2.18]])


PERIOD, ON, T_ON, LAMBDA, HORIZON = 8.0, 0.01, 3.2, 0.525, 56.0


def gain(t: float) -> tuple[float, float]:
    """Cubic Hermite windows: g and g'."""
    s = t % PERIOD - ON
    up, down, end = T_ON / 4, 3 * T_ON / 4, T_ON
    if 0 <= s < up:
        x = s / up
        return x * x * (3 - 2 * x), 6 * x * (1 - x) / up
    if up <= s < down:
        return 1.0, 0.0
    if down <= s < end:
        x = (s - down) / (end - down)
        return 1 - x * x * (3 - 2 * x), -6 * x * (1 - x) / (end - down)
    return 0.0, 0.0


def closed_loop(t: float, x: Array, adaptive: bool, gamma: float) -> tuple[Array, dict[str, Any]]:
    """Right-hand side for x = (b0, bv, w, R, k), and the signals along the way."""
    b0, bv, w, R, k = x[0], x[1:4], x[4:7], x[7], x[8]
    g, gdot = gain(t)
    kappa = k if adaptive else 1 / R
    Rdot = -LAMBDA * R + g * g * (1 + b0)
    Omega = w + 2 * g * g * kappa * bv
    energy = Omega @ J1 @ Omega
    kdot = gamma * R * g * g * ((1 + b0) * energy + 2 * bv @ bv) if adaptive else 0.0
    kappadot = kdot if adaptive else -Rdot / R**2
    bvdot = 0.5 * (b0 * w + np.cross(bv, w))
    u = -2 * g * kappa * np.cross(bv, J1 @ w) - 4 * gdot * kappa * J1 @ bv - 2 * g * kappadot * J1 @ bv
    u = u - 2 * g * kappa * J1 @ bvdot - 0.5 * g * kappa * (1 + b0) * J1 @ Omega
    wdot = np.linalg.solve(J1, -np.cross(w, J1 @ w) + g * u)
    V = R * (2 * (1 - b0) + energy) + ((k - 1 / 0.1323) ** 2 / (2 * gamma) if adaptive else 0.0)
    signals = {"command": u, "torque": g * u, "gain": g, "Omega": Omega, "V": V}
    return np.concatenate([[-0.5 * bv @ w], bvdot, wdot, [Rdot, kdot]]), signals


@cache
def simulate(adaptive: bool, gamma: float = 0.1, step: float = 0.02) -> dict[str, Array]:
    """One run from rest, 120 deg about (1, 1, 1)."""
    start = np.concatenate([[0.5, 0.5, 0.5, 0.5], np.zeros(3), [1.0, 0.2]])
    t = np.linspace(0, HORIZON, round(HORIZON / step) + 1)
    solution = solve_ivp(
        lambda s, x: closed_loop(s, x, adaptive, gamma)[0],
        (0, HORIZON),
        start,
        t_eval=t,
        rtol=1e-8,
        atol=1e-10,
        max_step=0.1,
    )
    rows = [closed_loop(s, x, adaptive, gamma)[1] for s, x in zip(t, solution.y.T, strict=True)]
    out = {key: np.array([row[key] for row in rows]) for key in rows[0]}
    y = solution.y.T
    return out | {"time": t, "quaternion": y[:, :4], "rate": y[:, 4:7], "R": y[:, 7], "k": y[:, 8]}
