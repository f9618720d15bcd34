"""Bounds of irrational numbers lie on their stated side and are close; the bisection loop proves bounds."""

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.verify.exact.ball import enclose, sqrt_above, sqrt_below
from intermit.verify.exact.bisection import minimum_below
from intermit.verify.exact.matrix import (
    greatest_eigenvalue_above,
    is_positive_semidefinite,
    least_eigenvalue_below,
)
from intermit.verify.exact.rounding import rounded_down, rounded_up
from problems import J1, J2

VALUES = [F(2), F(1, 3), F(10**30 + 1), F(1, 7**20), F(9, 4)]


@pytest.mark.parametrize("value", VALUES)
def test_roots_and_rationals_are_bounded_on_their_side(value):
    assert F(sqrt_below(value)) ** 2 <= value <= F(sqrt_above(value)) ** 2
    assert sqrt_above(value) <= sqrt_below(value) * (1 + 1e-15)
    assert F(rounded_down(value)) <= value <= F(rounded_up(value))
    assert rounded_up(value) <= np.nextafter(rounded_down(value), np.inf)


def test_a_pole_has_no_enclosure():
    low, high = enclose(lambda x: x.exp(), F(1))
    assert low < high < low + 1e-15 * 3
    assert low <= np.e <= high
    with pytest.raises(ArithmeticError, match="no finite enclosure"):
        enclose(lambda x: 1 / x, F(0))


@pytest.mark.parametrize("body", [J1, J2])
def test_principal_inertias_are_bounded(body):
    J = body.exact_inertia
    least, greatest = least_eigenvalue_below(J), greatest_eigenvalue_above(J)
    assert float(least) == pytest.approx(body.principal_inertias[0], rel=1e-11)
    assert float(greatest) == pytest.approx(body.principal_inertias[-1], rel=1e-11)

    def shifted(shift):
        return [[x - (shift if i == j else 0) for j, x in enumerate(row)] for i, row in enumerate(J)]

    assert is_positive_semidefinite(shifted(least))
    assert not is_positive_semidefinite(shifted(least * (1 + F(1, 10**9))))


def test_bisection_reaches_a_true_target_and_no_false_one():
    """x^2 + y^2 on a box: the square of the distance, bounded cell by cell from its corners."""

    def bound(box):
        return sum(0.0 if a <= 0 <= b else min(a * a, b * b) for a, b in box)

    box = ((-1.0, 2.0), (0.5, 2.0))
    found = minimum_below(bound, box, target=0.24, max_evaluations=500)
    assert found.complete
    assert 0.24 <= found.value <= 0.25
    false = minimum_below(bound, box, target=0.26, max_evaluations=500)
    assert not false.complete
    assert false.value <= 0.25
    assert false.evaluations <= 500
