"""[uncertainty] in scenario files: read, checked, certified, rechecked; refused where senseless."""

from fractions import Fraction as F

import casadi as ca
import numpy as np
import pytest
from intermit.models.closed_loop import body_values, close_loop
from intermit.models.laws import PersistenceFilter
from intermit.models.members import draw_members
from intermit.models.rigid_body import RigidBody
from intermit.models.uncertainty import Uncertainty
from intermit.verify.robust.bodies import body_bins
from intermit.verify.robust.constants import CELLS, cell_end

J1 = RigidBody.from_rows([["3.05", "0.14", "0.05"], ["0.14", "2.66", "0.12"], ["0.05", "0.12", "2.18"]])
LONG = RigidBody.from_rows([["1", "0.05", "0"], ["0.05", "2", "0.1"], ["0", "0.1", "2.9"]])
LAW = PersistenceFilter(F(1, 2), F(1))
SETS = {
    "shape": Uncertainty(inertia_relative=F(1, 10)),
    "scale": Uncertainty(inertia_scale=(F(-1, 10), F(1, 5))),
    "entries": Uncertainty(inertia_tolerance=((F(1, 10), F(1, 20), F(0)), (F(1, 20), F(1, 10), F(1, 30)),
                                              (F(0), F(1, 30), F(1, 8)))),
    "turn": Uncertainty(misalignment_deg=F(5)),
    "all": Uncertainty(inertia_relative=F(1, 20), inertia_scale=(F(-1, 20), F(1, 20)),
                       thrust_error=(F(-1, 10), F(1, 20)), misalignment_deg=F(2)),
}  # fmt: skip


def unit(rng):
    x = rng.normal(size=3)
    return x / np.linalg.norm(x)


def margins(body, u, rng, count=300):
    """Smallest room of each inequality, relative to the constant's own size, over sampled members."""
    (part,) = body_bins(body, u, 1)
    c, J0, room = part.constants, body.inertia, []
    stays = u.thrust_error_varies == "never" or not any(u.thrust_error)
    for member in draw_members(LAW, body, u, count, rng):
        T = member.law
        thrust = np.array([getattr(T, f"t{i}{j}") for i in (1, 2, 3) for j in (1, 2, 3)]).reshape(3, 3)
        J = member.body.inertia
        d = np.cbrt(np.linalg.det(thrust))
        M, hat = thrust / d, J / d
        metric = hat if stays else J
        boost = 1.0 if stays else np.sqrt(d)  # of the metric over J/(1 + d)
        F_ = np.linalg.solve(hat, M @ J0)
        Phi = F_ - np.eye(3)
        x, b = unit(rng), unit(rng)
        y = np.sqrt(x @ hat @ x)

        def gyro(p, q, F_=F_, hat=hat, M=M):
            return np.cross(F_ @ p, hat @ q) - M @ np.cross(p, J0 @ q)

        S = float(rng.uniform(0, 2))
        n = np.sqrt(S * (2 - S))
        cell = min(int(S * CELLS / 2), CELLS - 1)
        forced = (2 - S) * n * (M @ J0 @ Phi @ b) - 4 * n * n * gyro(b, F_ @ b)
        size = boost * np.sqrt(forced @ np.linalg.solve(hat, forced))
        room.append(
            (
                x @ M @ J0 @ x / y**2 - float(c.damping),
                float(c.braking) + b @ Phi @ b,
                float(c.mismatch) - np.linalg.norm(Phi @ b),
                float(c.gyroscopic) - abs(x @ gyro(b, x)) / y**2,
                float(c.forcing(cell)) * np.sqrt(S) - size,
                float(c.inverse_root) - 1 / np.sqrt(np.linalg.eigvalsh(metric)[0]),
                float(c.inertia.widening) - np.max(np.linalg.eigvals(np.linalg.solve(J0, metric)).real),
            )
        )
    return np.min(np.array(room), axis=0)


@pytest.mark.parametrize("body", [J1, LONG], ids=["J1", "long"])
@pytest.mark.parametrize("name", SETS)
def test_no_member_breaks_a_constant(body, name):
    # 1e-9: the members' own rounding, on numbers of order one
    assert margins(body, SETS[name], np.random.default_rng(3)).min() >= -1e-9


def test_constants_of_a_smaller_set_are_broken():
    rng = np.random.default_rng(4)
    (part,) = body_bins(J1, Uncertainty(inertia_relative=F(1, 100)), 1)
    Phi = [
        np.linalg.norm(np.linalg.solve(m.body.inertia, J1.inertia) - np.eye(3), 2)
        for m in draw_members(LAW, J1, SETS["shape"], 50, rng)
    ]
    assert max(Phi) > float(part.constants.mismatch)


def test_forcing_covers_its_cell_and_grows():
    (part,) = body_bins(J1, SETS["all"], 1)
    values = [part.constants.forcing(k) for k in range(CELLS)]
    assert values == sorted(values)
    assert cell_end(CELLS - 1) == 2


def test_nothing_uncertain_has_no_constants():
    (part,) = body_bins(J1, Uncertainty(), 1)
    c = part.constants
    assert (c.damping, c.braking, c.gyroscopic, c.forcing(CELLS - 1), c.mismatch) == (1, 0, 0, 0, 0)


@pytest.mark.parametrize("seed", range(4))
def test_members_move_by_the_equations_of_the_page(seed):
    """J x' of the simulated loop against the stated equation, at random states and gains."""
    rng = np.random.default_rng(seed)
    (member,) = draw_members(LAW, J1, SETS["all"], 1, rng)
    loop = close_loop(member.law)
    plant, time = loop.plant, loop.time_symbols
    kappa = 1 / loop.controller_states["R"]
    zeta = 2 * time.g**2 * kappa * plant.bv
    rates = loop.total_derivative(zeta)
    f = loop.function("parts", loop.momentum_rate, rates, zeta)
    b = rng.normal(size=4)
    b /= np.linalg.norm(b)
    w, R, g, g_rate = rng.normal(size=3), 0.7, 0.8, 0.9
    state = np.concatenate([b, w, [R]])
    Jw, zeta_rate, z = (
        np.array(v).ravel()
        for v in f(state, ca.DM([g, g_rate]), loop.parameter_values(), body_values(member.body))
    )
    J0, J = J1.inertia, member.body.inertia
    T = np.array([getattr(member.law, f"t{i}{j}") for i in (1, 2, 3) for j in (1, 2, 3)]).reshape(3, 3)
    a, sigma = g * g / R, (1 + b[0]) / 2
    left = Jw + T @ J0 @ zeta_rate
    right = -np.cross(w, J @ w) - T @ np.cross(z, J0 @ w) - a * sigma * T @ J0 @ (w + z)
    assert left == pytest.approx(right, abs=1e-12 * np.abs(left).max() * 50)
