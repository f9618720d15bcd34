"""Random bodies and lambdas: no PROVED claim is refuted by search, and the sharp condition decides."""

import lyapunov_cases as cases
import numpy as np
import pytest
from floor_attack import decimal
from intermit.models.closed_loop import close_loop
from intermit.models.rigid_body import RigidBody
from intermit.verify.lyapunov import Falsifier, candidate, derivative_claim, falsify, sharp_condition
from intermit.verify.verdict import Verdict
from problems import paper_schedule

OPTIONS = Falsifier(points=100, starts=3)


def random_body(rng):
    """A rotated inertia that satisfies the triangle inequality, from a cubesat's to a station's."""
    masses = 10 ** rng.uniform(-3, 4) * rng.uniform(0.3, 1, size=3)
    principal = np.array([masses[1] + masses[2], masses[0] + masses[2], masses[0] + masses[1]])
    Q, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    J = Q @ np.diag(principal) @ Q.T
    return RigidBody.from_rows([[decimal(J[min(i, j), max(i, j)], 5) for j in range(3)] for i in range(3)])


def random_lambda(rng, sharp):
    """Anywhere around the sharp condition, or so near to it that only 1e-4 of it decides."""
    if rng.random() < 0.5:
        return decimal(sharp * float(np.exp(rng.uniform(-0.5, 0.7))))
    return decimal(sharp * (1 + float(rng.choice([-1, 1]) * 10 ** rng.uniform(-4, -1))), 9)


def attack(count, seed):
    rng = np.random.default_rng(seed)
    proved = 0
    for n in range(count):
        body = random_body(rng)
        sharp = 0.5 / np.sqrt(body.principal_inertias[0])
        lam = random_lambda(rng, sharp)
        law = (cases.persistence, cases.adaptive)[n % 2](lam)
        chosen = candidate(close_loop(law))
        claim = derivative_claim(chosen, body)
        condition = sharp_condition(lam, body)
        assert claim.verdict is condition.verdict is not Verdict.UNDECIDED
        found = falsify(chosen, body, schedule=paper_schedule(), options=OPTIONS)
        if claim.verdict is Verdict.PROVED:
            proved += 1
            assert found.witness is None, (law, body)
        else:
            assert found.witness is not None, (law, body)
    return proved


def test_a_few_random_scenarios():
    assert attack(6, seed=1) >= 2


@pytest.mark.slow
def test_more_random_scenarios():
    assert attack(24, seed=2) >= 8


@pytest.mark.soak
def test_many_random_scenarios():
    assert attack(300, seed=3) >= 100
