"""Scenarios at the edges of every datum: bodies of 1e-3 to 1e4 kg m^2, gaps of 50 windows, R(0) far off."""

from __future__ import annotations

from fractions import Fraction as F

import missions
import numpy as np
from floor_attack import decimal, random_inertia
from hostile_scenarios import shifted
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Ramps, Schedule, Window, build_schedule
from intermit.verify.filter.certify import FloorOptions
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.question import FloorQuestion


def sized_body(rng: np.random.Generator) -> RigidBody:
    """Any size; now and then a rod, whose least inertia is far below the others."""
    scale = F(10) ** int(rng.integers(-4, 4))
    if rng.random() < 0.2:
        thin = decimal(10 ** rng.uniform(-3, -1))
        rows = [[thin, 0, 0], [0, F(1), 0], [0, 0, F(1)]]
    else:
        rows = random_inertia(rng)
    return RigidBody.from_rows([[F(x) * scale for x in row] for row in rows])


def edge_schedule(rng: np.random.Generator) -> Schedule:
    """Long gaps; windows from t = 0; starts inside a window; one window for good; irregular tables."""
    period = decimal(10 ** rng.uniform(-1, 3))
    kind = rng.integers(5)
    if kind == 0:  # a gap of up to a hundred times the window
        on = period * decimal(10 ** rng.uniform(-2, -0.7), 3)
        lead = (period - on) * decimal(rng.uniform(0, 1), 3)
        return build_schedule([Window(lead, lead + on)], Hermite(), period=period)
    on = period * decimal(rng.uniform(0.1, 0.9), 3)
    if kind == 1:
        return build_schedule([Window(F(0), on)], Ramps(on / 3, on / 3), period=period)
    if kind == 2:
        schedule = build_schedule([Window(F(0), on)], Hermite(), period=period)
        return shifted(schedule, on * decimal(rng.uniform(0, 1), 3))
    if kind == 3:  # a table of one window
        lead = F(0) if rng.random() < 0.5 else decimal(rng.uniform(0, 2)) * on
        return build_schedule([Window(lead, lead + on)], Hermite())
    windows, t = [], F(0)
    for _ in range(int(rng.integers(2, 6))):
        first = t + on * decimal(10 ** rng.uniform(-2, 0.3), 3)
        t = first + on * decimal(rng.uniform(0.2, 2), 3)
        windows.append(Window(first, t))
    return build_schedule(windows, Ramps(on / 20, on / 10))


def cycle(schedule: Schedule) -> float:
    return float(schedule.period if schedule.period is not None else schedule.windows[0].off)


def edge_question(seed: int) -> FloorQuestion:
    """One or two data at their edges, the others where the laws have work to do."""
    rng = np.random.default_rng(seed)
    body, schedule = sized_body(rng), edge_schedule(rng)
    T, least = cycle(schedule), float(BodyBounds.of(body).least)
    edges = set(rng.choice(["none", "angle", "rate", "R0", "lambda", "gain"], size=2))
    lam = decimal((10 ** rng.uniform(-2, 1.3) if "lambda" in edges else rng.uniform(0.5, 4)) / T)
    R0 = decimal(T * (10 ** rng.uniform(-4, 3) if "R0" in edges else rng.uniform(0.05, 0.5)))
    angle = decimal(rng.uniform(300, 359.9) if "angle" in edges else rng.uniform(1, 200))
    reach = (
        (10 ** rng.uniform(-0.5, 0.7) if "rate" in edges else rng.uniform(0, 0.6)) * np.sqrt(8 * least) / T
    )
    common = {"body": body, "schedule": schedule, "max_angle_deg": angle}
    kind = rng.integers(3 if schedule.gain(0.0) == 0 else 2)  # the adversary clips w, not Omega
    if kind != 0:
        common["max_weighted_rate"] = decimal(reach)
    if kind != 1:
        common["max_rate"] = decimal(reach / np.sqrt(float(BodyBounds.of(body).greatest)))
    common["attitude"] = F(1, 100)
    common["rate"] = decimal(0.01 / T)
    if rng.random() < 0.5:
        return missions.question(law=PersistenceFilter(lambda_=lam, R0=R0), **common)
    mean = float(schedule.square_integral(F(0), schedule.end))
    k0 = decimal((10 ** rng.uniform(-2, 1.5) if "gain" in edges else rng.uniform(0.3, 1.5)) / mean)
    if "gain" in edges and rng.random() < 0.3:
        k0 = F(0)
    # k gains about gamma R g^2 a; a like the weighted rate's square
    a = decimal(least / T**2 * 10 ** rng.uniform(-1, 1))
    gamma = decimal(10 ** rng.uniform(-3, 0.5) / (mean * float(R0) * float(a) * T))
    law = AdaptiveScaling(lambda_=lam, R0=R0, k0=k0, gamma=gamma, a=a)
    return missions.question(law=law, options=FloorOptions(max_bins=6, settling_moves=2), **common)


def without_rate(q: FloorQuestion) -> FloorQuestion:
    """The same from rest."""
    return missions.other(q, max_rate=None, max_weighted_rate=None)
