"""Scenarios at the edges of what a floor certificate may be asked, and an optimising adversary."""

from dataclasses import dataclass, replace
from fractions import Fraction as F

import numpy as np
from floor_attack import decimal, random_inertia
from intermit.models.ensemble import MetricOptions, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import (
    Hermite,
    PiecewisePolynomial,
    Ramps,
    Schedule,
    Window,
    build_schedule,
)
from intermit.models.schedule.measured import ThrustSample, measured_schedule
from intermit.models.schedule.polynomial import compose_affine
from intermit.verify.floor.certify import FloorOptions
from intermit.verify.floor.comparison import BodyBounds
from intermit.verify.floor.question import FloorQuestion
from intermit.verify.floor.study import answer
from intermit.verify.floor.worst_found import _Shape


def shifted(schedule: Schedule, by: F) -> Schedule:
    """The same periodic g, seen from `by` on: it may begin inside a window."""
    period = schedule.period
    assert period is not None
    knots, shapes = [F(0)], []
    for piece in schedule.pieces_between(by, by + period):
        first, last = max(piece.start, by), min(piece.end, by + period)
        if first >= last:
            continue
        offset = (first - piece.start) / piece.length
        shapes.append(compose_affine(piece.shape, offset, (last - first) / piece.length))
        knots.append(last - by)
    return replace(schedule, profile=PiecewisePolynomial(tuple(knots), tuple(shapes)))


def random_schedule(rng: np.random.Generator) -> Schedule:
    period = decimal(rng.uniform(3, 14))
    on = decimal(rng.uniform(0.15, 0.8), 3) * period
    lead = (period - on) * decimal(rng.uniform(0, 1), 3)
    kind = rng.integers(4)
    if kind == 0:
        schedule = build_schedule([Window(lead, lead + on)], Hermite(), period=period)
    elif kind == 1:  # the window ends with the period
        shape = Ramps(on * decimal(rng.uniform(0.02, 0.9), 2), on / 20)
        schedule = build_schedule([Window(period - on, period)], shape, period=period)
    elif kind == 2:
        gains = [F(0), *(decimal(x, 3) for x in rng.uniform(0.1, 1.3, size=6)), F(0)]
        times = [F(i) * on / 7 for i in range(8)]
        samples = [ThrustSample(t, g) for t, g in zip(times, gains, strict=True)]
        schedule = measured_schedule(samples, period=period)
    else:
        schedule = build_schedule(
            [Window(F(0), on / 3), Window(on / 2, on)], Ramps(on / 20, on / 10), period=period
        )
    if rng.random() < 0.5:
        schedule = shifted(schedule, period * decimal(rng.uniform(0, 0.999), 3))
    return schedule


def hostile_question(seed: int) -> FloorQuestion:
    """Inertia, schedule, lambda from 0.05 to 3, set up to 350 deg, weights, k(0) = 0, tolerances."""
    rng = np.random.default_rng(seed)
    body = RigidBody.from_rows(random_inertia(rng))
    schedule = random_schedule(rng)
    period = float(schedule.period)
    lam = decimal(min(max(10 ** rng.uniform(-1.3, 0.48), 0.05), 3))
    R0 = decimal(10 ** rng.uniform(-1, 0.8))
    reach = rng.uniform(0, 0.9) * np.sqrt(8 * float(BodyBounds.of(body).least)) / period
    common = {"body": body, "schedule": schedule, "max_angle_deg": decimal(rng.uniform(1, 350))}
    kind = rng.integers(4)
    if kind in (0, 2):
        common["max_weighted_rate"] = decimal(reach)
    if kind == 1 or (kind == 2 and schedule.gain(0.0) == 0):  # the adversary clips w, not Omega
        common["max_rate"] = decimal(0.6 * reach / np.sqrt(float(BodyBounds.of(body).greatest)))
    if rng.random() < 0.3:
        size = decimal(0.05 * float(BodyBounds.of(body).least), 3)
        common["inertia_tolerance"] = tuple(
            tuple(size if i == j else size / 3 for j in range(3)) for i in range(3)
        )
    if rng.random() < 0.5:
        return FloorQuestion(law=PersistenceFilter(lambda_=lam, R0=R0), **common)
    mean = float(schedule.square_integral(F(0), schedule.period) / schedule.period)
    k0 = F(0) if rng.random() < 0.15 else decimal(rng.uniform(0.1, 2) / (mean * period))
    gamma = decimal(10 ** rng.uniform(-3, 0.5) / period / float(R0))
    a = decimal(10 ** rng.uniform(-1.5, 1))
    law = AdaptiveScaling(lambda_=lam, R0=R0, k0=k0, gamma=gamma, a=a)
    return FloorQuestion(law=law, options=FloorOptions(max_bins=8), **common)


