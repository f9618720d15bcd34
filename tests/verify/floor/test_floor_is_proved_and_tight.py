"""The certified floor reaches its targets, is close to the comparison system, and cannot be inflated."""

from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.laws import QuaternionPD
from intermit.models.schedule import Hermite, PiecewisePolynomial, Schedule, Window, build_schedule
from intermit.verify.filter.certify import FloorOptions, certify_floor, comparison_system
from intermit.verify.filter.comparison import BodyBounds
from intermit.verify.filter.converged import ConvergedFilter
from intermit.verify.filter.sets import InitialSet
from intermit.verify.flow.stepping import Stepper, is_proved
from problems import ADAPTIVE, CONVERGED_FILTER_FLOOR, J1, PERSISTENCE, paper_schedule
from scipy.integrate import solve_ivp

BOUNDS = BodyBounds.of(J1)
EXAMPLE = InitialSet.from_bounds(BOUNDS, max_angle_deg=F(120), max_weighted_rate=F("0.3"))


def test_a_gain_that_jumps_is_refused():
    jumping = PiecewisePolynomial((F(0), F(1), F(2)), ((F(0), F(1)), (F(2), F(-2))))
    late = Schedule((Window(F(0), F(2)),), jumping, None)
    with pytest.raises(ValueError, match="g jumps at 1 s"):
        certify_floor(PERSISTENCE, BOUNDS, late, EXAMPLE)
    sudden = Schedule((Window(F(0), F(2)),), PiecewisePolynomial((F(0), F(2)), ((F(1),),)), None)
    with pytest.raises(ValueError, match="g jumps at 2 s"):
        certify_floor(PERSISTENCE, BOUNDS, sudden, EXAMPLE)


def test_persistence_filter_reaches_its_target():
    floor = certify_floor(PERSISTENCE, BOUNDS, paper_schedule(), EXAMPLE)
    assert floor.horizon is None  # for all time
    assert 0.1480 <= floor.value < CONVERGED_FILTER_FLOOR


@pytest.mark.slow
def test_adaptive_law_reaches_its_target():
    floor = certify_floor(ADAPTIVE, BOUNDS, paper_schedule(), EXAMPLE)
    assert floor.horizon is None
    assert 0.130 <= floor.value < CONVERGED_FILTER_FLOOR


def test_bins_raise_the_adaptive_floor():
    values = [
        certify_floor(ADAPTIVE, BOUNDS, paper_schedule(), EXAMPLE, options=FloorOptions(max_bins=n)).value
        for n in (1, 6)
    ]
    assert 0.09 < values[0] < values[1] < CONVERGED_FILTER_FLOOR


def floating_floor(system, schedule, state, horizon):
    """Least r of the comparison system by tight floating-point integration, best form at each instant."""
    index, least, t = system.names.index("r"), np.inf, 0.0
    for piece in schedule.pieces_between(F(0), horizon):
        start, length = float(piece.start), float(piece.length)
        shape = np.array([float(c) for c in reversed(piece.shape)] or [0.0])

        def rate(t, x, start=start, length=length, shape=shape):
            g2 = np.polyval(shape, (t - start) / length) ** 2
            return system.rate(g2, x, system.choices(x, 1.0 if shape.any() else 0.0)[0], 1.0, 0.0)

        found = solve_ivp(rate, (t, start + length), state, rtol=1e-10, atol=1e-12, max_step=0.05)
        least, state, t = min(least, found.y[index].min()), found.y[:, -1], start + length
    return least


@pytest.mark.parametrize("law", [PERSISTENCE, ADAPTIVE])
def test_floor_is_within_one_percent_of_the_comparison_system(law):
    system = comparison_system(law, BOUNDS)
    schedule = paper_schedule()
    loose = floating_floor(system, schedule, system.start(EXAMPLE), F(56))
    floor = certify_floor(law, BOUNDS, schedule, EXAMPLE, options=FloorOptions(max_bins=1))
    assert 0.99 * loose <= floor.value <= loose * (1 + 1e-6)


def test_a_step_with_a_raised_floor_is_not_proved():
    system = comparison_system(PERSISTENCE, BOUNDS)
    steps = Stepper(system).run(paper_schedule(), F(0), F(8), system.start(EXAMPLE))
    assert all(is_proved(system, s) for s in steps)
    refused = 0
    for step in steps:
        first, *rest = step.controls["r"]
        raised = replace(step, controls={**step.controls, "r": (first, *(1.005 * c for c in rest))})
        refused += not is_proved(system, raised)
    assert refused == len(steps)


def test_a_wide_set_stops_with_an_instant_not_a_number():
    """From 300 deg with a fast spin the angle bound passes 2 pi: no claim beyond that time."""
    wide = InitialSet.from_bounds(BOUNDS, max_angle_deg=F(300), max_weighted_rate=F(2))
    floor = certify_floor(ADAPTIVE, BOUNDS, paper_schedule(), wide, options=FloorOptions(max_bins=2))
    assert floor.failed_at is not None
    assert floor.horizon is not None
    assert floor.horizon <= floor.failed_at < 8


def test_finite_tables_are_covered_to_the_horizon():
    windows = [Window(F(8 * k) + F("0.01"), F(8 * k) + F("3.21")) for k in range(3)]
    finite = build_schedule(windows, Hermite(F("0.01")))
    floor = certify_floor(PERSISTENCE, BOUNDS, finite, EXAMPLE, horizon=F(24))
    assert floor.horizon == 24
    assert 0.148 < floor.value < CONVERGED_FILTER_FLOOR


