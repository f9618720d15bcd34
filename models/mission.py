"""What is to be done with a spacecraft: one object that proofs, optima and simulations are asked about.

A law is paired with a mission, it is not part of it: the same mission is put to every law, and to every
controller whatever. Attitudes are errors from the target, so that the target is the identity.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from .norms import LARGEST_COMPONENT, Norm
from .rigid_body import ExactMatrix, RigidBody
from .schedule import Schedule
from .types import Array
from .uncertainty import NOMINAL, Uncertainty

ANGLE_ALLOWANCE = Fraction(1, 10**9)
"""Added to a float angle, deg, so that the set certainly holds the state (rounding is 1e-13)."""


@final
@dataclass(frozen=True)
class InitialState:
    """The state at t = 0.

    Attributes
    ----------
    attitude : error quaternion from the target, scalar first, unit, (4,)
    exact_rate : body rate, rad/s, exact, (3,)
    representative : whether it was chosen on the edge of the initial set, not given by the user
    """

    attitude: tuple[float, float, float, float]
    exact_rate: tuple[Fraction, Fraction, Fraction]
    representative: bool = False

    @property
    def quaternion(self) -> Array:
        """The error quaternion as an array, scalar first, (4,)."""
        return np.array(self.attitude)

    @property
    def exact_quaternion(self) -> tuple[Fraction, Fraction, Fraction, Fraction]:
        """The error quaternion at its exact binary values, of length 1 within rounding."""
        q = self.attitude
        return Fraction(q[0]), Fraction(q[1]), Fraction(q[2]), Fraction(q[3])

    @property
    def rate(self) -> Array:
        """Body rate, rad/s, (3,)."""
        return np.array([float(x) for x in self.exact_rate])

    @property
    def angle_deg(self) -> float:
        """Error angle 2 acos b0 in [0, 360], deg (over 180 it unwinds the long way)."""
        return math.degrees(2 * math.atan2(math.hypot(*self.attitude[1:]), self.attitude[0]))


@final
@dataclass(frozen=True)
class InitialSet:
    """All states with error angle <= `max_angle_deg` (2 acos b0, deg) and a bounded rate.

    Attributes
    ----------
    max_rate : bound on |w|, rad/s, or None
    max_weighted_rate : bound on sqrt(Omega' J Omega), sqrt(kg m^2)/s, or None
        Where both are None the set is at rest; where both are given, both hold.
    from_state : whether it was derived from the initial state, which it then certainly holds
    """

    max_angle_deg: Fraction
    max_rate: Fraction | None = None
    max_weighted_rate: Fraction | None = None
    from_state: bool = False

    @classmethod
    def around(cls, state: InitialState) -> InitialSet:
        """The states no farther from rest at the target than the given one, which is certainly among them."""
        square = sum((x * x for x in state.exact_rate), Fraction(0))
        rate = Fraction(0)
        if square:
            rate = Fraction(math.nextafter(math.sqrt(square), math.inf))
            while rate * rate < square:
                rate = Fraction(math.nextafter(float(rate), math.inf))
        angle = min(Fraction(state.angle_deg) + ANGLE_ALLOWANCE, Fraction(360))
        return cls(angle, rate, None, from_state=True)

    @property
    def representative(self) -> InitialState:
        """The state of the largest angle, about (1, 1, 1), at rest."""
        half = math.radians(float(self.max_angle_deg)) / 2
        v, zero = math.sin(half) / math.sqrt(3), Fraction(0)
        return InitialState((math.cos(half), v, v, v), (zero, zero, zero), representative=True)


@final
@dataclass(frozen=True)
class Tolerance:
    """Settled means |bv| <= `attitude` and |w| <= `rate` (rad/s), Euclidean, for good; both > 0."""

    attitude: Fraction = Fraction(1, 100)
    rate: Fraction = Fraction(1, 100)


@final
@dataclass(frozen=True)
class TorqueLimit:
    """A limit that the applied torque must not exceed in a norm, in the norm's unit."""

    torque: Fraction
    norm: Norm = LARGEST_COMPONENT


@final
@dataclass(frozen=True, kw_only=True)
class Mission:
    """Everything but the law.

    Attributes
    ----------
    body : the rigid body that the controller believes in, exact inertia
    inertia_tolerance : (3, 3), largest deviation of each entry, kg m^2, of a body whose inertia the
        controller knows but the proof does not, or None
    uncertainty : what the controller does not know of the body, of the thrusters and of what else pushes
    schedule : when thrusters work, and the gain g
    start : the state a run starts from
    starts : the set of states that proofs speak about
    tolerance : what counts as settled
    limit : on the applied torque, or None
    horizon : end of a run, s
    """

    body: RigidBody
    schedule: Schedule
    start: InitialState
    starts: InitialSet
    horizon: Fraction
    tolerance: Tolerance = Tolerance()
    limit: TorqueLimit | None = None
    inertia_tolerance: ExactMatrix | None = None
    uncertainty: Uncertainty = NOMINAL
