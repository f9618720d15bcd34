"""Scenarios at the edges of what a floor certificate may be asked, and an optimising adversary."""

from dataclasses import replace
from fractions import Fraction as F

import missions
import numpy as np
from floor_attack import Adversary, Attack, decimal, random_inertia
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
from intermit.verify.filter.certify import FloorOptions
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.question import FloorQuestion


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
        return missions.question(law=PersistenceFilter(lambda_=lam, R0=R0), **common)
    mean = float(schedule.square_integral(F(0), schedule.period) / schedule.period)
    k0 = F(0) if rng.random() < 0.15 else decimal(rng.uniform(0.1, 2) / (mean * period))
    gamma = decimal(10 ** rng.uniform(-3, 0.5) / period / float(R0))
    a = decimal(10 ** rng.uniform(-1.5, 1))
    law = AdaptiveScaling(lambda_=lam, R0=R0, k0=k0, gamma=gamma, a=a)
    return missions.question(law=law, options=FloorOptions(max_bins=8, settling_moves=2), **common)


def perturbed(body: RigidBody, tolerance, rng) -> RigidBody:
    signs = rng.integers(2, size=(3, 3)) * 2 - 1
    rows = [
        [body.exact_inertia[i][j] + tolerance[i][j] * int(signs[min(i, j), max(i, j)]) for j in range(3)]
        for i in range(3)
    ]
    return RigidBody.from_rows(rows)


def hostile_attack(seed: int, *, question: FloorQuestion | None = None) -> Attack:
    """Certify, then attack each bound in turn, over the whole certified time up to 25 periods."""
    q = hostile_question(seed) if question is None else question
    body = q.mission.body
    if q.mission.inertia_tolerance is not None:
        body = perturbed(body, q.mission.inertia_tolerance, np.random.default_rng(seed + 77))
    adversary = Adversary(batches=(32, 20, 20, 20), periods=4, most_periods=25)
    return adversary.attack(q, seed, body)
