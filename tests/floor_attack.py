"""Random scenarios for the floor certificate, and an adversary that simulates against it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction as F

import missions
import numpy as np
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.ensemble import MetricOptions, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.norms import EUCLIDEAN
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Ramps, Window, build_schedule
from intermit.verify.filter.answer import FloorAnswer, answer
from intermit.verify.filter.certify import FloorOptions
from intermit.verify.filter.claims import reaches_far_enough
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.over_time import BoundsOverTime, bounds_over_time
from intermit.verify.filter.question import FloorQuestion
from intermit.verify.filter.worst_found import _Shape

TOLERANCE = 1e-7
"""Relative allowance for the simulation's own error (it keeps 1e-9)."""


def decimal(value: float, digits: int = 4) -> F:
    return F(f"{value:.{digits}g}")


def random_question(seed: int) -> FloorQuestion:
    """Inertia, schedule, lambda, initial set and law, drawn so that the laws have work to do."""
    rng = np.random.default_rng(seed)
    J = random_inertia(rng)
    body = RigidBody.from_rows(J)
    period = decimal(rng.uniform(4, 14))
    duty = decimal(rng.uniform(0.25, 0.6), 3)
    windows = [Window(F(0), period * duty)]
    if rng.random() < 0.3:  # two unequal windows a period
        half = period / 2
        windows = [Window(F(0), half * duty), Window(half, half + half * duty * F(2, 3))]
    shape = Hermite() if rng.random() < 0.5 else Ramps(windows[-1].length / 5, windows[-1].length / 8)
    schedule = build_schedule(windows, shape, period=period)
    lam = decimal(rng.uniform(1.5, 4.5) / float(period))
    R0 = decimal(rng.uniform(0.3, 2.0))
    least = float(BodyBounds.of(body).least)
    reach = rng.uniform(0, 0.8) * np.sqrt(8 * least) / float(period)
    common = {
        "body": body,
        "schedule": schedule,
        "max_angle_deg": decimal(rng.uniform(20, 220)),
        "max_weighted_rate": decimal(reach),
    }
    if rng.random() < 0.5:
        return missions.question(law=PersistenceFilter(lambda_=lam, R0=R0), **common)
    mean = float(schedule.square_integral(F(0), period) / period)
    k0 = decimal(rng.uniform(0.5, 1.5) / (mean * float(period)))
    gamma = decimal(rng.uniform(0.02, 1.0) * float(k0) / float(R0))
    law = AdaptiveScaling(lambda_=lam, R0=R0, k0=k0, gamma=gamma)
    return missions.question(law=law, options=FloorOptions(max_bins=10, settling_moves=2), **common)


def random_inertia(rng):
    """Rotated principal inertias that satisfy the triangle inequality, exact decimals."""
    masses = rng.uniform(0.2, 1.0, size=3) * 10 ** rng.uniform(0, 1.5)
    principal = np.array([masses[1] + masses[2], masses[0] + masses[2], masses[0] + masses[1]])
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    J = Q @ np.diag(principal) @ Q.T
    return [[decimal(J[min(i, j), max(i, j)]) for j in range(3)] for i in range(3)]


FIGURES = ("floor", "angle", "rate", "torque", "settled", "decay", "command", "gain")
"""What is attacked; each as a ratio that must not exceed one."""


@dataclass(frozen=True)
class Attack:
    """One scenario's bounds against its adversary.

    Attributes
    ----------
    floor : certified floor over the least R simulated
    angle, rate, torque, settled : largest simulated over certified
    decay : the same of angle, |Omega|_J, |w|, |g u| and 1/R against the record's bounds at each instant
    command, gain : the same of |u| while g > 0 and of kappa
    """

    certified: bool
    floor: float = 0.0
    angle: float = 0.0
    rate: float = 0.0
    torque: float = 0.0
    settled: float = 0.0
    decay: float = 0.0
    command: float = 0.0
    gain: float = 0.0

    @property
    def largest(self) -> float:
        return max(getattr(self, name) for name in FIGURES)

    @property
    def floor_gap(self) -> float:
        """How far the least R simulated lies above the certified floor, relative."""
        return 1 / self.floor - 1


