"""A plant whose stability is not decided: the reason is the true one, and the next step follows from it."""

from fractions import Fraction as F

import pytest
from intermit.verify.linear.stability import SpectralRadius, _not_told, _step


@pytest.mark.parametrize(
    ("low", "high", "width", "reason", "step"),
    [
        (F(999, 1000), F(1001, 1000), 1e-15, "lies between 0.999 and 1.001", "a gain or an on-time"),
        (F(0), None, 1e-3, "", "fast and stable"),
        (F(1, 2), None, 1e-15, "", "a gain or an on-time"),
    ],
    ids=["near 1", "wide enclosure", "no upper bound"],
)
def test_reason_and_next_step_fit_what_was_found(low, high, width, reason, step):
    found = SpectralRadius(low, high, (), guess=1.0, width=width)
    assert reason in _not_told(found)
    assert step in _step(found)