def test_laws_without_comparison_system_get_none():
    law = QuaternionPD(proportional=F(1), derivative=F(1))
    assert certify_floor(law, BOUNDS, paper_schedule(), EXAMPLE) is None


def test_sets_hold_their_states():
    state = InitialSet.from_state(J1, [F(1, 2)] * 4, [F(1, 10), F(0), F(0)])
    assert state.s_low <= np.sqrt(0.5) <= state.s_high <= state.s_low + 1e-12
    assert state.y_low <= np.sqrt(0.0305) <= state.y_high <= state.y_low + 1e-12
    assert state.s_high <= EXAMPLE.s_high + 1e-12


@pytest.mark.parametrize("law", [PERSISTENCE, ADAPTIVE])
def test_long_tables_are_covered_as_the_state_vanishes(law):
    """After 45 periods the angle is below 1e-8: no bound underflows or drowns in rounding."""
    windows = [Window(F(8 * k) + F("0.01"), F(8 * k) + F("3.21")) for k in range(45)]
    finite = build_schedule(windows, Hermite(F("0.01")))
    options = FloorOptions(max_bins=1)
    start = InitialSet.from_state(J1, [F(1, 2)] * 4, [F(0)] * 3)
    floor = certify_floor(law, BOUNDS, finite, start, horizon=F(360), options=options)
    assert floor.horizon == 360
    assert floor.flowpipes[0].boxes[-1].cosine_gap < 1e-16


def test_periods_of_many_windows_are_truncated():
    windows = [Window(F(4 * k), F(4 * k + 2)) for k in range(150)]
    schedule = build_schedule(windows, Hermite(), period=F(600))
    floor = certify_floor(PERSISTENCE, BOUNDS, schedule, EXAMPLE)
    assert floor.horizon == 400
    assert floor.failed_at is None


@pytest.mark.parametrize(("law", "gap"), [(PERSISTENCE, 16), (ADAPTIVE, 12), (ADAPTIVE, 40)])
def test_a_filter_emptied_by_a_long_gap_keeps_its_floor(law, gap):
    """Over lambda t = 40 R falls to 1e-18 of what a window brings: slack must be of its size."""
    schedule = build_schedule([Window(F(0), F(4))], Hermite(), period=F(4 + gap))
    start = InitialSet.from_bounds(BOUNDS, max_angle_deg=F(60), max_weighted_rate=F("0.02"))
    options = FloorOptions(max_bins=4)
    floor = certify_floor(replace(law, lambda_=F(1)), BOUNDS, schedule, start, options=options)
    assert floor.horizon is None
    converged = ConvergedFilter(schedule, F(1)).floor()
    # the set is not split where R is next to forgotten within a gap: one bin's bounds, within 5 per cent
    assert 0.95 * converged.low <= floor.value <= converged.high


@pytest.mark.parametrize("law", [PERSISTENCE, ADAPTIVE])
def test_rates_too_small_to_matter_do_not_stop_the_proof(law):
    """A rate of 1e-12 moves the angle by less than its rounding, and still has to be bounded."""
    values = []
    for rate in (F(0), F(1, 10**12), F(1, 10**9)):
        start = InitialSet.from_bounds(BOUNDS, max_angle_deg=F(120), max_weighted_rate=rate)
        floor = certify_floor(law, BOUNDS, paper_schedule(), start, options=FloorOptions(max_bins=4))
        assert floor.horizon is None
        values.append(floor.value)
    assert values[0] * (1 - 1e-4) <= values[2] <= values[1] <= values[0]


@pytest.mark.parametrize(("law", "bandwidth"), [(PERSISTENCE, F("0.012")), (ADAPTIVE, F("0.02"))])
def test_periods_far_shorter_than_the_filter_repeat_too(law, bandwidth):
    """A window a second, lambda T a hundredth: one period decays slightly, the proof is the same."""
    schedule = build_schedule([Window(F(0), F("0.4"))], Hermite(), period=F(1))
    law = replace(law, lambda_=bandwidth, **({"k0": 2 * bandwidth} if law is ADAPTIVE else {}))
    start = InitialSet.from_bounds(BOUNDS, max_angle_deg=F(60), max_weighted_rate=bandwidth / 2)
    floor = certify_floor(law, BOUNDS, schedule, start, options=FloorOptions(max_bins=6))
    assert floor.horizon is None
    assert 0.998 * law.R0 < floor.value < law.R0


def test_the_time_covered_is_that_of_the_witness_which_ends():
    """Witnesses with a repeating part cover all time and must not shorten what the others cover."""
    schedule = build_schedule([Window(F(0), F("0.4"))], Hermite(), period=F(1))
    law = replace(ADAPTIVE, lambda_=F("0.01"), k0=F("0.02"))
    start = InitialSet.from_bounds(BOUNDS, max_angle_deg=F(60), max_weighted_rate=F("0.005"))
    options = FloorOptions(max_bins=4, max_periods=4)
    floor = certify_floor(law, BOUNDS, schedule, start, options=options)
    without = [w.end for w in floor.flowpipes if w.tail is None]
    assert floor.horizon == min(without, default=None)
