"""Certified bound <= optimum found, and the gap is small where the theory says it should be."""

import math
from fractions import Fraction

import pytest
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import Hermite, PiecewisePolynomial, Window, build_schedule
from intermit.optim.bounds import certified_lower_bound
from intermit.optim.norms import LargestComponent
from intermit.optim.problem import Terminal, TransferProblem, quaternion_from_axis_angle

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
SPHERE = RigidBody.from_rows([[1, 0, 0], [0, 1, 0], [0, 0, 1]])
PAPER = build_schedule(
    [Window(Fraction(1, 100), Fraction(321, 100))], shape=Hermite(Fraction(1, 100)), period=Fraction(8)
)
TURN = quaternion_from_axis_angle((1, 1, 1), math.radians(120))


def through(body, horizon, **options):
    return TransferProblem.through(PAPER, body=body, horizon=horizon, attitude=TURN, **options)


@pytest.mark.parametrize(("horizon", "optimum"), [("11.22", 0.2305583), ("51.22", 0.0189993)])
def test_j1_within_one_percent(horizon, optimum):
    bound = certified_lower_bound(through(J1, horizon))
    assert 0.99 * optimum <= bound.value <= optimum
    assert bound.name == "shortest path"


def test_equal_inertias_are_exact():
    window = PiecewisePolynomial((Fraction(0), Fraction(10)), ((Fraction(1),),))
    problem = TransferProblem(body=SPHERE, window=window, attitude=quaternion_from_axis_angle((1, 2, 3), 2.0))
    bound = certified_lower_bound(problem)
    assert 0.08 * (1 - 1e-9) <= bound.value <= 0.08


def test_scaling_the_inertia_scales_the_bound():
    double = RigidBody.from_rows([[2 * x for x in row] for row in J1.exact_inertia])
    one, two = certified_lower_bound(through(J1, 20)), certified_lower_bound(through(double, 20))
    assert two.value == pytest.approx(2 * one.value, rel=3e-3)


def test_tolerance_lowers_the_bound():
    loose = Terminal(attitude=Fraction(1, 100), rate=Fraction(1, 100))
    exact, near = (
        certified_lower_bound(through(J1, 20)),
        certified_lower_bound(through(J1, 20, terminal=loose)),
    )
    assert 0.7 * exact.value < near.value < exact.value


@pytest.mark.slow
@pytest.mark.parametrize(("degrees", "optimum"), [(45, 0.03052295), (90, 0.05861805)])
def test_largest_component_of_equal_inertias(degrees, optimum):
    window = PiecewisePolynomial((Fraction(0), Fraction(10)), ((Fraction(1),),))
    attitude = quaternion_from_axis_angle((0, 0, 1), math.radians(degrees))
    problem = TransferProblem(body=SPHERE, window=window, attitude=attitude, norm=LargestComponent())
    bound = certified_lower_bound(problem)
    assert 0.83 * optimum <= bound.value <= optimum
    assert bound.name == "components"
    assert bound.value > 1.2 * {b.name: b.value for b in bound.all}["Euclidean shortest path"]
