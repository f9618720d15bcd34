"""What is asked about the floor of one law."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import casadi as ca

from ...models.closed_loop import close_loop
from ...models.laws import Law
from ...models.lowering import FIELD, UnknownOperationError, evaluate, walk
from ...models.norms import LARGEST_COMPONENT, Norm
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from .certify import FloorOptions
from .comparison import BodyBounds
from .sets import InitialSet
from .worst_found import Search


@final
@dataclass(frozen=True, kw_only=True)
class FloorQuestion:
    """What is asked about one law.

    Attributes
    ----------
    law, body, schedule : the closed loop
    inertia_tolerance : largest deviation of each entry of J, kg m^2, or None
    max_angle_deg : bound on 2 acos(b0), deg, of the initial set
    max_rate, max_weighted_rate : bounds on |w(0)| (rad/s) and |Omega(0)|_J; both None is at rest
    attitude, rate : tolerances on |bv| and |w| (rad/s) for the settling time
    torque_limit, torque_norm : limit on the applied torque, N m, or None
    run_floor : least R of the scenario's own run and that run's horizon, s, or None
    run_peak : largest applied torque of that run in `torque_norm`, N m, or None
    horizon : end of the time asked about where the table is finite, s; None is the table's
        end, or its 400th window
    search : how hard to look for the worst start; None skips the search
    options : how hard to certify
    """

    law: Law
    body: RigidBody
    schedule: Schedule
    max_angle_deg: Fraction
    max_rate: Fraction | None = None
    max_weighted_rate: Fraction | None = None
    inertia_tolerance: tuple[tuple[Fraction, ...], ...] | None = None
    attitude: Fraction = Fraction(1, 100)
    rate: Fraction = Fraction(1, 100)
    torque_limit: Fraction | None = None
    torque_norm: Norm = LARGEST_COMPONENT
    run_floor: tuple[float, float] | None = None
    run_peak: float | None = None
    horizon: Fraction | None = None
    search: Search | None = None
    options: FloorOptions | None = None

    @property
    def bounds(self) -> BodyBounds:
        """Bounds of the principal inertias, the tolerance included."""
        bounds = BodyBounds.of(self.body)
        return bounds if self.inertia_tolerance is None else bounds.widened(self.inertia_tolerance)

    @property
    def initial(self) -> InitialSet:
        """The initial set in the comparison system's variables."""
        return InitialSet.from_bounds(
            self.bounds,
            max_angle_deg=self.max_angle_deg,
            max_rate=self.max_rate,
            max_weighted_rate=self.max_weighted_rate,
            gain_term=initial_gain_term(self.law, self.schedule),
        )


def initial_gain_term(law: Law, schedule: Schedule) -> Fraction:
    """g(0)^2 kappa(0), 1/s, exact, of a law with Omega = w + 2 g^2 kappa bv; zero for others."""
    piece = next(schedule.profile.pieces)
    g = piece.shape[0] if piece.shape else Fraction(0)
    return g * g * initial_gain(law) if g else Fraction(0)


def initial_gain(law: Law) -> Fraction:
    """kappa(0), 1/s, where the law states a gain of its own states and parameters alone; else zero."""
    loop = close_loop(law)
    gain = loop.control.gain
    if gain is None or ca.depends_on(ca.SX(gain), ca.vertcat(loop.state[:7], loop.time, loop.body)):
        return Fraction(0)
    states = [Fraction(0)] * 7 + [state.initial for state in law.controller_states]
    parameters = [Fraction(value) for value in law.parameters.values()]
    rest = [[Fraction(0)] * loop.time.numel(), parameters, [Fraction(0)] * loop.body.numel()]
    try:
        ((value,),) = evaluate(walk(loop.function("gain", ca.SX(gain))), FIELD, [states, *rest], Fraction)
    except (UnknownOperationError, ArithmeticError):
        return Fraction(0)
    return value
