"""The inequalities behind the comparison systems hold along the package's own closed loop."""

import casadi as ca
import numpy as np
import pytest
from intermit.models.closed_loop import body_values, close_loop
from intermit.verify.filter.comparison import BodyBounds, angle_factor_float
from problems import ADAPTIVE, DIAG123, J1, J2, PERSISTENCE, random_quaternion

COUNT = 400
ROUNDING = 1e-9
"""Relative to the terms' own size: derivatives of s are formed by division by s > 1e-2."""


def rates(law, body, rng):
    """Random states with y, s, R, kappa and their derivatives along the closed loop."""
    loop = close_loop(law)
    Omega = loop.augmented_rate
    y2 = ca.dot(Omega, loop.plant.J @ Omega)
    s2 = 1 - loop.plant.b0
    function = loop.function(
        "rates",
        y2,
        2 * ca.dot(Omega, loop.augmented_momentum_rate),
        s2,
        loop.total_derivative(s2),
        loop.controller_states["R"],
        loop.total_derivative(loop.controller_states["R"]),
        loop.control.gain,
        loop.total_derivative(loop.control.gain),
    )
    rows = []
    for _ in range(COUNT):
        state = loop.initial_state(random_quaternion(rng), rng.normal(size=3))
        state[7:] = rng.uniform(0.1, 3, size=state.size - 7)
        g, g_rate = rng.uniform(0, 1), rng.normal()
        found = function(state, [g, g_rate], loop.parameter_values(), body_values(body))
        y2, y2_rate, s2, s2_rate, R, R_rate, kappa, kappa_rate = (float(v) for v in found)
        if s2 < 1e-2:
            continue
        y, s = np.sqrt(y2), np.sqrt(s2)
        rows.append((g, y, y2_rate / (2 * y), s, s2_rate / (2 * s), R, R_rate, kappa, kappa_rate))
    return np.array(rows).T


@pytest.mark.parametrize("law", [ADAPTIVE, PERSISTENCE])
@pytest.mark.parametrize("body", [J1, J2, DIAG123])
def test_rates_of_angle_rate_and_filter(law, body):
    g, y, dy, s, ds, R, dR, kappa, _ = rates(law, body, np.random.default_rng(1))
    pull = 0.5 * g**2 * kappa * (2 - s**2)
    assert np.allclose(dy, -pull * y, rtol=ROUNDING, atol=ROUNDING)
    assert np.allclose(dR, -0.525 * R + g**2 * (2 - s**2), rtol=ROUNDING, atol=ROUNDING)
    reach = BodyBounds.of(body).coupling * angle_factor_float(s**2) * y
    excess = np.abs(ds + pull * s) - reach
    assert np.all(excess <= ROUNDING * (1 + reach))
    # the same bound with a coupling 30 % smaller is false: the test can fail
    assert np.any(excess + 0.3 * reach > ROUNDING)


def test_rate_of_the_adaptive_gain():
    g, y, _, s, _, R, _, _, dk = rates(ADAPTIVE, J1, np.random.default_rng(2))
    f = (2 - s**2) * (y**2 + 2 * s**2)
    assert np.allclose(dk, 0.1 * R * g**2 * f, rtol=ROUNDING, atol=ROUNDING)
    assert not np.allclose(dk, 0.1 * R * g**2 * (y**2 + 2 * s**2), rtol=1e-2)


def test_scaled_variables_of_the_filter_lose_the_gain():
    """v = y sqrt(R) decays like exp(-lambda t/2); z = s sqrt(R) obeys a linear inequality."""
    _, y, dy, s, ds, R, dR, _, _ = rates(PERSISTENCE, J1, np.random.default_rng(3))
    root = np.sqrt(R)
    dv, dz = dy * root + y * dR / (2 * root), ds * root + s * dR / (2 * root)
    assert np.allclose(dv, -0.2625 * y * root, rtol=ROUNDING, atol=ROUNDING)
    c = BodyBounds.of(J1).coupling
    assert np.all(dz <= -0.2625 * s * root + c * y * root * (1 - s**2 / 4) + ROUNDING)


def test_angle_factor_is_above_the_root():
    S = np.linspace(0, 2, 2001)
    root = np.sqrt(1 - S / 2)
    assert np.all([angle_factor_float(x) for x in S] >= root)
    assert np.any(root > 1 - S / 4 - S**2 / 16)  # too greedy a factor would be false
