"""The closed form of the best weight agrees with the program it solves, stated a second time in cvxpy."""

from fractions import Fraction as F

import cvxpy as cp
import numpy as np
import pytest
from intermit.verify.lyapunov.decay import best_weight
from problems import J1, J2


def program(lam: float, J: np.ndarray) -> tuple[float, float]:
    """Largest rho, and its weight a, with V_a' <= -rho V_1: a linear matrix inequality in (a, rho)."""
    a, rho = cp.Variable(), cp.Variable()
    eye = np.eye(3)
    matrix = cp.bmat([[(lam - rho) * J, -a / 2 * eye], [-a / 2 * eye, (lam * a - rho) * eye]])
    problem = cp.Problem(cp.Maximize(rho), [matrix >> 0])
    problem.solve(solver=cp.CLARABEL)
    return float(rho.value), float(a.value)


@pytest.mark.parametrize("body", [J1, J2])
@pytest.mark.parametrize("lam", ["0.3", "0.525", "2"])
def test_closed_form_is_the_programs_optimum(body, lam):
    rho, a = program(float(lam), body.inertia)
    q = float(lam) ** 2 * float(body.principal_inertias[0])
    assert rho == pytest.approx(float(lam) * q / (1 + q), rel=1e-6)
    # the optimum in a is flat to first order: the weight is known to the root of the solver's gap
    assert float(best_weight(F(lam), body)) == pytest.approx(a, rel=1e-3)


def test_another_weight_is_worse():
    lam, J = 0.525, J1.inertia
    best, a = program(lam, J)
    fixed = cp.Variable()
    eye, other = np.eye(3), 1.3 * a
    matrix = cp.bmat([[(lam - fixed) * J, -other / 2 * eye], [-other / 2 * eye, (lam * other - fixed) * eye]])
    problem = cp.Problem(cp.Maximize(fixed), [matrix >> 0])
    problem.solve(solver=cp.CLARABEL)
    assert float(fixed.value) < best - 1e-4
