"""mu1 and mu2 enclose what sampling finds, meet known values, and vanish exactly at the longest zero run."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from intermit.models.schedule import Hermite, PiecewisePolynomial, Ramps, Schedule, Window, build_schedule
from intermit.models.schedule.polynomial import polynomial
from intermit.verify.exact.bernstein import least_value
from intermit.verify.schedule import excitation as module
from intermit.verify.schedule.excitation import excitation, excitation_claim
from intermit.verify.schedule.moving_integral import MovingIntegral
from intermit.verify.schedule.zero_runs import default_length, longest_zero_run, missable_windows
from intermit.verify.verdict import Verdict

F = Fraction


def paper(windows=1, period=8):
    table = [Window(8 * k + F("0.01"), 8 * k + F("3.21")) for k in range(windows)]
    return build_schedule(table, Hermite(F("0.01")), period=None if period is None else F(period * windows))


def irregular(seed, windows, period):
    rng = np.random.default_rng(seed)
    table, t = [], F(0)
    for _ in range(windows):
        on = t + F(int(rng.integers(1, 900)), 100)
        t = on + F(int(rng.integers(50, 400)), 100)
        table.append(Window(on, t))
    shape = Hermite() if seed % 2 else Ramps(F("0.2"), F("0.3"))
    return build_schedule(table, shape, period=t + 1 if period else None)


def test_paper_over_its_period_is_its_integral():
    """Over one period the moving integral is constant: the paper's 2.198 s, exactly."""
    result = excitation(paper(), F(8))
    assert result.least.low == result.greatest.high == F("2.198")
    assert longest_zero_run(paper()).length == F("4.79")
    assert default_length(paper()) == 8


@pytest.mark.parametrize("period", [True, False])
@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("share", [F(1, 3), F("1.1"), F("2.7")])
def test_no_sampled_interval_leaves_the_enclosure(seed, period, share):
    schedule = irregular(seed, 7, period)
    length = share * default_length(schedule)
    result = excitation(schedule, length)
    domain = schedule.end if period else max(schedule.end - length, F(0))
    rng = np.random.default_rng(seed)
    for k in rng.integers(0, 10**6, 60):
        t = domain * F(int(k), 10**6)
        assert result.least.low <= schedule.square_integral(t, t + length) <= result.greatest.high
    for bound, value in ((result.least, result.least.high), (result.greatest, result.greatest.low)):
        assert bound.high - bound.low <= F(1, 10**12) * length
        # the stated instant attains the inner end, exactly
        assert schedule.square_integral(bound.instant, bound.instant + length) == value


def test_enclosures_are_tight_against_a_dense_grid():
    """A grid of step h misses the minimum of a C1 function with |F''| <= c by at most c h^2 / 8."""
    schedule, length = paper(), F(6)
    result = excitation(schedule, length)
    step = F(8, 4000)
    found = min(schedule.square_integral(k * step, k * step + length) for k in range(4000))
    curvature = 2 * 2 * 1.5 / 0.8  # |d(g^2)/dt| <= 2 max|g| max|g'|, twice
    assert 0 <= float(found - result.least.high) <= curvature * float(step) ** 2 / 8


@pytest.mark.parametrize(("excess", "verdict"), [(F(0), Verdict.REFUTED), (F(1, 10**6), Verdict.PROVED)])
def test_the_infimum_is_not_attained(excess, verdict):
    claim = excitation_claim(paper(), F("4.79") + excess)
    assert claim.verdict is verdict
    if verdict is Verdict.REFUTED:
        assert claim.witness.values["time"] == 3.22
        assert "from 3.22 s to 8.01 s" in claim.witness.description


def test_a_finite_table_says_that_it_ends():
    claim = excitation_claim(paper(windows=3, period=None), F(8))
    assert claim.verdict is Verdict.PROVED
    assert "only a table that repeats excites for ever" in claim.statement
    assert "since the table repeats" in excitation_claim(paper(windows=3), F(8)).statement


