"""The travel proved between two attitudes is at most the length of any path between them."""

import math
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from intermit.models.rigid_body import RigidBody
from intermit.optim.bounds import polynomials as poly
from intermit.optim.bounds.chart import chart_between
from intermit.optim.bounds.fit import Fit
from intermit.optim.bounds.momentum_sets import UnitBall
from intermit.optim.bounds.prove import BranchAndBound
from intermit.optim.bounds.rate import exact_inverse, momentum_rate_polynomials
from intermit.optim.bounds.separation import Target, cheap_separation, separation
from intermit.optim.problem import quaternion_from_axis_angle

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
PRINCIPAL = RigidBody.from_rows([[1, 0, 0], [0, 2, 0], [0, 0, 3]])


def product(a, b):
    return np.concatenate(
        [[a[0] * b[0] - a[1:] @ b[1:]], a[0] * b[1:] + b[0] * a[1:] + np.cross(a[1:], b[1:])]
    )


def turn(theta):
    size = np.linalg.norm(theta)
    return np.concatenate([[np.cos(size / 2)], 0.5 * np.sinc(size / (2 * np.pi)) * theta])


def logarithm(q):
    size = np.linalg.norm(q[1:])
    return 2 * math.atan2(size, q[0]) * q[1:] / size if size > 0 else 2 * q[1:]


def broken_path_length(q, corners, inertia):
    """Length in |J w| of the path q -> corners -> 1, each leg a rotation about a fixed body axis."""
    stations = [q, *corners, np.array([1.0, 0, 0, 0])]
    total = 0.0
    for a, b in pairwise(stations):
        step = logarithm(product(a * [1, -1, -1, -1], b))
        total += float(np.linalg.norm(inertia @ step))
    return total


def proved(body, axis, degrees, guess, degree=5):
    q = quaternion_from_axis_angle(axis, math.radians(degrees))
    momenta = UnitBall(body)
    return q, separation(
        body,
        q,
        Target(),
        momenta,
        guess=guess,
        fit=Fit(degree=degree),
        prover=BranchAndBound(),
    )


def shortest_found(body, q, random, tries):
    """Shortest of random broken paths, improved by random bending: an upper estimate of the distance."""
    unit = np.array([float(x) for x in q])
    unit /= np.linalg.norm(unit)
    theta = logarithm(unit)
    middle = [turn(theta * s) for s in (0.75, 0.5, 0.25)]
    best = broken_path_length(unit, middle, body.inertia)
    size = 0.3
    for _ in range(tries):
        trial = [product(c, turn(size * random.standard_normal(3))) for c in middle]
        length = broken_path_length(unit, trial, body.inertia)
        if length < best:
            best, middle = length, trial
        else:
            size = max(0.995 * size, 1e-3)
    return best


def test_j1_is_within_half_a_percent_of_the_shortest_path():
    q, found = proved(J1, (1, 1, 1), 120, 5.95)
    upper = shortest_found(J1, q, np.random.default_rng(1), 3000)
    assert float(found.travel) <= upper
    assert float(found.travel) >= 0.99 * upper
    assert float(found.travel) > float(cheap_separation(q, Target(), UnitBall(J1).fastest_rate())) * 1.25


def test_ten_thousand_paths_are_no_shorter():
    """Between random points of the region the potential differs by no more than any path's length."""
    random = np.random.default_rng(5)
    _, found = proved(PRINCIPAL, (1, 2, 3), 100, 4.2)
    chart, scale = found.chart, float(found.chart.outer)
    table = poly.exponents(5)
    c = poly.as_table(found.potential, 5)
    region = poly.as_table(chart.region, 4)

    def value(coefficients, x, degree):
        return sum(
            k * np.prod(x ** np.array(e)) for k, e in zip(coefficients, poly.exponents(degree), strict=True)
        )

    checked, closest = 0, 0.0
    while checked < 10_000:
        x = random.uniform(-0.7, 0.7, 3)
        if value(region, x, 4) < 0 or np.linalg.norm(x) > 1:
            continue
        unscaled = scale * x
        q = np.concatenate([[1 - unscaled @ unscaled], 2 * unscaled]) / (1 + unscaled @ unscaled)
        axis = random.standard_normal(3)
        axis *= random.uniform(0.02, 0.4) / np.linalg.norm(axis)
        leg = [product(q, turn(s * axis)) for s in np.linspace(0, 1, 5)]
        points = [w[1:] / (1 + w[0]) / scale for w in leg]
        if any(value(region, p, 4) < 0 or np.linalg.norm(p) > 1 for p in points):
            continue
        length = float(np.linalg.norm(PRINCIPAL.inertia @ axis))
        rise = abs(value(c, points[-1], 5) - value(c, points[0], 5))
        assert rise <= length * found.supremum.value * (1 + 1e-12)
        closest = max(closest, rise / length / found.supremum.value)
        checked += 1
    assert closest > 0.98  # the inequality is not idle
    assert len(table) == len(c)


def test_a_supremum_taken_too_small_is_caught():
    """The proved supremum lies between the largest sampled rate and a little more."""
    chart = chart_between(quaternion_from_axis_angle((1, 1, 1), 2.0), 1.2)
    potential = {(1, 0, 0): Fraction(3), (0, 2, 1): Fraction(-1), (1, 1, 1): Fraction(2)}
    rate = momentum_rate_polynomials(potential, exact_inverse(J1.exact_inertia), chart.outer)
    found = BranchAndBound().supremum(rate, chart.region, UnitBall(J1), degree=4)
    random = np.random.default_rng(0)
    region, best = poly.as_table(chart.region, 4), 0.0
    E = np.array(poly.exponents(4))
    x = random.uniform(-1, 1, (40_000, 3))
    monomials = (x[:, None, :] ** E[None]).prod(axis=2)
    inside = (monomials @ region >= 0) & ((x * x).sum(axis=1) <= 1)
    v = np.stack([monomials @ poly.as_table(p, 4) for p in rate], axis=1)
    best = np.linalg.norm(v, axis=1)[inside].max()
    assert best <= found.value <= 1.02 * best
    assert np.linalg.norm(v, axis=1).max() > found.value  # outside the region it is exceeded


@pytest.mark.parametrize("degrees", [20, 90, 179, 200, 340])
def test_angle_alone(degrees):
    q = quaternion_from_axis_angle((1, 2, 2), math.radians(degrees))
    cheap = cheap_separation(q, Target(), Fraction(1))
    assert math.radians(degrees) * (1 - 1e-9) < float(cheap) <= math.radians(degrees) * (1 + 1e-15)
    assert cheap_separation(q, Target(Fraction(1, 100)), Fraction(1)) < cheap
