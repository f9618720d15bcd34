"""Bernstein forms compute exactly, and a sign or a bound they prove is true."""

from fractions import Fraction as F
from itertools import pairwise, product

import pytest
from intermit.models.schedule import polynomial as poly
from intermit.verify.exact.bernstein import Bernstein, lower_bound, split

P = poly.polynomial(F(1, 3), -2, 0, F(7, 5))
Q = poly.polynomial(-1, F(1, 7), 4)
POINTS = [F(i, 7) for i in range(8)]


def value(form, x):
    return sum(
        (c * poly.evaluate(basis, x) for c, basis in zip(form.controls(), _basis(form.degree), strict=True)),
        F(0),
    )


def _basis(n):
    from math import comb

    x, rest = poly.polynomial(0, 1), poly.polynomial(1, -1)
    for j in range(n + 1):
        term = poly.polynomial(comb(n, j))
        for factor in [x] * j + [rest] * (n - j):
            term = poly.multiply(term, factor)
        yield term


def test_ring_operations_agree_with_power_form():
    p, q = Bernstein.from_powers(P), Bernstein.from_powers(Q)
    for x in POINTS:
        a, b = poly.evaluate(P, x), poly.evaluate(Q, x)
        assert value(p + q, x) == a + b
        assert value(p - q, x) == a - b
        assert value(p * q, x) == a * b
        assert value(-p, x) == -a
        assert value(p.elevated(6), x) == a


def test_slopes_are_exact_for_rationals_and_binary_floats():
    length = F(7, 30)
    for controls in ([F(1, 3), -2, F(5, 7), 1], [0.1, -3e-200, 1e12, 5e-324], [0.25], [F(1, 9), 0.3]):
        form, slope = Bernstein.with_derivative(controls, length)
        exact, n = [F(c) for c in controls], len(controls) - 1
        assert form.controls() == exact == Bernstein.from_controls(controls).controls()
        rises = [(b - a) * n / length for a, b in pairwise(exact)]
        assert slope.controls() == (rises or [0])


def test_halves_are_the_polynomial_on_the_halves():
    controls = [3, -1, 4, 1]
    left, right = split(controls)
    form = Bernstein.from_controls([F(c) for c in controls])
    for x in POINTS:
        scale = 2 ** (len(controls) - 1)
        assert value(Bernstein.from_controls([F(c, scale) for c in left]), x) == value(form, x / 2)
        assert value(Bernstein.from_controls([F(c, scale) for c in right]), x) == value(form, (1 + x) / 2)


def test_nonnegative_is_never_claimed_of_a_negative_polynomial():
    """(x - 1/3)^2 + e: provable for e > 0, with negative coefficients at first; never for e < 0."""
    square = Bernstein.from_powers(poly.polynomial(F(1, 9), F(-2, 3), 1))
    assert (square + Bernstein.constant(F(1, 100))).is_nonnegative(depth=6)
    assert not (square + Bernstein.constant(F(1, 100))).is_nonnegative(depth=0)
    assert not (square - Bernstein.constant(F(1, 10**9))).is_nonnegative(depth=12)


@pytest.mark.parametrize(("depth", "gap"), [(0, F(2)), (4, F(1, 50)), (8, F(1, 5000))])
def test_lower_bounds_are_below_and_close_in(depth, gap):
    for signs in product((-1, 1), repeat=4):
        controls = [F(s * (i + 1), 4) for i, s in enumerate(signs)]
        form = Bernstein.from_controls(controls)
        least = min(value(form, F(i, 200)) for i in range(201))
        bound = lower_bound(controls, depth)
        assert least - gap <= bound <= least
