"""Definiteness, inverses, points of spheres and roundings are exact or lie on the side they state."""

import math
from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.attitude import conjugate, quaternion_product
from intermit.models.rigid_body import RigidBody
from intermit.verify import checker
from intermit.verify.exact import matrix
from intermit.verify.exact.ball import arc_below, arctangent_below, horner, square_root
from intermit.verify.exact.bisection import bisected
from intermit.verify.exact.direction import rational_direction, rational_quaternion, sphere_point
from intermit.verify.exact.rounding import digits_above, digits_below, grid_above, grid_below, grid_near
from problems import J1


def symmetric(random, n, rank):
    B = [[F(int(x)) for x in row] for row in random.integers(-3, 4, (rank, n))]
    return [[sum((row[i] * row[j] for row in B), F(0)) for j in range(n)] for i in range(n)]


@pytest.mark.parametrize("n", [1, 2, 3, 6])
def test_definiteness_is_what_the_checkers_elimination_says(n):
    random, seen = np.random.default_rng(n), set()
    for _ in range(40):
        A = symmetric(random, n, int(random.integers(1, n + 2)))
        A[-1][-1] -= int(random.integers(0, 2)) * F(1, 10**30)
        verdicts = matrix.is_positive_definite(A), matrix.is_positive_semidefinite(A)
        assert verdicts == (checker.is_positive_definite(A), checker.is_positive_semidefinite(A))
        seen.add(verdicts)
    assert {(True, True), (False, False)} <= seen


def test_inverses_and_factors_give_the_matrix_back():
    J = J1.exact_inertia
    assert matrix.inverse(J) == J1.exact_inverse == tuple(map(tuple, checker.inverse_matrix([*map(list, J)])))
    L, D = matrix.elimination(J)
    assert (
        matrix.congruent(
            [[d if i == j else F(0) for j in range(3)] for i, d in enumerate(D)], [*zip(*L, strict=True)]
        )
        == J
    )
    with pytest.raises(ZeroDivisionError):
        matrix.inverse([[F(1), F(2)], [F(2), F(4)]])


def test_a_flat_body_is_told_from_one_beyond_flat():
    assert RigidBody.from_rows([[1, 0, 0], [0, 1, 0], [0, 0, 2]]).satisfies_triangle_inequality
    assert not RigidBody.from_rows(
        [[1, 0, 0], [0, 1, 0], [0, 0, "2.000000000000000000001"]]
    ).satisfies_triangle_inequality


def test_points_of_spheres_have_length_one_and_lie_near():
    random = np.random.default_rng(4)
    for n in (2, 3, 4):
        for _ in range(20):
            v = random.normal(size=n)
            v /= np.linalg.norm(v)
            exact = rational_direction(v.tolist())
            assert sum(x * x for x in exact) == 1
            assert max(abs(float(x) - y) for x, y in zip(exact, v, strict=True)) < 1e-15
            short = rational_direction(v.tolist(), denominator=10)
            assert max(x.denominator for x in short) < max(x.denominator for x in exact) / 2**20
    q = rational_quaternion([-0.6, 0.0, 0.8, 0.0])
    assert sum(x * x for x in quaternion_product(q, conjugate(q))) == 1
    assert sphere_point([F(1, 2)]) == (F(3, 5), F(4, 5))


def test_roots_and_arcs_are_enclosed_closely():
    for x in (F(0), F(2), F(1, 10**40), F(10**40 + 1, 7), F(9, 4)):
        low, high = square_root(x)
        assert low**2 <= x < high**2
        assert high - low == F(1, 2**96)
    assert 0 <= 4 * arctangent_below(F(1)) - F(3141592653589793, 10**15) < F(1, 10**15)
    for angle in (1e-9, 0.3, 1.6, 3.1):
        arc = arc_below([F(math.sin(angle)), F(0), F(0)], F(math.cos(angle)))
        assert float(arc) == pytest.approx(angle, rel=1e-15, abs=1e-16)
    with pytest.raises(ValueError, match="square root of -1"):
        square_root(F(-1))


@pytest.mark.parametrize("x", [F(1, 3), F(-1, 3), F(5), F(0)])
def test_grids_and_digits_round_to_their_side(x):
    low, high = grid_below(x, 20), grid_above(x, 20)
    assert low <= x <= high <= low + F(1, 2**20)
    assert abs(grid_near(x, 20) - x) <= F(1, 2**21)
    assert digits_below(float(x), 3) <= x <= digits_above(float(x), 3)


def test_an_interval_is_halved_about_the_change():
    asked = []

    def holds(x):
        asked.append(x)
        return x * x <= 2

    low, high = bisected(holds, F(0), F(2), relative=F(1, 2**20))
    assert low**2 <= 2 < high**2
    assert high - low <= high / 2**20
    assert bisected(holds, F(0), F(2), steps=3) == (F(5, 4), F(3, 2))
    assert horner([F(1), F(2), F(3)], F(2)) == 17
