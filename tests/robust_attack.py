"""Random members flown from random starts against the bounds of a robust floor."""

from __future__ import annotations

from fractions import Fraction as F

import missions
import numpy as np
from floor_attack import random_question
from intermit.models.ensemble import Tolerances, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.members import draw_members
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Ramps, Window, build_schedule
from intermit.models.uncertainty import Uncertainty
from intermit.verify.robust.answer import RobustQuestion
from intermit.verify.robust.consequences import consequences

TOLERANCE = 1e-6
BODY = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
SCHEDULE = build_schedule([Window(F(1, 100), F(321, 100))], Ramps(F(1, 100), F(1, 100)), period=F(8))
LAW = PersistenceFilter(F(21, 40), F(1))


ADAPTIVE = AdaptiveScaling(lambda_=F(21, 40), R0=F(1), k0=F(8, 10), gamma=F(1, 100))


def question(angle=120, rate=F(3, 10), body=BODY, law=LAW, **channels):
    return missions.robust(
        law=law, body=body, schedule=SCHEDULE, uncertainty=Uncertainty(**channels),
        max_angle_deg=F(angle), max_weighted_rate=rate,
    )  # fmt: skip


def random_robust_question(seed: int) -> RobustQuestion:
    """A random body, schedule and filter law, with a random mixture of channels."""
    rng = np.random.default_rng(seed)
    base, n = random_question(seed), seed
    while not isinstance(base.law, PersistenceFilter):
        n += 10_000
        base = random_question(n)
    share = {name: F(int(rng.integers(0, 3))) for name in ("shape", "scale", "thrust", "turn", "push")}
    weak, strong = share["thrust"] * F(int(rng.integers(0, 3))), share["thrust"] * F(int(rng.integers(0, 3)))
    uncertainty = Uncertainty(
        inertia_relative=share["shape"] / 200,
        inertia_scale=(-share["scale"] / 200, share["scale"] / 150),
        thrust_error=(-weak / 200, strong / 200),
        thrust_error_varies="never" if rng.random() < 0.5 else "per-firing",
        misalignment_deg=share["turn"] / 8,
        disturbance=share["push"] * F(f"{float(base.bounds.least):.2g}") / 2000,
    )
    return missions.robust(
        law=base.law,
        body=base.mission.body,
        schedule=base.mission.schedule,
        uncertainty=uncertainty,
        max_angle_deg=min(base.mission.starts.max_angle_deg, F(150)),
        max_weighted_rate=base.mission.starts.max_weighted_rate / 2,
    )


def starts(q: RobustQuestion, count: int, rng: np.random.Generator):
    """Starts of the set, most on its boundary, many with a rate along bv; (count, 7)."""
    J0, bounds, rows = q.mission.body.inertia, q.mission.starts, []
    for _ in range(count):
        angle = np.radians(float(q.mission.starts.max_angle_deg)) * (
            1 if rng.random() < 0.7 else rng.random()
        )
        axis = rng.normal(size=3)
        axis /= np.linalg.norm(axis)
        way = axis * rng.choice([-1, 1]) if rng.random() < 0.4 else rng.normal(size=3)
        most = float(bounds.max_weighted_rate or 0) * (1 if rng.random() < 0.7 else rng.random())
        rate = way * most / np.sqrt(way @ J0 @ way)
        rows.append(np.concatenate([[np.cos(angle / 2)], np.sin(angle / 2) * axis, rate]))
    return np.array(rows)


def attack(q: RobustQuestion, floor, *, runs: int = 40, periods: int = 8, seed: int = 0) -> dict[str, float]:
    """Largest ratios of what is flown to what is proved: floor, gap (1 - b0), rate, late gap and rate."""
    rng = np.random.default_rng(seed)
    members = draw_members(q.law, q.mission.body, q.mission.uncertainty, runs, rng)
    first = starts(q, runs, rng)
    horizon = q.mission.schedule.period * periods
    times = np.linspace(0, float(horizon), 40 * periods + 1)[1:]
    found, worst = consequences(floor), dict.fromkeys(("floor", "gap", "rate", "late", "envelope"), 0.0)
    for way in {m.law.toward for m in members}:
        chosen = [i for i, m in enumerate(members) if m.law.toward == way]
        result = simulate_ensemble(
            [members[i].law for i in chosen], [members[i].body for i in chosen], q.mission.schedule,
            first[chosen],
            horizon=horizon, times=times, tolerances=Tolerances(rtol=1e-9, atol=1e-12),
        )  # fmt: skip
        gap = 1 - result.states[:, :, 0]
        rate = np.linalg.norm(result.states[:, :, 4:7], axis=2)
        worst["floor"] = max(worst["floor"], float((floor.value / result.state("R")).max()))
        worst["gap"] = max(worst["gap"], float(gap.max()) / found.largest_gap)
        worst["rate"] = max(worst["rate"], float(rate.max()) / found.largest_rate)
        worst["envelope"] = max(worst["envelope"], float((gap / envelope(floor, times)).max()))
        if found.ultimate is not None:
            late = times >= found.ultimate.start
            if late.any():
                worst["late"] = max(
                    worst["late"],
                    float(gap[:, late].max()) / found.ultimate.gap,
                    float(rate[:, late].max()) / found.ultimate.rate,
                )
    return worst


def envelope(floor, times):
    """Bound of S at each time over all bins, (T,)."""
    result = np.zeros(len(times))
    for _, pipe in floor.parts:
        period = float(floor.question.mission.schedule.period)
        for k, t in enumerate(times):
            boxes, scale, at = pipe.boxes, 1.0, t
            if pipe.tail is not None and t > float(pipe.tail.start):
                n = int((t - float(pipe.tail.start)) // period)
                boxes, at = pipe.tail_boxes, t - n * period
                scale = max(pipe.tail.ratios.values(), default=1.0) ** n
            held = [b.cosine_gap for b in boxes if b.start - 1e-9 <= at <= b.stop + 1e-9]
            result[k] = max(result[k], max(held) * scale**2)
    return result


def nominal(q: RobustQuestion) -> RobustQuestion:
    """The same question with nothing uncertain."""
    return q.about(Uncertainty())
