"""The terminal residual: rotation vector and rate left at the end, and its derivative.

The rotation vector of sign * q runs up to length 2 pi, so that the target can be approached from
either quaternion sign; it is zero, with a regular derivative, exactly at the target.
"""

from __future__ import annotations

import math

import numpy as np

from ....models.types import Array


def residual(state: Array, sign: int) -> Array:
    """Rotation vector from the target (3, rad) and rate (3), for the target quaternion `sign`."""
    return np.concatenate([_factor(state, sign) * state[1:4], state[4:7]])


def _factor(state: Array, sign: int) -> float:
    length = float(np.linalg.norm(state[1:4]))
    if length < 1e-9:
        return 2.0 * sign if sign * state[0] > 0 else math.pi * sign / max(length, 1e-300)
    return sign * 2.0 * math.atan2(length, sign * float(state[0])) / length


def residual_derivative(state: Array, sign: int) -> Array:
    """Derivative of the residual by the state, (6, 7)."""
    scalar, vector = sign * float(state[0]), sign * state[1:4]
    length, square = float(np.linalg.norm(vector)), float(state[:4] @ state[:4])
    factor = abs(_factor(state, sign))
    # slope = (d factor / d length) / length, by its series where the quotient would cancel
    small = length < 1e-4 and scalar > 0
    slope = -4.0 / 3.0 / scalar**3 if small else (2.0 * scalar / square - factor) / length**2
    E = np.zeros((6, 7))
    E[:3, 0] = -2.0 * sign * vector / square
    E[:3, 1:4] = sign * (factor * np.eye(3) + slope * np.outer(vector, vector))
    E[3:, 4:7] = np.eye(3)
    return E
