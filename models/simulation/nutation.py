"""A free body over many turns: its rate is periodic, its attitude advances by one rotation a period.

With q' = q (0, w)/2 and w(t + T) = w(t), q(t + T) = p q(t) for a fixed p = q(T) q(0)^-1: one period is
integrated, and every later instant costs a power of p. The period is that of Euler's equations in elliptic
functions (Landau and Lifshitz, Mechanics, section 37).
"""

from __future__ import annotations

from collections.abc import Callable

import numpy as np

from ..types import Array

FEW_TURNS = 20
"""Coasts of up to so many turns are integrated as they are."""
FEW_PERIODS = 4
"""So are those of up to so many periods of the rate."""
CLOSED = 1e-10
"""Largest |w(T) - w(0)| / |w(0)| of a period that counts as one."""
LAST_TURNS = 2
"""Turns at a coast's end of which steps are kept: what is last outside a tolerance is seen there."""


def rate_period(inertia: Array, rate: Array) -> float:
    """Period of the body rate without torque, s; inf where there is none (on the separatrix).

    Parameters
    ----------
    inertia : Array
        (3, 3), kg m^2.
    rate : Array
        (3,), rad/s, not zero.
    """
    from scipy.special import ellipk

    momentum = inertia @ rate
    if np.linalg.norm(np.cross(rate, momentum)) <= 1e-14 * np.linalg.norm(rate) * np.linalg.norm(momentum):
        return float(2 * np.pi / np.linalg.norm(rate))
    I1, I2, I3 = np.linalg.eigvalsh(inertia)
    energy, square = float(rate @ momentum), float(momentum @ momentum)  # 2 E and L^2
    if square < energy * I2:
        I1, I3 = I3, I1
    speed = (I3 - I2) * (square - energy * I1) / (I1 * I2 * I3)
    with np.errstate(all="ignore"):
        modulus = (I2 - I1) * (energy * I3 - square) / ((I3 - I2) * (square - energy * I1))
    if not (speed > 0 and 0 <= modulus < 1):
        return float("inf")
    return float(4 * ellipk(modulus) / np.sqrt(speed))


def turns(rate: Array, length: float) -> float:
    """Turns within a coast of `length` s."""
    return float(np.linalg.norm(rate)) * length / (2 * np.pi)


def is_repetitive(rate: Array, period: float, length: float) -> bool:
    """Whether a coast is long enough to be carried period by period."""
    return turns(rate, length) > FEW_TURNS and length > FEW_PERIODS * period


def closes(before: Array, after: Array) -> bool:
    """Whether a body's states (7,) a period apart have one rate."""
    return bool(np.linalg.norm(after[4:] - before[4:]) <= CLOSED * np.linalg.norm(before[4:]))


def repeated(
    dense: Callable[[Array], Array], before: Array, after: Array, period: float
) -> Callable[[Array], Array]:
    """Continue a dense output over one period, s -> (7, len), to any later time."""
    advance = _product(after[:4], _conjugate(before[:4]))
    axis, half = advance[1:], np.arctan2(np.linalg.norm(advance[1:]), advance[0])
    size = np.linalg.norm(axis)
    axis = axis / size if size > 0 else axis

    def at(s: Array) -> Array:
        times = np.atleast_1d(np.asarray(s, dtype=float))
        number = np.maximum(np.floor(times / period), 0.0)
        states = dense(times - number * period)
        power = np.vstack([np.cos(number * half), np.sin(number * half) * axis[:, None]])
        return np.vstack([_product(power, states[:4]), states[4:]])

    return at


def kept_times(steps: Array, period: float, rate: Array, length: float) -> Array:
    """Steps of the first period, and the same steps in the last periods, which hold the last turns."""
    last = int(np.ceil(LAST_TURNS * 2 * np.pi / (np.linalg.norm(rate) * period)))
    count = int(length // period)
    tail = [steps + n * period for n in range(max(count - last, 1), count + 1)]
    times = np.unique(np.concatenate([steps, *tail]))
    return np.append(times[times < length], length)


def _conjugate(q: Array) -> Array:
    return np.concatenate([q[:1], -q[1:]])


def _product(p: Array, q: Array) -> Array:
    """Quaternion product, scalar first, (4,) or (4, m)."""
    vector = p[0] * q[1:] + q[0] * p[1:] + np.cross(p[1:], q[1:], axis=0)
    return np.concatenate([(p[0] * q[0] - np.sum(p[1:] * q[1:], axis=0))[None], vector])
