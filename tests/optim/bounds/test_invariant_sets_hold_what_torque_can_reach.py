"""Momentum under torque stays in the invariant set scaled by p up(t), and in its component bounds."""

from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import LARGEST_COMPONENT, thrusters
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.bounds.sets.gauge import invariant_set
from intermit.optim.bounds.windows.components import (
    component_bounds,
    gyroscopic_bound,
    gyroscopic_form,
    peak_from_components,
)
from intermit.optim.bounds.windows.split import Splits
from intermit.optim.bounds.windows.travel import WindowTravel
from intermit.optim.problem import TransferProblem

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
LONG = RigidBody.from_rows([[1, 0, 0], [0, 2, 0], [0, 0, 3]])
SPHERE = RigidBody.from_rows([[2, 0, 0], [0, 2, 0], [0, 0, 2]])
SIX = thrusters([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, "0.5"], [0, 0, "-0.5"]])
ONE = PiecewisePolynomial((Fraction(0), Fraction(10)), ((Fraction(1),),))


def momentum_history(body, torque, step, count):
    """H along H' = H x J^-1 H + torque(k), from rest, by classical Runge-Kutta."""
    inverse = np.linalg.inv(body.inertia)
    H = np.zeros((count + 1, 3))
    for k in range(count):

        def slope(h, force=torque[k]):
            return np.cross(h, inverse @ h) + force

        a = slope(H[k])
        b = slope(H[k] + step / 2 * a)
        c = slope(H[k] + step / 2 * b)
        d = slope(H[k] + step * c)
        H[k + 1] = H[k] + step / 6 * (a + 2 * b + 2 * c + d)
    return H


def gauge(momenta, H):
    M = np.array([[[float(x) for x in row] for row in m] for m in momenta.matrices])
    g = np.array([float(x) for x in momenta.levels])
    return np.sqrt((np.einsum("ni,kij,nj->nk", H, M, H) / g).max(axis=1))


@pytest.mark.parametrize("body", [J1, LONG, SPHERE])
@pytest.mark.parametrize("norm", [LARGEST_COMPONENT, SIX])
def test_gauge_grows_no_faster_than_the_torque(body, norm):
    momenta = invariant_set(body, norm)
    corners = np.array([[float(x) for x in t] for t in norm.corners()])
    assert gauge(momenta, corners).max() <= 1 + 1e-12
    random = np.random.default_rng(3)
    for _ in range(5):
        torque = np.repeat(corners[random.integers(len(corners), size=40)], 10, axis=0)
        H = momentum_history(body, torque, 0.02, 400)
        time = 0.02 * np.arange(401)
        assert (gauge(momenta, H) <= time * (1 + 1e-6) + 1e-12).all()


def test_the_cube_is_not_invariant():
    """What the set is for: a torque within the cube drives a component beyond p up(t)."""
    torque = np.repeat(np.array([[1.0, 1, 1]]), 400, axis=0)
    H = momentum_history(LONG, torque, 0.02, 400)
    assert (np.abs(H).max(axis=1) > 1.05 * 0.02 * np.arange(401)).any()


@pytest.mark.parametrize("momenta", [invariant_set(J1, LARGEST_COMPONENT), invariant_set(LONG, SIX)])
def test_support_is_above_every_point_of_the_set(momenta):
    random = np.random.default_rng(0)
    H = random.standard_normal((3000, 3))
    H /= gauge(momenta, H)[:, None]
    v = np.concatenate([random.standard_normal((500, 3)), np.eye(3), -np.eye(3), [[1, 1, 0], [1, 1, 1]]])
    bound, seen = momenta.support_above(v), (v @ H.T).max(axis=1)
    assert (bound >= seen).all()
    assert (bound <= 1.05 * seen).all()
    speed = np.linalg.norm(H @ np.linalg.inv(momenta.body.inertia), axis=1).max()
    assert speed <= float(momenta.fastest_rate()) <= 1.3 * speed


def test_equal_inertias_leave_the_cube():
    cube = invariant_set(SPHERE, LARGEST_COMPONENT).with_box((Fraction(1), Fraction(1), Fraction(1)))
    v = np.random.default_rng(1).standard_normal((100, 3))
    assert np.allclose(cube.support_above(v), np.abs(v).sum(axis=1), rtol=1e-9)
    assert gyroscopic_bound(cube, (Fraction(1), Fraction(1), Fraction(1)), 0)[0] == 0


def test_gyroscopic_bound_is_above_samples():
    momenta = invariant_set(LONG, LARGEST_COMPONENT)
    B = (Fraction(3, 2), Fraction(3, 2), Fraction(3, 2))
    H = np.random.default_rng(2).standard_normal((200_000, 3))
    H *= (np.random.default_rng(4).uniform(0.5, 1, len(H)) / gauge(momenta, H))[:, None]
    H = H[(np.abs(H) <= 1.5).all(axis=1)]
    for axis in range(3):
        G = np.array([[float(x) for x in row] for row in gyroscopic_form(LONG, axis)])
        direct = np.cross(H, H @ np.linalg.inv(LONG.inertia))[:, axis]
        assert np.allclose(np.einsum("ni,ij,nj->n", H, G, H), direct)
        seen = np.abs(direct[np.abs(H[:, axis]) >= 1]).max()
        bound = float(gyroscopic_bound(momenta, B, axis)[0])
        assert seen <= bound <= 2 * seen


def halves(momenta):
    """Both sides of a turn of LONG from rest, cut in the middle."""
    turn = (Fraction(1), Fraction(1), Fraction(0), Fraction(0))
    problem = TransferProblem(body=LONG, window=ONE, attitude=turn, norm=LARGEST_COMPONENT)
    return Splits(problem, momenta, WindowTravel(problem.window)).at_rest(Fraction(5)).sides


def test_components_stay_within_their_bounds():
    trial = 0.1
    momenta = invariant_set(LONG, LARGEST_COMPONENT)
    bounds = component_bounds(momenta, halves(momenta), trial)
    random = np.random.default_rng(7)
    time = 0.02 * np.arange(251)
    for _ in range(20):
        torque = trial * np.repeat(random.choice([-1.0, 1.0], (25, 3)), 10, axis=0)
        H = momentum_history(LONG, torque, 0.02, 250)
        for axis in range(3):
            assert (np.abs(H[:, axis]) <= float(bounds.B[axis]) * trial * time + 1e-9).all()


def test_a_peak_from_components_never_exceeds_its_trial():
    momenta = invariant_set(LONG, LARGEST_COMPONENT)
    sides, beta = halves(momenta), (Fraction(1), Fraction(1), Fraction(1))
    for trial in (0.01, 0.1, 1.0):
        bounds = component_bounds(momenta, sides, trial)
        p = peak_from_components(sides, bounds, beta, 1.0)
        assert 0 < p <= trial
        assert sides.allowed(p, bounds.rates, np.ones(3)) <= 1
