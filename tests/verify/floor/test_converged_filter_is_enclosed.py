"""The converged filter in closed form agrees with known digits, with an integration, and with scaling."""

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify.filter import converged
from intermit.verify.filter.converged import ConvergedFilter, particular_solution
from problems import CONVERGED_FILTER_FLOOR, paper_schedule
from scipy.integrate import solve_ivp


@pytest.mark.parametrize(("as_printed", "value"), [(True, CONVERGED_FILTER_FLOOR), (False, 0.149215)])
def test_known_digits(as_printed, value):
    floor = ConvergedFilter(paper_schedule(as_printed=as_printed), F("0.525")).floor()
    assert floor.low <= floor.high < floor.low * (1 + 2e-9)
    assert floor.low == pytest.approx(value, abs=5e-7)
    assert floor.instant == pytest.approx(0.2385, abs=3e-4)


def test_the_solution_is_periodic_and_solves_the_filter():
    schedule, lam = paper_schedule(), 0.525
    motion = ConvergedFilter(schedule, F("0.525"))
    low, high = motion.at(F(0))
    assert high - low < 1e-12
    run = solve_ivp(
        lambda t, R: -lam * R + 2 * schedule.gain(t) ** 2, (0, 8), [low],
        rtol=1e-12, atol=1e-14, max_step=0.02, dense_output=True,
    )  # fmt: skip
    for t in np.linspace(0, 8, 33):
        assert run.sol(t)[0] == pytest.approx(motion.at(F(float(t)))[0], abs=1e-9)


def test_time_scaling():
    """Time stretched by 2 and lambda halved doubles R."""
    slow = build_schedule([Window(F("0.02"), F("6.42"))], Hermite(F("0.02")), period=F(16))
    low = ConvergedFilter(slow, F("0.2625")).floor().low
    assert low == pytest.approx(2 * ConvergedFilter(paper_schedule(), F("0.525")).floor().low, rel=1e-8)


def test_particular_solution_solves_its_equation():
    q = particular_solution((F(0), F(1), F(2)), F(3))
    # q' + 3 q = 2 (x + 2 x^2)^2, checked at more points than the degree
    for x in map(F, range(6)):
        value = sum((c * x**i for i, c in enumerate(q)), F(0))
        slope = sum((i * c * x ** (i - 1) for i, c in enumerate(q) if i), F(0))
        assert slope + 3 * value == 2 * (x + 2 * x * x) ** 2


def test_bad_input_is_refused():
    finite = build_schedule([Window(F(0), F(1))], Hermite())
    with pytest.raises(ValueError, match="periodic"):
        ConvergedFilter(finite, F(1))
    with pytest.raises(ValueError, match="lambda"):
        ConvergedFilter(paper_schedule(), F(0))


@pytest.mark.parametrize("decay", [F(2), F(8), F(12)])
def test_a_filter_that_nearly_empties_is_enclosed_as_tightly(decay):
    """At lambda T = 96 the least R is 1e-25 of the greatest; what bounds it must scale with it."""
    schedule = paper_schedule(as_printed=False)
    floor = ConvergedFilter(schedule, decay).floor()
    assert 0 < floor.low <= floor.high < floor.low * (1 + 2e-9)
    # over the off-interval of 4.8 s R falls by exp(-lambda 4.8), and the rise begins only then
    closing = ConvergedFilter(schedule, decay).at(F("3.21"))[1]
    assert floor.high < closing * np.exp(-4.8 * float(decay)) * (1 + 1e-9)


def test_filter_below_working_precision_is_bounded_by_zero(monkeypatch):
    monkeypatch.setattr(converged, "MAX_EVALUATIONS", 50)  # it would search in vain
    floor = ConvergedFilter(paper_schedule(), F(60)).floor()
    assert 0 <= floor.low <= floor.high
