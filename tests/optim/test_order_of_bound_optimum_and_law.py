"""certified bound <= optimum <= law: an inversion stops the run."""

import pytest
from intermit.optim.comparison.equal_terms import OrderError, check_order


def test_right_order_passes():
    check_order(1.0, 1.01, 2.0, what="x")
    check_order(1.0, None, None, what="x")


@pytest.mark.parametrize(("bound", "optimum", "law"), [(1.01, 1.0, 2.0), (1.0, 2.1, 2.0), (3.0, None, 2.0)])
def test_inversions_stop(bound, optimum, law):
    with pytest.raises(OrderError, match="exceeds"):
        check_order(bound, optimum, law, what="x")
