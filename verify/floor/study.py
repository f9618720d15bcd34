"""One call for a check: certify the floor and everything that follows from it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.laws import Law
from ...models.rigid_body import RigidBody
from ...models.schedule import Schedule
from ..convergence import Convergence, analyse_convergence
from ..verdict import Claim
from .certificate import floor_certificate
from .certify import LARGEST_PERIOD, Floor, FloorOptions, certify_floor
from .claims import FloorFacts, convergence_claim, floor_claim, reaches_far_enough, torque_claim
from .comparison import BodyBounds
from .converged import ConvergedFilter, ConvergedFloor
from .sets import InitialSet
from .torque_bound import TorqueBound, torque_bound
from .worst_found import Search, WorstFound, find_worst

SEARCH_PERIODS = 3
"""Periods simulated when looking for the worst start: the least R is seen early."""


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
        end, or its 100th window
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
    torque_norm: str = "component"
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


@final
@dataclass(frozen=True)
class FloorAnswer:
    """Everything that was found; None where it does not apply.

    Attributes
    ----------
    claims : "filter.floor", "convergence" and, if a limit was given, "torque.limit"
    """

    claims: tuple[Claim, ...]
    floor: Floor | None
    converged: ConvergedFloor | None
    worst: WorstFound | None
    torque: TorqueBound | None
    convergence: Convergence | None


def answer(question: FloorQuestion) -> FloorAnswer:
    """Answer a question about the floor of R."""
    q = question
    horizon = None
    if q.schedule.period is None:
        last = q.schedule.windows[:LARGEST_PERIOD][-1].off
        horizon = min(q.horizon, q.schedule.end) if q.horizon is not None else min(last, q.schedule.end)
    floor = certify_floor(q.law, q.bounds, q.schedule, q.initial, horizon=horizon, options=q.options)
    decay = q.law.parameters.get("lambda")
    has_filter = any(s.name == "R" for s in q.law.controller_states)
    converged = None
    short = q.schedule.period is not None and len(q.schedule.windows) <= LARGEST_PERIOD
    if short and has_filter and decay is not None and decay > 0:
        converged = ConvergedFilter(q.schedule, decay).floor()
    worst = None
    if q.search is not None and has_filter:
        worst = find_worst(
            q.law, q.body, q.schedule, q.initial,
            horizon=_search_horizon(q.schedule), max_rate=q.max_rate, search=q.search,
        )  # fmt: skip
    torque = found = None
    if floor is not None and floor.steps:
        torque = torque_bound(floor)
        found = analyse_convergence(floor, attitude=float(q.attitude), rate=float(q.rate))
    certificate = None
    if floor is not None and reaches_far_enough(floor):
        certificate = floor_certificate(q, floor, convergence=found, torque=torque)
    facts = FloorFacts(
        law_name=q.law.name,
        floor=floor,
        converged=converged,
        along_run=q.run_floor,
        worst=worst,
        certificate=certificate,
    )
    claims = [floor_claim(facts), convergence_claim(facts, found, float(q.attitude), float(q.rate))]
    if q.torque_limit is not None:
        claims.append(torque_claim(facts, torque, q.torque_limit, q.torque_norm, q.run_peak))
    return FloorAnswer(tuple(claims), floor, converged, worst, torque, found)


def initial_gain_term(law: Law, schedule: Schedule) -> Fraction:
    """g(0)^2 kappa(0), 1/s, exact: 1/R(0) or k(0) for the laws of the family, zero for others."""
    piece = next(schedule.profile.pieces)
    g = piece.shape[0] if piece.shape else Fraction(0)
    states = {s.name: s.initial for s in law.controller_states}
    if "k" in states:
        return g * g * states["k"]
    return g * g / states["R"] if states.get("R", Fraction(0)) > 0 else Fraction(0)


def _search_horizon(schedule: Schedule) -> Fraction:
    """Three periods, or the end of a finite table's third window cycle."""
    if schedule.period is not None and len(schedule.windows) == 1:
        return SEARCH_PERIODS * schedule.period
    later = [w.on for w in schedule.windows[SEARCH_PERIODS : SEARCH_PERIODS + 1]]
    return later[0] if later else schedule.end
