"""What is asked about the floor of one law."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import casadi as ca

from ...models.closed_loop import close_loop
from ...models.laws import Law
from ...models.lowering import FIELD, UnknownOperationError, evaluate, walk
from ...models.mission import Mission
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
    law, mission : the closed loop and what it is to do, on a body that the controller knows (`uncertainty` is
        not asked about)
    run_floor : least R of the scenario's own run and that run's horizon, s, or None
    run_peak : largest applied torque of that run in the norm of the mission's limit, or None
    horizon : end of the time asked about where the table is finite, s; None is the table's
        end, or its 400th window
    search : how hard to look for the worst start; None skips the search
    options : how hard to certify
    """

    law: Law
    mission: Mission
    run_floor: tuple[float, float] | None = None
    run_peak: float | None = None
    horizon: Fraction | None = None
    search: Search | None = None
    options: FloorOptions | None = None

    @property
    def bounds(self) -> BodyBounds:
        """Bounds of the principal inertias, the tolerance included."""
        bounds, tolerance = BodyBounds.of(self.mission.body), self.mission.inertia_tolerance
        return bounds if tolerance is None else bounds.widened(tolerance)

    @property
    def initial(self) -> InitialSet:
        """The initial set in the comparison system's variables."""
        starts = self.mission.starts
        return InitialSet.from_bounds(
            self.bounds,
            max_angle_deg=starts.max_angle_deg,
            max_rate=starts.max_rate,
            max_weighted_rate=starts.max_weighted_rate,
            gain_term=initial_gain_term(self.law, self.mission.schedule),
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
