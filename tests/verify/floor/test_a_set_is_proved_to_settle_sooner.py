"""Refining the bins that settle last lowers the proved time, keeps the floor, and stays above every run."""

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import settling_time, simulate
from intermit.verify.filter.certify import FloorOptions, certify_floor
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.convergence import analyse_convergence
from intermit.verify.filter.refine import tighten_settling_time
from intermit.verify.filter.sets import InitialSet
from problems import ADAPTIVE, J1, PERSISTENCE, paper_schedule

BOUNDS = BodyBounds.of(J1)
EXAMPLE = InitialSet.from_bounds(BOUNDS, max_angle_deg=F(120), max_weighted_rate=F("0.3"))
TOLERANCE = {"attitude": 0.01, "rate": 0.01}


@pytest.fixture(scope="module")
def floors():
    first = certify_floor(ADAPTIVE, BOUNDS, paper_schedule(), EXAMPLE)
    return first, tighten_settling_time(first, **TOLERANCE)


def settled(floor):
    return analyse_convergence(floor, **TOLERANCE).settling


def test_the_proved_time_falls_and_the_floor_does_not(floors):
    first, refined = floors
    assert settled(refined) < 0.7 * settled(first)
    assert refined.value >= first.value
    assert refined.horizon is None


def test_the_bins_still_cover_the_set(floors):
    _, refined = floors
    boxes = [w.initial for w in refined.flowpipes]
    area = sum((b.s_high - b.s_low) * (b.y_high - b.y_low) for b in boxes)
    assert area == pytest.approx(EXAMPLE.s_high * EXAMPLE.y_high, rel=1e-9)


def test_no_move_leaves_it_as_it_is(floors):
    first, _ = floors
    assert tighten_settling_time(first, **TOLERANCE, options=FloorOptions(settling_moves=0)) == first
    finite = build_schedule([Window(F(0), F(3)), Window(F(8), F(11))], Hermite())
    for law, schedule in ((PERSISTENCE, paper_schedule()), (ADAPTIVE, finite)):
        floor = certify_floor(law, BOUNDS, schedule, EXAMPLE, options=FloorOptions(max_bins=2))
        assert tighten_settling_time(floor, **TOLERANCE) is floor


@pytest.mark.slow
def test_no_run_settles_later(floors):
    """Starts at random and at the corners of the bins: small errors settle last, for they teach little."""
    _, refined = floors
    bound = settled(refined)
    generator = np.random.default_rng(3)
    latest = 0.0
    for n in range(12):
        box = refined.flowpipes[n % len(refined.flowpipes)].initial
        s, y = (box.s_low, box.y_high) if n % 2 else (box.s_high, box.y_low)
        axis, spin = (v / np.linalg.norm(v) for v in generator.normal(size=(2, 3)))
        b0 = 1 - s**2
        quaternion = np.array([b0, *(np.sqrt(1 - b0**2) * axis)])
        direction = spin if n % 3 else axis
        rate = y * direction / np.sqrt(direction @ J1.inertia @ direction)
        run = simulate(ADAPTIVE, J1, paper_schedule(), quaternion=quaternion, rate=rate, horizon=F(160))
        latest = max(latest, settling_time(run, **TOLERANCE))
    assert latest <= bound
    assert latest > bound / 3, "the bound should not be idle"
