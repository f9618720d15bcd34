"""Random scenarios for the floor certificate, and an adversary that simulates against it."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction as F

import numpy as np
from intermit.models.ensemble import MetricOptions, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Ramps, Window, build_schedule
from intermit.verify.floor.certify import FloorOptions
from intermit.verify.floor.comparison import BodyBounds
from intermit.verify.floor.question import FloorQuestion
from intermit.verify.floor.study import answer
from intermit.verify.floor.worst_found import Search, _Shape

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
        return FloorQuestion(law=PersistenceFilter(lambda_=lam, R0=R0), **common)
    mean = float(schedule.square_integral(F(0), period) / period)
    k0 = decimal(rng.uniform(0.5, 1.5) / (mean * float(period)))
    gamma = decimal(rng.uniform(0.02, 1.0) * float(k0) / float(R0))
    law = AdaptiveScaling(lambda_=lam, R0=R0, k0=k0, gamma=gamma)
    return FloorQuestion(law=law, options=FloorOptions(max_bins=10), **common)


def random_inertia(rng):
    """Rotated principal inertias that satisfy the triangle inequality, exact decimals."""
    masses = rng.uniform(0.2, 1.0, size=3) * 10 ** rng.uniform(0, 1.5)
    principal = np.array([masses[1] + masses[2], masses[0] + masses[2], masses[0] + masses[1]])
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    J = Q @ np.diag(principal) @ Q.T
    return [[decimal(J[min(i, j), max(i, j)]) for j in range(3)] for i in range(3)]


@dataclass(frozen=True)
class Attack:
    """One scenario's certificate against its adversary; ratios are simulated over certified."""

    certified: bool
    floor_gap: float
    angle: float
    rate: float
    torque: float
    settled: float


def attack(seed: int, *, periods: int = 3) -> Attack:
    """Certify a random scenario and simulate 50 adversarial starts against every bound."""
    q = random_question(seed)
    found = answer(q)
    floor = found.floor
    if floor is None or floor.horizon is not None or found.torque is None or found.convergence is None:
        return Attack(False, np.nan, np.nan, np.nan, np.nan, np.nan)
    horizon = periods * q.schedule.period
    states = adversarial_states(q, seed)
    times = np.linspace(0, float(horizon), 40 * periods + 1)
    options = MetricOptions(attitude=float(q.attitude), rate=float(q.rate))
    runs = simulate_ensemble(q.law, q.body, q.schedule, states, horizon=horizon, times=times, metrics=options)
    angle = 2 * np.arccos(np.clip(runs.states[:, :, 0], -1, 1)).max()
    speed = np.linalg.norm(runs.states[:, :, 4:7], axis=2).max()
    settling = np.nanmax(runs.metrics.settling_time, initial=0.0)
    bound = found.convergence.settling
    return Attack(
        True,
        float(runs.metrics.filter_minimum.min() / floor.value - 1),
        float(angle / found.convergence.largest_angle),
        float(speed / found.convergence.largest_rate),
        float(runs.metrics.peak_euclidean.max() / found.torque.applied),
        float(settling / bound) if bound else 0.0,
    )


def adversarial_states(q: FloorQuestion, seed: int):
    """Fifty starts: on the set's boundary, turning away, then perturbed towards the least R."""
    rng = np.random.default_rng(seed + 10**6)
    shape = _Shape(q.law, q.body, q.schedule, q.initial, q.max_rate)
    points = shape.draw(rng, 24)
    horizon = 2 * q.schedule.period
    for radius in (0.3, 0.1):
        values, _ = shape.run(points, horizon)
        best = points[np.argsort(values)[:4]]
        centres = best[rng.integers(len(best), size=13)]
        fresh = shape.clip(centres + radius * rng.normal(size=centres.shape) * shape.spread(centres))
        points = np.vstack([points, fresh])
    return shape.states(points)


def summary(attacks: list[Attack]) -> dict[str, float]:
    """Figures of many attacks."""
    held = [a for a in attacks if a.certified]
    gaps = np.array([a.floor_gap for a in held])
    return {
        "scenarios": len(attacks),
        "certified": len(held),
        "median_gap": float(np.median(gaps)),
        "least_gap": float(gaps.min()),
        "caught_at_3_percent": float(np.mean(gaps < 0.03)),
        "angle": max(a.angle for a in held),
        "rate": max(a.rate for a in held),
        "torque": max(a.torque for a in held),
        "settled": max(a.settled for a in held),
    }


__all__ = ["TOLERANCE", "Attack", "Search", "attack", "random_question", "summary"]
