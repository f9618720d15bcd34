"""What the falsifier finds is the same in any units of inertia and time."""

from fractions import Fraction

import pytest
from intermit.models.closed_loop import close_loop
from intermit.models.laws import AdaptiveScaling
from intermit.models.rigid_body import RigidBody
from intermit.verify.lyapunov.candidates import candidate
from intermit.verify.lyapunov.falsify import Falsifier, falsify
from problems import J1

F = Fraction
SCALES = [(F(1, 10**6), F(1)), (F(10**8), F(1)), (F(1), F(1, 1000)), (F(1), F(1000))]
"""Of inertia and of time."""
QUICK = Falsifier(points=60, starts=2)


def searched(lam, inertia, time):
    """Largest V'/W found, in the first units, and whether it refutes."""
    law = AdaptiveScaling(
        lambda_=F(lam) / time,
        gamma=F("0.1") / (time * inertia),
        R0=time,
        k0=F("0.2") / time,
        a=inertia / time**2,
    )
    body = RigidBody.from_rows([[x * inertia for x in row] for row in J1.exact_inertia])
    found = falsify(candidate(close_loop(law)), body, options=QUICK)
    return found.worst * float(time), found.refutation is not None


@pytest.mark.parametrize(("inertia", "time"), SCALES)
@pytest.mark.parametrize("lam", ["0.3", "0.525"])
def test_the_worst_found_is_a_number_over_the_time(lam, inertia, time):
    """Below the sharp condition (0.3409 for this body) a state refutes, above it none does."""
    here, there = searched(lam, F(1), F(1)), searched(lam, inertia, time)
    assert there[0] == pytest.approx(here[0], rel=1e-6)
    assert here[1] == there[1] == (lam == "0.3")