@dataclass(frozen=True)
class Adversary:
    """Draws starts of the set, half of them on its boundary, then moves towards each violation in turn.

    Attributes
    ----------
    batches : starts a round; 50 in all unless told
    periods : simulated, where the schedule repeats; more where the settling bound asks for it
    most_periods : but never more
    """

    batches: tuple[int, ...] = (24, 13, 13)
    periods: int = 3
    most_periods: int = 3

    def attack(self, q: FloorQuestion, seed: int, body: RigidBody | None = None) -> Attack:
        """Certify, then simulate against every bound; `body` may be any within the tolerance."""
        found = answer(q)
        floor = found.floor
        if floor is None or not reaches_far_enough(floor):
            return Attack(False)
        assert floor.value > 0
        rng = np.random.default_rng(seed + 10**6)
        shape = _Shape(
            q.law, body or q.mission.body, q.mission.schedule, q.initial, q.mission.starts.max_rate
        )
        points = shape.draw(rng, self.batches[0])
        values = self.ratios(q, found, shape, points)
        for number, count in enumerate(self.batches[1:]):
            best = np.concatenate([points[np.argsort(-row)[:2]] for row in values])
            centres = best[rng.integers(len(best), size=count)]
            radius = 0.3 / 3**number
            fresh = shape.clip(centres + radius * rng.normal(size=centres.shape) * shape.spread(centres))
            points = np.vstack([points, fresh])
            values = np.hstack([values, self.ratios(q, found, shape, fresh)])
        return Attack(True, *values.max(axis=1).tolist())

    def horizon(self, q: FloorQuestion, found: FloorAnswer) -> F:
        if found.floor.horizon is not None:
            return found.floor.horizon
        period, settling = q.mission.schedule.period, found.convergence.settling
        wanted = self.periods if settling is None else max(self.periods, settling / float(period) + 1)
        return int(min(wanted, self.most_periods)) * period

    def ratios(self, q: FloorQuestion, found: FloorAnswer, shape: _Shape, points):
        """Figures of each start, (8, n); 0 for a start that is not in the set."""
        floor, bound = found.floor, found.convergence
        horizon = self.horizon(q, found)
        cycles = 1 if q.mission.schedule.period is None else int(horizon / q.mission.schedule.period)
        times = np.linspace(0, float(horizon), 40 * cycles + 1)
        states = shape.states(points)
        runs = simulate_ensemble(
            q.law,
            shape.body,
            q.mission.schedule,
            states,
            horizon=horizon,
            times=times,
            metrics=MetricOptions(
                attitude=float(q.mission.tolerance.attitude), rate=float(q.mission.tolerance.rate)
            ),
        )
        m, tiny = runs.metrics, 1e-300
        inside = shape.inside(states)
        assert inside.any()
        assert not np.isnan(m.filter_minimum[inside]).any()  # no run stopped early
        controller = {s.name: runs.states[:, :, 7 + i] for i, s in enumerate(q.law.controller_states)}
        kappa = controller["k"].max(axis=1) if "k" in controller else 1 / m.filter_minimum
        seen = seen_over_time(q, shape.body, times, runs.states)
        angle, speed = seen["angle_bound"], seen["speed_bound"]
        now = over_time_ratios(bounds_over_time(floor, horizon), times, seen)
        # a run that ends outside its tolerances settles after the horizon, if at all
        settled = np.where(np.isnan(m.settling_time), float(horizon), m.settling_time)
        settled /= np.inf if bound.settling is None else max(bound.settling, tiny)
        rows = [
            floor.value / m.filter_minimum,
            angle.max(axis=1) / max(bound.largest_angle, tiny),
            speed.max(axis=1) / max(bound.largest_rate, tiny),
            m.peak[EUCLIDEAN] / max(found.torque.applied, tiny),
            settled,
            np.max(list(now.values()), axis=(0, 2)),
            m.peak_commanded[EUCLIDEAN] / max(found.torque.commanded, tiny),
            kappa / max(found.torque.gain, tiny),
        ]
        return np.where(inside, np.stack(rows), 0.0)


