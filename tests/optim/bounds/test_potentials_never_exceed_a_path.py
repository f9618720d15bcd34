"""The travel proved between two attitudes is at most the length of any path between them."""

import math
from fractions import Fraction
from itertools import pairwise

import numpy as np
import pytest
from intermit.models.norms import LARGEST_COMPONENT
from intermit.models.rigid_body import RigidBody
from intermit.optim.bounds.potential.fit import Fit
from intermit.optim.bounds.potential.prove import BranchAndBound
from intermit.optim.bounds.potential.separation import (
    Target,
    potential_program,
    quick_separation,
    separation,
)
from intermit.optim.bounds.sets import polynomials as poly
from intermit.optim.bounds.sets.chart import chart_between
from intermit.optim.bounds.sets.gauge import invariant_set
from intermit.optim.bounds.sets.momentum_sets import UnitBall
from intermit.optim.bounds.sets.rate import momentum_rate_polynomials
from intermit.optim.problem import quaternion_from_axis_angle
from problems import UNIT
from transfers import TETRAHEDRON

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
PRINCIPAL = RigidBody.from_rows([[1, 0, 0], [0, 2, 0], [0, 0, 3]])
SLIM = RigidBody.from_rows([[3, 0, "0.3"], [0, "2.9", 0], ["0.3", 0, 1]])


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


def proved(momenta, q, guess, fit, tolerance=1e-3):
    program = potential_program(momenta.body, q, Target(), momenta, guess=guess, fit=fit)
    return separation(momenta.body, q, Target(), program, BranchAndBound(tolerance=tolerance))


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
    q = quaternion_from_axis_angle((1, 1, 1), math.radians(120))
    found = proved(UnitBall(J1), q, 5.95, Fit(degree=5))
    upper = shortest_found(J1, q, np.random.default_rng(1), 3000)
    assert float(found.travel) <= upper
    assert float(found.travel) >= 0.99 * upper
    assert float(found.travel) > float(quick_separation(q, Target(), UnitBall(J1).fastest_rate())) * 1.25


def momentum_sets():
    """Sets of every kind, for inertias of axis ratio 1 to 3."""
    cube, tetrahedron = invariant_set(J1, LARGEST_COMPONENT), invariant_set(PRINCIPAL, TETRAHEDRON)
    slim = invariant_set(SLIM, LARGEST_COMPONENT)
    return [
        UnitBall(PRINCIPAL),
        UnitBall(J1),
        UnitBall(SLIM),
        cube,
        tetrahedron,
        slim.with_box((Fraction(6, 5), Fraction(13, 10), Fraction(1))),
        invariant_set(UNIT, LARGEST_COMPONENT).with_box((Fraction(1),) * 3),
    ]


def potentials():
    """One or two of each set, for random turns: ten thousand pairs are shared among them."""
    random = np.random.default_rng(11)
    for momenta in momentum_sets():
        for degree in (3, 5) if isinstance(momenta, UnitBall) else (3,):
            axis, angle = random.standard_normal(3), random.uniform(0.6, 2.2)
            q = quaternion_from_axis_angle(axis, angle)
            fit = Fit(degree=degree, pool=1500, first=250, rounds=6, proofs=1)
            yield momenta, proved(momenta, q, 1.02 * momenta.straight_travel(axis, angle), fit, 5e-3)


def gauge(momenta, H):
    """Least n with H in n K, for momenta (n, 3)."""
    if isinstance(momenta, UnitBall):
        return np.linalg.norm(H, axis=1)
    rows = np.array([[[float(x) for x in row] for row in M] for M in momenta.matrices])
    levels = np.array([float(g) for g in momenta.levels])
    return np.sqrt((np.einsum("ni,kij,nj->nk", H, rows, H) / levels).max(axis=1))


def polynomial(coefficients, x):
    """Value at points (n, 3)."""
    return sum(float(c) * (x ** np.array(e)).prod(axis=1) for e, c in coefficients.terms.items())


