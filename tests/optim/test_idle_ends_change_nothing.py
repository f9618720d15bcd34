"""Idle time before the first window, from rest, and after the last one, to rest, changes no optimum."""

from fractions import Fraction as F

import pytest
from intermit.models.schedule import Window, build_schedule
from intermit.models.schedule.profiles import Hermite
from intermit.optim import TransferProblem
from intermit.optim.problem import Terminal
from problems import J1


def transfer(lead=F(0), tail=F(0), rate=(0, 0, 0), terminal=None):
    windows = [Window(lead, lead + 10), Window(lead + 20, lead + 30)]
    return TransferProblem.through(
        build_schedule(windows, Hermite()),
        body=J1,
        horizon=lead + 30 + tail,
        attitude=(1, F(1, 2), F(1, 2), F(1, 2)),
        rate=rate,
        terminal=terminal,
    )


@pytest.mark.parametrize("tail", [0, 10**5])
@pytest.mark.parametrize("lead", [0, 31, 3 * 10**4, 10**9])
def test_the_transfer_left_is_the_same_exactly(lead, tail):
    shorter, origin = transfer(F(lead), F(tail)).without_idle()
    assert origin == lead
    assert shorter == transfer()


def test_short_idle_ends_are_kept():
    problem = transfer(F(5), F(5))
    assert problem.without_idle() == (problem, 0)


def test_tumbling_keeps_the_lead_and_tolerance_the_tail():
    tumbling = transfer(F(10**4), rate=(0, 0, F(1, 100)))
    assert tumbling.without_idle() == (tumbling, 0)
    tolerant = transfer(tail=F(10**4), terminal=Terminal(attitude=F(1, 100), rate=F(1, 100)))
    assert tolerant.without_idle() == (tolerant, 0)