def seen_over_time(q: FloorQuestion, body: RigidBody, times, states) -> dict[str, np.ndarray]:
    """What the record bounds over time along each run, by the bound's name, (N, T); states (N, T, n)."""
    loop = close_loop(q.law)
    function = loop.function("seen", loop.augmented_rate, loop.applied_torque)
    columns = states.reshape(-1, states.shape[2]).T
    known = np.tile([q.mission.schedule.gain(times), q.mission.schedule.gain_rate(times)], len(states))
    constants = (np.tile(x[:, None], columns.shape[1]) for x in (loop.parameter_values(), body_values(body)))
    Omega, torque = (np.asarray(x).T for x in function(columns, known, *constants))
    # 4 asin(sqrt((1 - b0)/2)) = 4 asin(|(1 - b0, bv)|/2) loses no digits at either end
    chord = np.linalg.norm(states[:, :, :4] - [1, 0, 0, 0], axis=2) / 2
    weighted = np.sqrt(np.einsum("ni,ij,nj->n", Omega, body.inertia, Omega))
    return {
        "filter_floor": states[:, :, 7 + [s.name for s in q.law.controller_states].index("R")],
        "angle_bound": 4 * np.arcsin(np.clip(chord, 0, 1)),
        "rate_bound": weighted.reshape(chord.shape),
        "speed_bound": np.linalg.norm(states[:, :, 4:7], axis=2),
        "torque_bound": np.linalg.norm(torque, axis=1).reshape(chord.shape),
    }


def over_time_ratios(bounds: BoundsOverTime, times, seen: dict[str, np.ndarray]) -> dict[str, np.ndarray]:
    """What was seen over its bound (a floor: the bound over it) at each time; more than 1 is a violation."""
    cell = np.searchsorted(bounds.time, times, side="right") - 1
    ratios = {"filter_floor": bounds.filter_floor[cell] / seen["filter_floor"]}
    for name, values in seen.items():
        if name != "filter_floor":
            # what the simulation does not resolve, an error of 1e-9 of the first value, is no violation
            unresolved = 1e-9 if name == "angle_bound" else 1e-9 * values.max()
            if name == "rate_bound":  # from rest Omega is exactly zero: what is seen is the error of w
                unresolved = max(unresolved, 1e-8 * seen["speed_bound"].max())
            ratios[name] = (values - unresolved) / np.maximum(getattr(bounds, name)[cell], 1e-300)
    return ratios


def attack(seed: int) -> Attack:
    """A random scenario against 50 starts."""
    return Adversary().attack(random_question(seed), seed)


def crossings(attacks: list[Attack], tolerance: float = TOLERANCE) -> list[Attack]:
    """Those in which a simulated run crossed a certified bound."""
    return [a for a in attacks if a.certified and a.largest > 1 + tolerance]


def summary(attacks: list[Attack]) -> dict[str, float]:
    """Figures of many attacks."""
    held = [a for a in attacks if a.certified]
    gaps = np.array([a.floor_gap for a in held])
    return {
        "scenarios": len(attacks),
        "certified": len(held) / len(attacks),
        "crossings": len(crossings(attacks)),
        "median_gap": float(np.median(gaps)),
        "least_gap": float(gaps.min()),
        "caught_at_3_percent": float(np.mean([a.floor > 1 / 1.03 for a in held])),
    } | {name: max(getattr(a, name) for a in held) for name in FIGURES[1:]}
