"""What windows allow is integrated exactly, and the peak it asks for is right to the last digit."""

from fractions import Fraction

import numpy as np
from intermit.models.schedule import Hermite, PiecewisePolynomial, Window, build_schedule
from intermit.optim.bounds.windows.travel import WindowTravel, least_peak, momentum_peak
from intermit.optim.problem import WindowProfile, window_profile
from intermit.verify.exact.rounding import rounded_down
from scipy.integrate import quad

PAPER = build_schedule(
    [Window(Fraction(1, 100), Fraction(321, 100))], shape=Hermite(Fraction(1, 100)), period=Fraction(8)
)


def one_window(horizon):
    return PiecewisePolynomial((Fraction(0), Fraction(horizon)), ((Fraction(1),),))


def test_one_window_gives_four_times_angle_over_time_squared():
    found = least_peak(WindowTravel(one_window(10)), Fraction(2), Fraction(0), Fraction(0))
    assert found.value == Fraction(4 * 2, 100)


def test_against_quadrature():
    windows = WindowTravel(window_profile(PAPER, Fraction("27.22"), WindowProfile.GAIN))

    def up(t):
        return float(windows.up(Fraction(t)))

    for s in (0.5, 3.1, 9.0, 20.0):
        exact = windows.area(Fraction(s))
        knots = [float(k) for k in windows.window.knots]
        left = quad(up, 0, s, points=[k for k in knots if 0 < k < s], limit=400)[0]
        right = quad(
            lambda t: float(windows.total) - up(t),
            s,
            27.22,
            points=[k for k in knots if s < k < 27.22],
            limit=400,
        )[0]
        assert np.isclose(float(exact), left + right, rtol=1e-9)
    gain = quad(lambda t: float(PAPER.gain(t)), 0, 3.22, points=[0.81, 2.41])[0]
    assert np.isclose(up(8.0), gain, rtol=1e-12)


def test_start_momentum_lowers_the_peak_and_must_be_absorbed():
    windows = WindowTravel(window_profile(PAPER, Fraction(20), WindowProfile.FULL))
    rest = least_peak(windows, Fraction(6), Fraction(0), Fraction(0)).value
    moving = least_peak(windows, Fraction(6), Fraction(1, 10), Fraction(0)).value
    fast = least_peak(windows, Fraction(6), Fraction(10), Fraction(0)).value
    assert rest > moving > fast == 0
    assert momentum_peak(windows, Fraction(10), Fraction(0)) == 10 / windows.total


def test_every_instant_is_valid_and_the_chosen_nearly_best():
    windows = WindowTravel(window_profile(PAPER, Fraction("51.22"), WindowProfile.FULL))
    travel, start, end = Fraction(6), Fraction(1, 50), Fraction(1, 100)
    best = least_peak(windows, travel, start, end).value
    others = []
    for k in range(1, 64):
        s = windows.horizon * k / 64
        others.append((travel - start * s - end * (windows.horizon - s)) / windows.area(s))
    assert max(others) <= best * (1 + Fraction(1, 10**6))


def test_rounding_goes_down():
    for x in (Fraction(1, 3), Fraction(2, 3), Fraction(1, 4), Fraction(-1, 3)):
        assert Fraction(rounded_down(x)) <= x