@dataclass(frozen=True)
class Worst:
    """Largest ratios of simulated to certified (floor: certified to simulated); above 1 is a break."""

    certified: bool
    floor: float = 0.0
    angle: float = 0.0
    rate: float = 0.0
    torque: float = 0.0
    settled: float = 0.0

    @property
    def largest(self) -> float:
        return max(self.floor, self.angle, self.rate, self.torque, self.settled)


def perturbed(body: RigidBody, tolerance, rng) -> RigidBody:
    signs = rng.integers(2, size=(3, 3)) * 2 - 1
    rows = [
        [body.exact_inertia[i][j] + tolerance[i][j] * int(signs[min(i, j), max(i, j)]) for j in range(3)]
        for i in range(3)
    ]
    return RigidBody.from_rows(rows)


def hostile_attack(seed: int, *, periods: int = 4, question: FloorQuestion | None = None) -> Worst:
    """Certify, then let an adversary optimise each violation in turn."""
    q = hostile_question(seed) if question is None else question
    found = answer(q)
    floor = found.floor
    if floor is None or floor.horizon is not None or floor.stuck is not None:
        return Worst(False)
    assert found.torque is not None
    assert found.convergence is not None
    rng = np.random.default_rng(seed + 77)
    bodies = [q.body]
    if q.inertia_tolerance is not None:
        bodies = [perturbed(q.body, q.inertia_tolerance, rng)]
    shape = _Shape(q.law, bodies[0], q.schedule, q.initial, q.max_rate)
    # 2 acos(b0) and 4 periods; settling is looked at over the whole certified time, up to 30 periods
    period = float(q.schedule.period)
    settling = found.convergence.settling
    last = periods if settling is None else int(min(max(periods, settling / period + 1), 25))
    horizon = last * q.schedule.period
    times = np.linspace(0, float(horizon), 30 * last + 1)
    options = MetricOptions(attitude=float(q.attitude), rate=float(q.rate))

    def figures(points):
        runs = simulate_ensemble(
            q.law, bodies[0], q.schedule, shape.states(points), horizon=horizon, times=times, metrics=options
        )
        m = runs.metrics
        angle = np.nanmax(2 * np.arccos(np.clip(runs.states[:, :, 0], -1, 1)), axis=1)
        speed = np.nanmax(np.linalg.norm(runs.states[:, :, 4:7], axis=2), axis=1)
        late = np.where(np.isnan(m.settling_time), np.inf, m.settling_time)
        settled = late / settling if settling and float(horizon) > settling else np.zeros(len(points))
        return np.stack(
            [
                floor.value / m.filter_minimum,
                angle / found.convergence.largest_angle,
                speed / found.convergence.largest_rate,
                m.peak_euclidean / found.torque.applied,
                settled,
            ]
        )

    points = shape.draw(rng, 32)
    values = figures(points)
    for radius in (0.3, 0.1, 0.03):
        best = np.concatenate([points[np.argsort(-row)[:2]] for row in values])
        centres = best[rng.integers(len(best), size=20)]
        fresh = shape.clip(centres + radius * rng.normal(size=centres.shape) * shape.spread(centres))
        points, values = np.vstack([points, fresh]), np.hstack([values, figures(fresh)])
    return Worst(True, *np.nanmax(values, axis=1).tolist())
