"""Transition and monodromy matrices of x' = (A - g B K) x, against closed forms."""

from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from intermit.models.linear import LinearPlant
from intermit.models.schedule import Hermite, Ramps, Window, build_schedule

PERIOD = Fraction(8)
WINDOW = Window(Fraction(1, 100), Fraction(321, 100))
SCHEDULE = build_schedule([WINDOW], Hermite(Fraction(1, 100)), period=PERIOD)
TABLE = build_schedule([WINDOW], Ramps(Fraction(1, 2), Fraction(1)))


def mean_gain():
    """Integral of g over a period: half of each ramp and the plateau."""
    return 0.8 / 2 + 1.6 + 0.81 / 2


def plant(A, B, K, schedule=SCHEDULE):
    return LinearPlant(np.array(A, float), np.array(B, float), np.array(K, float), schedule)


def test_a_scalar_plant_has_its_closed_form():
    result = plant([[0.3]], [[2.0]], [[0.7]]).floquet()
    exponent = 0.3 - 1.4 * mean_gain() / 8
    assert result.multipliers[0] == pytest.approx(np.exp(8 * exponent), rel=1e-13)
    assert result.exponents[0] == pytest.approx(exponent, abs=1e-14)
    assert not plant([[0.3]], [[0.1]], [[0.7]]).floquet().is_stable
    assert result.is_stable == (exponent < 0)


def test_between_windows_the_plant_runs_free():
    from scipy.linalg import expm

    A = [[0, 1], [-2, 0.1]]
    free = plant(A, [[0], [1]], [[3, 4]]).transition(Fraction(4), Fraction(8))
    np.testing.assert_allclose(free, expm(np.array(A) * 4), rtol=1e-12, atol=1e-12)


def test_the_determinant_is_liouville_s():
    A, B, K = [[0, 1], [-1, 0]], [[0], [1]], [[1.0, 1.5]]
    result = plant(A, B, K).floquet()
    trace = -1.5 * mean_gain()
    assert np.linalg.det(result.monodromy) == pytest.approx(np.exp(trace), rel=1e-12)
    assert result.mean_exponent == pytest.approx(trace / 16, rel=1e-12)


@pytest.mark.parametrize("schedule", [SCHEDULE, TABLE], ids=["periodic", "table"])
def test_simulation_agrees_with_a_general_integrator(schedule):
    from scipy.integrate import solve_ivp

    A, B, K = np.array([[0, 1.0], [0.2, -0.1]]), np.array([[0], [1.0]]), np.array([[1.0, 0.8]])
    times, x0 = np.linspace(0, 20, 41), np.array([1.0, -0.5])
    states = plant(A, B, K, schedule).simulate(x0, times)
    other, x = [x0], x0
    for a, b in pairwise(times):
        knots = [
            a,
            *(float(p.end) for p in schedule.pieces_between(Fraction(a), Fraction(b)) if p.end < b),
            b,
        ]
        for s, e in pairwise(knots):
            x = solve_ivp(
                lambda t, y: (A - float(schedule.gain(t)) * B @ K) @ y, (s, e), x,
                method="DOP853", rtol=1e-12, atol=1e-14,
            ).y[:, -1]  # fmt: skip
        other.append(x)
    np.testing.assert_allclose(states, np.array(other).T, rtol=1e-9, atol=1e-9)


def test_transitions_compose():
    p = plant([[0, 1], [-1, 0]], [[0], [1]], [[1.0, 1.5]])
    a, b, c = Fraction(1, 3), Fraction(5, 2), Fraction(19, 2)
    np.testing.assert_allclose(p.transition(a, c), p.transition(b, c) @ p.transition(a, b), atol=1e-13)


def test_an_unstable_plant_too_rarely_controlled_is_unstable():
    """The same feedback that stabilises under constant action does not through these windows."""
    A, B, K = [[0, 1], [1, 0]], [[0], [1]], [[2.0, 2.0]]
    assert np.linalg.eigvals(np.array(A) - np.array(B) @ np.array(K)).real.max() < 0
    assert not plant(A, B, K).floquet().is_stable


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (([[1, 2]], [[1]], [[1]]), "do not fit"),
        (([[np.nan]], [[1]], [[1]]), "A must be a matrix of finite numbers"),
        (([1], [[1]], [[1]]), "A must be a matrix"),
    ],
)
def test_matrices_that_do_not_fit_are_refused(arguments, message):
    with pytest.raises(ValueError, match=message):
        plant(*arguments)


def test_multipliers_need_a_period():
    with pytest.raises(ValueError, match="periodic"):
        plant([[0]], [[1]], [[1]], TABLE).floquet()
