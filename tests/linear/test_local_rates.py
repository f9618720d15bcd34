"""Floquet exponents of the linearised attitude loop, against what the theory says of them."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.laws import AdaptiveScaling, PersistenceFilter, PersistenceFilterAsPrinted, QuaternionPD
from intermit.models.linearised_attitude import local_rates
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, Ramps, Window, build_schedule

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
J2 = RigidBody.from_rows([["20", "1.2", "0.9"], ["1.2", "17", "1.4"], ["0.9", "1.4", "15"]])
PAPER = build_schedule(
    [Window(Fraction("0.01"), Fraction("3.21"))], Hermite(Fraction("0.01")), period=Fraction(8)
)
TWO = build_schedule(
    [Window(Fraction(1), Fraction(2)), Window(Fraction(3), Fraction(5))],
    Ramps(Fraction(1, 4), Fraction(1, 2)),
    period=Fraction(6),
)
FILTER = PersistenceFilter(Fraction("0.525"), Fraction(1))
ADAPTIVE = AdaptiveScaling(Fraction("0.525"), Fraction(1, 10), Fraction(1), Fraction(1, 5))


def mean_square(schedule):
    return float(schedule.square_integral(Fraction(0), schedule.period) / schedule.period)


@pytest.mark.parametrize("body", [J1, J2], ids=["J1", "J2"])
@pytest.mark.parametrize("schedule", [PAPER, TWO], ids=["paper", "two windows"])
@pytest.mark.parametrize("bandwidth", ["0.525", "0.2"])
def test_the_persistence_filter_decays_at_half_its_bandwidth(body, schedule, bandwidth):
    law = replace(FILTER, lambda_=Fraction(bandwidth))
    rates = local_rates(law, body, schedule)
    half = -float(bandwidth) / 2
    assert rates.floquet.mean_exponent == pytest.approx(half, rel=1e-10)
    # defective pairs: each exponent only to the root of rounding
    np.testing.assert_allclose(rates.floquet.exponents, half, atol=2e-6)


def test_the_exponents_are_double_and_defective():
    """(M - mu)^2 vanishes on each axis though M - mu does not: decay like t exp(-lambda t/2)."""
    floquet = local_rates(FILTER, J1, PAPER).floquet
    mu = np.exp(-0.525 / 2 * 8)
    shifted = floquet.monodromy - mu * np.eye(6)
    assert np.linalg.norm(shifted, 2) > 0.1 * mu
    assert np.linalg.norm(shifted @ shifted, 2) < 1e-9
    assert np.linalg.matrix_rank(shifted, tol=1e-7) == 3


def test_adaptive_scaling_decays_at_gain_times_mean_square():
    for k in (0.2, 1.5):
        rates = local_rates(ADAPTIVE, J1, PAPER, controller_states={"k": k})
        assert rates.controller_states["k"] == pytest.approx(k, rel=1e-12)
        assert rates.floquet.mean_exponent == pytest.approx(-k * mean_square(PAPER), rel=1e-10)
        np.testing.assert_allclose(rates.floquet.exponents, -k * mean_square(PAPER), atol=2e-6)


def test_the_filter_is_taken_on_its_periodic_motion():
    start = local_rates(FILTER, J1, PAPER).controller_states["R"]
    again = local_rates(FILTER, J1, PAPER, controller_states={"R": 7.0}).controller_states["R"]
    assert start == pytest.approx(again, rel=1e-11)
    R, dt, lam = start, 1e-3, 0.525
    for t in np.arange(0, 8, dt):  # an independent look: midpoint rule on R' = -lambda R + 2 g^2
        R = R * np.exp(-lam * dt) + 2 * float(PAPER.gain(t + dt / 2)) ** 2 * dt * np.exp(-lam * dt / 2)
    assert pytest.approx(start, rel=1e-6) == R


def test_the_law_as_printed_has_other_exponents():
    printed = PersistenceFilterAsPrinted(Fraction("0.525"), Fraction(1))
    exponents = local_rates(printed, J2, PAPER).floquet.exponents
    assert np.abs(exponents + 0.525 / 2).max() > 1e-2


def test_a_law_without_controller_states_is_analysed_too():
    floquet = local_rates(QuaternionPD(Fraction(1), Fraction(4)), J1, PAPER).floquet
    assert floquet.is_stable
    # Liouville: the trace of w' by w is -g^2... times derivative gain: mean(g) tr(J^-1) here
    gain = (0.8 / 2 + 1.6 + 0.81 / 2) / 8
    expected = -4 * gain * np.trace(np.linalg.inv(J1.inertia)) / 6
    assert floquet.mean_exponent == pytest.approx(expected, rel=1e-9)


def test_what_cannot_be_analysed_is_refused():
    table = build_schedule([Window(Fraction(0), Fraction(3))], Hermite())
    with pytest.raises(ValueError, match="periodic"):
        local_rates(FILTER, J1, table)
    with pytest.raises(ValueError, match="no controller state q"):
        local_rates(FILTER, J1, PAPER, controller_states={"q": 1.0})
