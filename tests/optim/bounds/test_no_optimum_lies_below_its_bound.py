"""On random problems no optimum found is below its certified bound."""

import math
from fractions import Fraction

import numpy as np
import pytest
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.models.rigid_body import RigidBody
from intermit.models.schedule import PiecewisePolynomial
from intermit.optim.bounds import PathOptions, certified_lower_bound
from intermit.optim.peak.search.minimum_peak import minimum_peak
from intermit.optim.peak.search.options import MultiStart
from intermit.optim.problem import TransferProblem, quaternion_from_axis_angle

COARSE = PathOptions(degree=4, tolerance=4e-3, components=False)
FULL = PathOptions(degree=4, tolerance=4e-3)
SEARCH = MultiStart(starts=2)


def random_body(random):
    """Axis ratios up to 3 that a rigid body can have, axes turned anyhow, entries rational."""
    moments = random.uniform(1, 3, 3)
    while 2 * moments.max() >= moments.sum():
        moments = random.uniform(1, 3, 3)
    axes = np.linalg.qr(random.standard_normal((3, 3)))[0]
    J = axes @ np.diag(moments) @ axes.T
    rows = [[Fraction(round(float(J[i, j]) * 10**4), 10**4) for j in range(3)] for i in range(3)]
    return RigidBody.from_rows([[rows[min(i, j)][max(i, j)] for j in range(3)] for i in range(3)])


def random_window(random):
    """One to four windows on [0, T]; the last one ends at T."""
    count = int(random.integers(1, 5))
    edges = np.cumsum(random.uniform(0.5, 3, 2 * count))
    knots = [Fraction(0), *(Fraction(round(float(x) * 1000), 1000) for x in edges)]
    shapes = [(Fraction(1),) if i % 2 else () for i in range(2 * count)]
    return PiecewisePolynomial(tuple(knots), tuple(shapes))


def problems(seed, windows):
    """Problems of one body and turn, to share potentials: norms in turn, every third one tumbling.

    Which third depends on the seed, so that both norms meet tumbling starts.
    """
    random = np.random.default_rng(seed)
    body = random_body(random)
    attitude = quaternion_from_axis_angle(random.standard_normal(3), random.uniform(0.3, math.pi))
    for number in range(windows):
        rate = 0.03 * random.standard_normal(3) if (number + seed) % 3 == 2 else np.zeros(3)
        x, y, z = (Fraction(round(float(w) * 10**4), 10**4) for w in rate)
        norm = LARGEST_COMPONENT if number % 2 else EUCLIDEAN
        window = random_window(random)
        yield TransferProblem(body=body, window=window, attitude=attitude, rate=(x, y, z), norm=norm)


def check(seed, windows, options, search=None):
    """Ratios bound/optimum of the problems whose optimum was checked."""
    ratios = []
    for problem in problems(seed, windows):
        answer = minimum_peak(problem, search=search)
        if answer.standing.name != "CHECKED":
            continue
        bound = certified_lower_bound(problem, options=options)
        assert bound.value <= answer.peak, (seed, bound, answer.peak)
        ratios.append((problem, bound.value / answer.peak))
    return ratios


@pytest.mark.slow
@pytest.mark.parametrize("seed", range(5))
def test_thirty_problems_over_five_bodies(seed):
    """A body's problems share their potentials, so that more of them cost less than more bodies."""
    ratios = check(seed, 6, FULL if seed == 1 else COARSE, SEARCH)
    assert len(ratios) >= 3
    assert max(ratio for problem, ratio in ratios if problem.starts_at_rest) > 0.6  # and it is near


def test_a_bound_too_high_would_be_noticed():
    """From rest the optimum of a one-window turn is near enough to its bound to catch 1.5 times that."""
    problem = next(iter(problems(3, 1)))
    bound = certified_lower_bound(problem, options=COARSE)
    assert 1.5 * bound.value > minimum_peak(problem, search=SEARCH).peak


@pytest.mark.soak
@pytest.mark.parametrize("seed", range(5, 62))
def test_three_hundred_more_problems(seed):
    check(seed, 6, FULL, SEARCH)