def test_no_thrust_at_all_is_refuted():
    profile = PiecewisePolynomial((F(0), F(4)), (polynomial(),))
    schedule = Schedule((Window(F(1), F(2)),), profile)
    for length in (F(1), F(4), F(9)):
        assert excitation_claim(schedule, length).verdict is Verdict.REFUTED


def test_thrust_without_a_pause_excites_over_any_interval():
    profile = PiecewisePolynomial((F(0), F(4)), (polynomial(1),))
    schedule = Schedule((Window(F(0), F(4)),), profile, period=F(4))
    claim = excitation_claim(schedule, F(1, 10**9))
    assert claim.verdict is Verdict.PROVED
    assert excitation(schedule, F(13)).least.low == 13


def test_length_must_be_positive():
    with pytest.raises(ValueError, match="must be > 0 s, received 0"):
        excitation(paper(), F(0))


@pytest.mark.parametrize("seed", range(4))
def test_screening_changes_nothing(seed, monkeypatch):
    """What floats ruled out held no extreme: the same enclosures with and without them."""
    schedule = irregular(seed, 60, period=True)
    length = F("1.2") * default_length(schedule)
    exact = excitation(schedule, length)
    monkeypatch.setattr(module, "MAX_EXACT", 0)
    monkeypatch.setattr("intermit.verify.schedule.excitation_screen.FEW", 1)
    screened = excitation(schedule, length)
    assert screened.exact_segments < exact.exact_segments / 4
    tolerance = F(1, 10**12) * length
    for a, b in ((exact.least, screened.least), (exact.greatest, screened.greatest)):
        assert abs(a.low - b.low) <= tolerance
        assert abs(a.high - b.high) <= tolerance


def test_equal_windows_are_decided_once(monkeypatch):
    """Counted: a table of equal windows needs no more exact polynomials than a short one."""
    monkeypatch.setattr(module, "MAX_EXACT", 0)
    few, many = (excitation(paper(windows=n), F(6)) for n in (20, 200))
    assert many.segments > 9 * few.segments
    assert many.exact_segments <= few.exact_segments
    assert many.least.low == few.least.low


def test_segments_add_up():
    """The pieces of the moving integral join: value + increment at 1 is the next value."""
    for schedule in (irregular(3, 5, period=True), irregular(3, 5, period=False)):
        for length in (F(3), F(7), schedule.end - 1, schedule.end, 3 * schedule.end + 2):
            moving = MovingIntegral(schedule, length)
            segments = list(moving.segments())
            assert sum(s.width for s in segments) == moving.domain
            for a, b in pairwise(segments):
                assert moving.value(a) + sum(moving.increment(a)) == moving.value(b)
            first = schedule.square_integral(
                F(0), min(length, schedule.end) if not schedule.period else length
            )
            assert moving.value(segments[0]) == first


def test_missable_windows_flip_the_claim():
    schedule, length = irregular(5, 9, period=True), F(30)
    count = missable_windows(schedule, length)
    assert count >= 1
    for missed, holds in ((count, True), (count + 1, False)):
        worst = F(0)
        windows = schedule.windows
        for i in range(len(windows)):
            later = windows[(i + missed + 1) % 9].on + schedule.period * ((i + missed + 1) // 9)
            worst = max(worst, later - windows[i].off)
        assert (worst < length) is holds
    assert missable_windows(paper(), F(100)) == 11
    assert missable_windows(paper(), F("4.79")) is None
    assert missable_windows(paper(windows=3, period=None), F(9)) == 0
    assert missable_windows(paper(windows=3, period=None), F(100)) == 3


def test_least_value_of_a_known_polynomial():
    """(s - 1/3)^2 - 1 has its minimum -1 at 1/3, which no bisection hits."""
    square = polynomial(F(1, 9) - 1, F(-2, 3), 1)
    found = least_value([polynomial(5), square], F(1, 10**12))
    assert found.low <= -1 <= found.high
    assert found.high - found.low <= F(1, 10**12)
    assert found.index == 1
    assert abs(found.argument - F(1, 3)) < F(1, 10**5)
