"""The worst start found is a start of the set, also where |w| and |Omega|_J are both bounded and g(0) > 0."""

from fractions import Fraction as F

import numpy as np
from hostile_scenarios import shifted
from intermit.models.laws import PersistenceFilter
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.verify.filter.sets import InitialSet
from intermit.verify.filter.worst_found import Search, _Shape, find_worst
from problems import J1

LAW = PersistenceFilter(lambda_=F(1), R0=F("0.2"))
# one window over the period's start: shifted so that g(0) is well above zero
SCHEDULE = build_schedule([Window(F(0), F(1)), Window(F(2), F(5))], Hermite(), period=F(8))
START = InitialSet(0.0, 1.0, 0.0, 0.3, "a set")


class Open:
    """A schedule that is open at t = 0, as far as the search can see."""

    def __init__(self, schedule):
        self._schedule = schedule

    def __getattr__(self, name):
        return getattr(self._schedule, name)

    def gain(self, t):
        return np.where(np.asarray(t) == 0.0, 1.0, self._schedule.gain(t))


def test_states_pushed_out_by_the_rate_bound_are_not_inside():
    shape = _Shape(LAW, J1, Open(SCHEDULE), START, F("0.01"))
    states = shape.states(shape.draw(np.random.default_rng(3), 64))
    Omega = states[:, 4:] + 2 * 5.0 * states[:, 1:4]
    y = np.sqrt(np.einsum("ni,ij,nj->n", Omega, J1.inertia, Omega))
    assert (y > 0.3).any()
    assert np.array_equal(shape.inside(states), y <= 0.3)


def test_the_worst_found_is_inside():
    found = find_worst(LAW, J1, SCHEDULE, START, horizon=F(16), search=Search(samples=16, rounds=1, local=8))
    b0, w = found.quaternion[0], np.array(found.rate)
    assert np.sqrt(1 - b0) <= 1.0
    assert np.sqrt(w @ J1.inertia @ w) <= 0.3


def test_nothing_is_reported_where_no_start_tried_lies_inside():
    """With g(0) = 1 the law's own term 2 g^2 kappa bv is 9 rad/s and more: no such |w| and |Omega|_J."""
    inside_a_window = shifted(SCHEDULE, F(1, 2))
    far = InitialSet(0.9, 1.0, 0.0, 0.3, "an empty set")
    search = Search(samples=8, rounds=1, local=8)
    assert find_worst(LAW, J1, inside_a_window, far, horizon=F(8), max_rate=F("0.01"), search=search) is None
