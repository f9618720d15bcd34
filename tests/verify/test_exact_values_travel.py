"""Exact polynomials come back from other processes as they were sent, and equal ones count as one."""

import pickle
from fractions import Fraction

from intermit.verify.exact.polynomial import Ring


def test_a_polynomial_survives_pickling():
    ring = Ring(["x", "y"], ["y"])
    x, y = ring.symbol("x"), ring.symbol("y")
    sent = (x + Fraction(1, 3) * y) * x / y
    back = pickle.loads(pickle.dumps(sent))  # noqa: S301  our own bytes
    assert back.terms == sent.terms
    assert {sent, x * x / y + Fraction(1, 3) * x} == {sent}
    assert back.ring.names == ring.names
