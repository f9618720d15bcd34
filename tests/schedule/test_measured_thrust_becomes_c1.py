"""Measured thrust becomes a gain that is C1, monotone between samples, and zero where the record is."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from intermit.models.schedule import ThrustSample, measured_schedule
from intermit.models.schedule import polynomial as poly
from intermit.models.schedule.measured import normalised, pchip_slopes
from intermit.verify.schedule.facts import schedule_claims
from intermit.verify.verdict import Verdict

F = Fraction


def record(seed, pauses=2):
    """Random samples at random times: bursts between stretches of zeros."""
    rng = np.random.default_rng(seed)
    t, samples = F(0), [ThrustSample(F(0), F(0))]
    for _ in range(pauses):
        for gains in ([0, 0], rng.integers(1, 1000, 12), [0, 0]):
            for gain in gains:
                t += F(int(rng.integers(1, 400)), 1000)
                samples.append(ThrustSample(t, F(int(gain), 1000)))
    return samples


@pytest.mark.parametrize("seed", range(8))
@pytest.mark.parametrize("period", [None, F(40)])
def test_facts_hold(seed, period):
    schedule = measured_schedule(record(seed), period=period)
    assert len(schedule.windows) == 2
    assert all(claim.verdict is Verdict.PROVED for claim in schedule_claims(schedule))


@pytest.mark.parametrize("seed", range(8))
def test_monotone_between_samples_and_through_them(seed):
    """The derivative's Bernstein coefficients have the sign of the rise: an exact proof of monotony."""
    samples = record(seed)
    profile = measured_schedule(samples).profile
    for (a, b), shape in zip(pairwise(samples), profile.shapes, strict=True):
        assert poly.evaluate(shape, F(0)) == a.gain
        assert poly.evaluate(shape, F(1)) == b.gain
        slope = poly.derivative(shape)
        sign = (b.gain > a.gain) - (b.gain < a.gain)
        if sign == 0:
            assert not slope
        else:
            assert poly.evaluate(slope, F(1, 2)) * sign > 0
            # a quadratic is >= 0 on [0, 1]: its Bernstein coefficients, or its discriminant, tell
            b0, b1, b2 = (sign * c for c in poly.bernstein(slope, 2))
            assert min(b0, b2) >= 0
            assert b1 >= 0 or b1 * b1 <= b0 * b2


def test_slopes_are_pchip():
    """Inside the record the slopes are scipy's, to rounding."""
    from scipy.interpolate import PchipInterpolator

    samples = record(3)
    t = np.array([float(s.time) for s in samples])
    g = np.array([float(s.gain) for s in samples])
    expected = PchipInterpolator(t, g).derivative()(t)
    found = np.array([float(d) for d in pchip_slopes(samples)])
    assert found[1:-1] == pytest.approx(expected[1:-1], rel=1e-12, abs=1e-12)
    assert found[0] == found[-1] == 0


def test_straight_data_are_not_kept_straight_at_the_ends_only():
    """On equal steps with equal rises the inner slope is the secant's; the ends are brought to rest."""
    samples = [ThrustSample(F(k), F(g)) for k, g in enumerate((0, 1, 2, 3, 2, 0))]
    assert [float(d) for d in pchip_slopes(samples)] == pytest.approx([0, 1, 1, 0, -4 / 3, 0])


def test_normalisation_and_threshold():
    times = [F(k) for k in range(5)]
    thrusts = [F("-0.01"), F("0.02"), F(2), F("0.1"), F(0)]
    gains = [s.gain for s in normalised(times, thrusts, zero_below=F("0.05"))]
    assert gains == [0, 0, 1, F("0.05"), 0]
    gains = [s.gain for s in normalised(times, thrusts, zero_below=F("0.05"), full_thrust=F(4))]
    assert gains == [0, 0, F(1, 2), 0, 0]
    with pytest.raises(ValueError, match="zero_below must lie in"):
        normalised(times, thrusts, zero_below=F(1))


def test_the_example_keeps_every_digit():
    from pathlib import Path

    import intermit
    from intermit.scenario import load_scenario

    scenario = load_scenario(Path(intermit.__file__).parent / "examples" / "measured.toml")
    schedule = scenario.schedule
    (window,) = schedule.windows
    assert (window.on, window.off) == (F("0.3"), F("3.8"))
    assert float(schedule.gain(0.4)) == pytest.approx(0.506 / 1.05, rel=1e-15)
    piece = next(p for p in schedule.profile.pieces if p.start == F("0.4"))
    assert poly.evaluate(piece.shape, F(0)) == F("0.506") / F("1.05")
