"""The inequalities that comparison systems state hold along the package's own closed loop, and only just."""

from fractions import Fraction as F

import numpy as np
import pytest
from intermit.verify.filter.comparison import BodyBounds, angle_factor
from intermit.verify.filter.known_proofs import system_of
from intermit.verify.filter.trial import contradiction
from problems import ADAPTIVE, DIAG123, J1, J2, PERSISTENCE

LAWS = {"adaptive": ADAPTIVE, "persistence": PERSISTENCE}
TIGHT = {"adaptive": ("y", "s", "k", "r", "Y", "Z", "U"), "persistence": ("K", "y", "s", "v", "z", "r")}
"""Components whose slope some state attains, nearly: an inequality that asks less of them is false."""


@pytest.mark.parametrize("law", LAWS)
@pytest.mark.parametrize("body", [J1, J2, DIAG123])
def test_no_state_contradicts_them(law, body):
    bounds = BodyBounds.of(body)
    assert contradiction(LAWS[law], system_of(LAWS[law], bounds), bounds) is None


@pytest.mark.parametrize(("law", "name"), [(law, name) for law, names in TIGHT.items() for name in names])
def test_asking_three_percent_less_is_contradicted(law, name):
    bounds = BodyBounds.of(J1)
    system = system_of(LAWS[law], bounds)
    stated, sign = system.slopes, system.signs[system.names.index(name)]

    def less(G, x, modes, n):
        slopes = dict(stated(G, x, modes, n))
        if name in slopes:
            each = slopes[name] if isinstance(slopes[name], tuple) else (slopes[name],)
            slopes[name] = tuple(s - sign * 0.03 * abs(s) for s in each)
        return slopes

    system.slopes = less
    found = contradiction(LAWS[law], system, bounds)
    assert found is not None
    assert f" {name} moves by" in found


@pytest.mark.parametrize("law", LAWS)
def test_a_body_lighter_than_its_bounds_is_contradicted(law):
    bounds = BodyBounds.of(J1)
    lighter = BodyBounds(bounds.least / 2, bounds.greatest)
    assert contradiction(LAWS[law], system_of(LAWS[law], bounds), lighter) is not None


def test_a_system_must_say_what_it_bounds():
    bounds = BodyBounds.of(J1)
    system = system_of(PERSISTENCE, bounds)
    system.measures = lambda loop: {"y": loop.plant.b0}
    assert "what each of its components bounds" in contradiction(PERSISTENCE, system, bounds)


def test_angle_factor_is_above_the_root():
    S = np.linspace(0, 2, 2001)
    root = np.sqrt(1 - S / 2)
    assert np.all(angle_factor(S) >= root)
    assert np.any(root > 1 - S / 4 - S**2 / 16)  # too greedy a factor would be false
    assert angle_factor(F(1, 2)) == 1 - F(1, 8) - F(1, 128)
