"""Bounds that were given up, bins beside the body, bounds of S above 2, and damping that may be negative."""

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.verify.checker.bernstein import Form
from intermit.verify.checker.exact_numbers import Invalid
from intermit.verify.checker.floor_steps import FloorStep
from intermit.verify.checker.reading import Node
from intermit.verify.checker.robust_constants import Uncertain, read_constants, require_scales
from intermit.verify.checker.robust_floor import RobustBin, _boxes
from intermit.verify.checker.robust_persistence import RobustPersistence
from intermit.verify.checker.schedules import Profile
from intermit.verify.filter.boxes import Box
from intermit.verify.robust.bodies import body_bins
from intermit.verify.robust.consequences import _moment
from intermit.verify.robust.persistence import NO_BOUND, NO_CASCADE, RobustPersistenceSystem
from robust_attack import BODY, question

NONE = (F(0), F(0))
PART = next(body_bins(BODY, question(inertia_relative=F(2, 100)).mission.uncertainty, 1))


def uncertain(scale=NONE, turn=F(0)):
    return Uncertain(F(0), scale, NONE, True, turn, F(0))


@pytest.mark.parametrize(
    ("scale", "bins"),
    [
        (NONE, [(F(-1, 2), F(-1, 4))]),
        (NONE, [(F(1, 4), F(1, 2))]),
        ((F(-1, 10), F(1, 10)), [(F(-1, 2), F(-1, 4)), (F(0), F(1, 10))]),
        ((F(-1, 10), F(1, 10)), [(F(-1, 10), F(0)), (F(1, 100), F(1, 10))]),
    ],
)
def test_bins_beside_a_factor_do_not_hold_it(scale, bins):
    with pytest.raises(Invalid, match="no bin holds"):
        require_scales(uncertain(scale), bins)
    require_scales(uncertain(scale), [(F(-1, 10), F(1, 10))])


def constants_of(turn, ratio):
    """The checker's constants of a body of principal inertias 1 and `ratio`, turned by `turn` deg."""
    rows = [["1", "0", "0"], ["0", str(ratio), "0"], ["0", "0", str(ratio)]]
    data = Node({"inertia": rows, "uncertainty": {}}, "data")
    place = Node({"scale": ["0", "0"]}, "bin")
    witness = Node({"lo": "1", "hi": str(ratio), "shape": "0"}, "witness")
    return read_constants(data, place, uncertain(turn=F(turn)), witness)


def test_a_turn_that_may_feed_the_rate_is_refused():
    """x'M J0 x < 0 for some x: then no damping >= 0 is a bound, whichever pair of bounds is kept."""
    turn, ratio = 29, 1000
    c, s = np.cos(np.radians(turn)), np.sin(np.radians(turn))
    turned = np.array([[c, -s, 0], [s, c, 0], [0, 0, 1]]) @ np.diag([1.0, ratio, ratio])
    assert np.linalg.eigvalsh(turned + turned.T)[0] < 0
    with pytest.raises(Invalid, match="push away"):
        constants_of(turn, ratio)
    assert constants_of(1, 3).damping > F(9, 10)


def test_a_rate_given_up_with_the_angle_bounds_nothing():
    system = RobustPersistenceSystem(decay=F(1, 2), initial_filter=F(1), constants=PART.constants)
    kept = {name: np.array([0.5]) for name in system.names}
    both = system.bounds(kept, kept)["weighted_rate"][0]
    wide = kept | {"v": np.array([0.4]), "y": np.array([1e-6])}
    assert system.bounds(wide, wide)["weighted_rate"][0] < 1e-5 < both
    lost = wide | {"s": np.array([NO_BOUND])}
    assert system.bounds(lost, lost)["weighted_rate"][0] > 0.25
    gone = kept | {"z": np.array([NO_CASCADE]), "v": np.array([1e-9])}
    assert system.bounds(gone, gone)["weighted_rate"][0] >= 0.5


def test_a_cosine_gap_above_2_counts_in_full_where_scaled():
    """After n periods |bv| <= sqrt(2 S) ratio^n: S cut to 2 first would let it shrink from 2 on."""
    box = Box(0.0, 1.0, 8.0, 0.1, 0.1, 1.0, 1.0, 10.0, 1.0, 1.0, 0.0, 0.0)
    moment = _moment(PART, box, repeats=True)
    assert (moment.attitude >= 4, moment.shrinking > moment.rate, moment.gap) == (True, True, 2)
    assert _moment(PART, box, repeats=False).attitude == pytest.approx(1)

    numbers = {"K": 1, "L": 1, "y": 1, "s": F(3, 2), "v": F(1, 10), "z": 3, "W": 1, "r": 1}
    x = {name: Form.constant(value) for name, value in numbers.items()}
    step = FloorStep(F(0), F(1), ["cascade", "none", "255", "1"], x, {})
    profile = Profile([F(0), F(1)], [[F(1)]], F(1))
    proved = RobustBin(
        constants_of(0, 3), F(1), (F(0), F(3, 2)), RobustPersistence(F(1, 2), F(1)), [step], [], None
    )
    for scaled, S, bv in ((True, 9, F(18**0.5)), (False, 2, 1)):
        _, most, rate = _boxes(proved, step, profile, scaled=scaled)[0]
        assert most == S
        assert rate == pytest.approx(float(F(1, 10) + 2 * bv))