def turned(q, theta):
    """Quaternions (n, 4) after body rotations by the vectors (n, 3)."""
    half = np.linalg.norm(theta, axis=1, keepdims=True) / 2
    c, v = np.cos(half), 0.5 * np.sinc(half / np.pi) * theta
    scalar = q[:, :1] * c - (q[:, 1:] * v).sum(axis=1, keepdims=True)
    return np.concatenate([scalar, q[:, :1] * v + c * q[:, 1:] + np.cross(q[:, 1:], v)], axis=1)


def random_legs(found, random, count):
    """Starts (n, 4) in the chart, rotation vectors (n, 3) and scaled ends, of legs inside the region."""
    scale = float(found.chart.outer)
    x = random.uniform(-1, 1, (6 * count, 3))
    unscaled = scale * x
    square = (unscaled * unscaled).sum(axis=1, keepdims=True)
    q = np.concatenate([1 - square, 2 * unscaled], axis=1) / (1 + square)
    axis = random.standard_normal(x.shape)
    axis *= random.uniform(0.02, 0.4, (len(x), 1)) / np.linalg.norm(axis, axis=1, keepdims=True)
    inside, ends = np.ones(len(x), dtype=bool), []
    for s in np.linspace(0, 1, 5):
        w = turned(q, s * axis)
        point = w[:, 1:] / (1 + w[:, :1]) / scale
        inside &= (polynomial(found.chart.region, point) >= 0) & ((point * point).sum(axis=1) <= 1)
        ends.append(point)
    keep = np.flatnonzero(inside)[:count]
    return axis[keep], ends[0][keep], ends[-1][keep]


def test_ten_thousand_paths_are_no_shorter():
    """Between random points of its region no potential differs by more than a path's travel."""
    random = np.random.default_rng(5)
    checked, closest = 0, []
    for momenta, found in potentials():
        axis, start, end = random_legs(found, random, 1200)
        travel = gauge(momenta, axis @ momenta.body.inertia)
        rise = np.abs(polynomial(found.potential, end) - polynomial(found.potential, start))
        ratio = rise / (travel * found.supremum.value)
        assert ratio.max() <= 1 + 1e-12, (momenta.key(), found.travel)
        closest.append(ratio.max())
        checked += len(axis)
    assert checked >= 10_000
    assert min(closest) > 0.8  # the inequality is nowhere idle
    assert max(closest) > 0.95


def test_the_angle_is_no_longer_than_a_path_either():
    """Where no potential is needed: the arc to the identity changes by at most half the fastest rate."""
    random = np.random.default_rng(6)
    q = random.standard_normal((500, 4))
    q /= np.linalg.norm(q, axis=1, keepdims=True)
    axis = random.uniform(-0.3, 0.3, (500, 3))
    for momenta in momentum_sets():
        travel = gauge(momenta, axis @ momenta.body.inertia)
        change = np.abs(np.arccos(q[:, 0]) - np.arccos(np.clip(turned(q, axis)[:, 0], -1, 1)))
        assert (change <= travel * float(momenta.fastest_rate()) / 2 * (1 + 1e-9) + 1e-9).all()


def test_a_supremum_taken_too_small_is_caught():
    """The proved supremum lies between the largest sampled rate and a little more."""
    chart = chart_between(quaternion_from_axis_angle((1, 1, 1), 2.0), 1.2)
    x, y, z = poly.X
    potential = x * 3 - y**2 * z + x * y * z * 2
    rate = momentum_rate_polynomials(potential, J1.exact_inverse, chart.outer)
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
    cheap = quick_separation(q, Target(), Fraction(1))
    assert math.radians(degrees) * (1 - 1e-15) <= float(cheap) <= math.radians(degrees) * (1 + 1e-15)
    assert quick_separation(q, Target(Fraction(1, 100)), Fraction(1)) < cheap
