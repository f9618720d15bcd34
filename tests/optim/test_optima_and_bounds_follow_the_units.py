"""Least peaks and their bounds scale as inertia over time squared, in any units."""

import math
from fractions import Fraction

import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.bounds import PathOptions, certified_lower_bound
from intermit.optim.peak.search.minimum_peak import minimum_peak
from intermit.optim.problem import Terminal, TransferProblem, quaternion_from_axis_angle
from problems import J1

F = Fraction
SCALES = [(F(1, 10**6), F(1000)), (F(10**8), F(1, 1000))]
"""Of inertia and of time: the ends of what is meant to work, crossed."""
QUICK = PathOptions(degree=3, tolerance=1e-2)
SLOW = ("0.002", "-0.001", "0.003")
FASTER = ("0.03", "0.02", "0.04")


def transfer(inertia, time, norm, rate=(0, 0, 0), end=0):
    """70 deg about (1, 1, 1) through two windows."""
    knots = tuple(k * time for k in (F(0), F(4), F(6), F(10)))
    return TransferProblem(
        body=RigidBody.from_rows([[x * inertia for x in row] for row in J1.exact_inertia]),
        window=PiecewisePolynomial(knots, ((F(1),), (), (F(1),))),
        attitude=quaternion_from_axis_angle((1, 1, 1), math.radians(70)),
        rate=tuple(F(w) / time for w in rate),
        norm=norm,
        terminal=Terminal(rate=F(end) / time),
    )


def bound(inertia, time, *what):
    found = certified_lower_bound(transfer(inertia, time, *what), options=QUICK)
    return found.value * float(time**2 / inertia), found.name


def optimum(inertia, time, *what):
    found = minimum_peak(transfer(inertia, time, *what))
    return found.peak * float(time**2 / inertia), found.standing.name


CASES = [(EUCLIDEAN, FASTER), (LARGEST_COMPONENT,), (LARGEST_COMPONENT, SLOW, "0.0001")]


@pytest.mark.parametrize(("inertia", "time"), SCALES)
def test_an_optimum_scales(inertia, time):
    there, here = optimum(inertia, time, *CASES[0]), optimum(F(1), F(1), *CASES[0])
    assert there == (pytest.approx(here[0], rel=1e-9), here[1])


@pytest.mark.parametrize(("inertia", "time"), SCALES)
def test_a_bound_scales(inertia, time):
    """To what a coarser choice may lose: a coast ends at powers of two of a second."""
    there, here = bound(inertia, time, *CASES[0]), bound(F(1), F(1), *CASES[0])
    assert there == (pytest.approx(here[0], rel=QUICK.tolerance), here[1])


@pytest.mark.slow
@pytest.mark.parametrize("case", [1, 2])
@pytest.mark.parametrize(("inertia", "time"), SCALES)
def test_the_largest_component_scales(case, inertia, time):
    there, here = bound(inertia, time, *CASES[case]), bound(F(1), F(1), *CASES[case])
    assert there == (pytest.approx(here[0], rel=QUICK.tolerance), here[1])
    there, here = optimum(inertia, time, *CASES[case]), optimum(F(1), F(1), *CASES[case])
    assert there == (pytest.approx(here[0], rel=1e-9), here[1])


def test_a_rate_that_is_not_scaled_would_be_seen():
    """The partner: the same start rate over twice the time is another transfer."""
    twice = tuple(str(2 * F(w)) for w in FASTER)
    there, here = bound(F(1), F(2), EUCLIDEAN, twice), bound(F(1), F(1), *CASES[0])
    assert there[0] != pytest.approx(here[0], rel=0.05)
