"""V' = R Q + g^2 (1 - k* R) P on the closed loop, exactly, for both laws; the printed laws break it."""

from fractions import Fraction as F

import casadi as ca
import numpy as np
import pytest
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.laws import AdaptiveScalingAsPrinted, PersistenceFilterAsPrinted
from intermit.models.storage import weighted_storage
from problems import ADAPTIVE, J1, J2, PERSISTENCE, random_quaternion

PRINTED = [
    AdaptiveScalingAsPrinted(F("0.525"), F("0.1"), F(1), F(0)),
    PersistenceFilterAsPrinted(F("0.525"), F(1)),
]


def residuals(law, body, count=200):
    """Relative difference of V' (two ways) and the closed form, at random states."""
    loop = close_loop(law)
    storage = weighted_storage(loop)
    target = storage.gain_target if storage.gain_target is not None else ca.SX.sym("unused")
    chain = loop.total_derivative(storage.value)
    f = ca.Function(
        "f", [*loop.arguments, storage.weight, target], [storage.derivative, chain, loop.augmented_rate]
    )
    rng = np.random.default_rng(7)
    J, lam, k_target = body.inertia, float(law.lambda_), 6.0
    worst_form, worst_chain = 0.0, 0.0
    for _ in range(count):
        b, R, k, g = random_quaternion(rng), rng.uniform(0.05, 3), rng.uniform(0, 8), rng.uniform(0, 1)
        x = np.concatenate([b, rng.normal(size=3), [R, k][: len(law.controller_states)]])
        derivative, by_chain, Omega = (
            np.asarray(v).ravel()
            for v in f(x, [g, rng.normal()], loop.parameter_values(), body_values(body), 1.0, k_target)
        )
        energy = Omega @ J @ Omega
        Q = -lam * energy - 2 * lam * (1 - b[0]) + b[1:] @ Omega
        P = 2 * b[1:] @ b[1:] + (1 + b[0]) * energy
        expected = R * Q + (g**2 * (1 - k_target * R) * P if len(x) == 9 else 0.0)
        scale = 1 + R * lam * energy + abs(expected)
        worst_form = max(worst_form, abs(derivative[0] - expected) / scale)
        worst_chain = max(worst_chain, abs(derivative[0] - by_chain[0]) / scale)
    return worst_form, worst_chain


@pytest.mark.parametrize("body", [J1, J2])
@pytest.mark.parametrize("law", [ADAPTIVE, PERSISTENCE])
def test_derivative_equals_its_closed_form_and_the_chain_rule(law, body):
    form, chain = residuals(law, body)
    # ~500 roundings of terms no larger than the scale, J^-1 enters the chain rule only
    assert form < 1e-12
    assert chain < 1e-12


@pytest.mark.parametrize("law", PRINTED)
def test_printed_laws_break_the_identity(law):
    form, chain = residuals(law, J1)
    assert form > 1e-2
    assert chain < 1e-12
