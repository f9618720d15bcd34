"""A norm that no file knows: a disc of two torque components and an interval for the third.

It is built here, from blocks alone, and has simulated figures, a checked optimum, a lower bound, a
saturation and a clear refusal of a certificate.
"""

from dataclasses import replace
from fractions import Fraction as F

import missions
import numpy as np
import pytest
from intermit.models.closed_loop import Saturation
from intermit.models.ensemble import MetricOptions, simulate_ensemble
from intermit.models.laws import AdaptiveScaling, PersistenceFilter
from intermit.models.norm_blocks import Ball, Box
from intermit.models.norms import BODY_AXES, EUCLIDEAN, LARGEST_COMPONENT, Norm, thrusters
from intermit.models.schedule import Hermite, Window, build_schedule
from intermit.models.simulation import peak_torque, simulate, torque_metrics
from intermit.optim.bounds import certified_lower_bound
from intermit.optim.bounds.argument import MomentumArgument, NamedBound
from intermit.optim.bounds.certificate import peak_certificate
from intermit.optim.bounds.prepare import Prepared
from intermit.optim.bounds.sets.gauge import invariant_set
from intermit.optim.peak import MultiStart, NonlinearProgram, Refinement, Standing, minimum_peak
from intermit.optim.peak.search.minimum_impulse import minimum_impulse
from intermit.optim.problem import TransferProblem
from intermit.verify.filter.answer import answer
from intermit.verify.verdict import Verdict
from problems import J1, paper_schedule
from transfers import paper_transfer

DISC = Norm("disc-and-axis", "disc and axis", (Ball(2), Box(1)))
AXES = ((F(2), F(0), F(0)), BODY_AXES[1], (F(0), F(1), F(1)))
UNEVEN = Norm("uneven", "uneven gimbal", (Ball(2), Box(1)), AXES)
LAW = AdaptiveScaling(lambda_=F("0.525"), gamma=F("0.5"), R0=F("0.15"), k0=F(0))
ONE = MultiStart(starts=1)
START = {"quaternion": np.array([0.8, 0.6, 0.0, 0.0]), "rate": np.zeros(3)}


def two_windows(norm: Norm) -> TransferProblem:
    """About a skew axis from rest, through two windows."""
    schedule = build_schedule([Window(F(0), F(3)), Window(F(7), F(9))], Hermite())
    return TransferProblem.through(schedule, body=J1, horizon=9, attitude=(4, 1, 2, 2), norm=norm)


def size(torque: np.ndarray) -> np.ndarray:
    """The norm, by hand."""
    return np.maximum(np.hypot(torque[..., 0], torque[..., 1]), np.abs(torque[..., 2]))


def test_its_size_lies_between_those_of_the_cube_and_the_ball():
    torque = np.random.default_rng(1).normal(size=(500, 3))
    np.testing.assert_allclose(DISC.peak(torque), size(torque), rtol=1e-15)
    assert np.all(LARGEST_COMPONENT.peak(torque) <= DISC.peak(torque))
    assert np.all(DISC.peak(torque) <= EUCLIDEAN.peak(torque))
    assert not np.allclose(DISC.peak(torque), EUCLIDEAN.peak(torque), rtol=1e-3)


@pytest.mark.parametrize("norm", [DISC, UNEVEN], ids=lambda norm: norm.key)
def test_the_support_is_the_polar_of_the_peak(norm):
    rng = np.random.default_rng(2)
    torque, direction = rng.normal(size=(2, 400, 3))
    inner = (torque * direction).sum(-1)
    assert np.all(inner <= norm.peak(torque) * norm.support(direction) * (1 + 1e-12))
    # and no smaller support would do: some torque of unit peak reaches it
    unit = rng.normal(size=(20000, 3))
    unit /= norm.peak(unit)[:, None]
    assert np.all((direction[:20] @ unit.T).max(axis=1) > 0.97 * norm.support(direction[:20]))
    assert np.linalg.norm(unit, axis=1).max() <= norm.reach * (1 + 1e-12)


def test_its_corners_hold_it_closely():
    corners = np.array([[float(x) for x in point] for point in DISC.corners()])
    direction = np.random.default_rng(3).normal(size=(300, 3))
    around = (direction @ corners.T).max(axis=1)
    assert np.all(around >= DISC.support(direction) * (1 - 1e-12))
    assert np.all(around <= 1.05 * DISC.support(direction))


def test_runs_are_measured_in_it_alone_and_in_ensembles():
    run = simulate(LAW, J1, paper_schedule(), horizon=F(9), **START)
    grid = run.grid()
    found = torque_metrics(run, norms=(DISC, EUCLIDEAN))
    assert found.peak[DISC] == peak_torque(run, DISC)
    assert found.peak[DISC].value == pytest.approx(size(run.signals(grid).applied_torque.T).max(), rel=1e-3)
    assert found.peak[DISC].value <= found.peak[EUCLIDEAN].value
    many = simulate_ensemble(
        LAW, J1, paper_schedule(), np.r_[START["quaternion"], START["rate"]][None], horizon=F(9),
        metrics=MetricOptions(norms=(DISC,)),
    )  # fmt: skip
    assert many.metrics.peak[DISC][0] == pytest.approx(found.peak[DISC].value, rel=1e-5)


def test_a_torque_is_limited_block_by_block():
    start = {**START, "quaternion": np.array([0.5, 0.5, 0.5, 0.5])}
    free = simulate(LAW, J1, paper_schedule(), horizon=F(9), **start)
    limit = F(str(round(0.8 * peak_torque(free, DISC).value, 3)))
    held = simulate(LAW, J1, paper_schedule(), horizon=F(9), saturation=Saturation(limit, DISC), **start)
    assert peak_torque(held, DISC).value == pytest.approx(float(limit), rel=1e-9)
    assert peak_torque(held, EUCLIDEAN).value > 1.02 * float(limit)
    with pytest.raises(ValueError, match="not by uneven gimbal"):
        simulate(LAW, J1, paper_schedule(), horizon=F(9), saturation=Saturation(limit, UNEVEN), **start)


@pytest.mark.parametrize("norm", [DISC, UNEVEN], ids=lambda norm: norm.key)
def test_its_optimum_is_checked(norm):
    found = minimum_peak(two_windows(norm), search=ONE, refinement=Refinement(mesh_gap=1e-4))
    assert found.standing is Standing.CHECKED, found.reason
    times = np.linspace(0.01, 8.99, 400)
    assert norm.peak(found.history.torque(times)).max() <= found.peak * (1 + 1e-9)


@pytest.mark.slow
@pytest.mark.parametrize("norm", [DISC, UNEVEN], ids=lambda norm: norm.key)
def test_its_optimum_is_above_its_bound_and_the_other_solvers(norm):
    problem, rough = two_windows(norm), Refinement(mesh_gap=1e-4)
    found = minimum_peak(problem, search=ONE, refinement=rough)
    bound = certified_lower_bound(problem)
    assert 0.5 * found.peak < bound.value <= found.peak
    assert peak_certificate(problem, bound.best) is None
    other = minimum_peak(problem, solver=NonlinearProgram(), search=ONE, refinement=rough)
    assert other.peak == pytest.approx(found.peak, rel=1e-3)


def test_its_bound_is_proved_and_its_certificate_refused():
    spinning = replace(two_windows(DISC), rate=(F(1, 20), F(-1, 10), F(1, 20)))
    corners = max(sum(x * x for x in point) for point in DISC.corners())
    momenta = invariant_set(J1, DISC)
    # every torque of unit effort lies in the set: its first row is the ball around the corners
    assert momenta.levels[0] == corners
    bound = NamedBound("momentum", F(1), MomentumArgument(Prepared(spinning).measured(momenta)))
    assert peak_certificate(spinning, bound) is None
    assert peak_certificate(replace(spinning, norm=LARGEST_COMPONENT), bound) is not None


def test_its_optimum_lies_between_cube_and_ball():
    peaks = []
    for norm in (LARGEST_COMPONENT, DISC, EUCLIDEAN):
        problem = replace(paper_transfer(EUCLIDEAN, horizon="11.22"), norm=norm)
        peaks.append(minimum_peak(problem, search=ONE, refinement=Refinement(mesh_gap=1e-4)).peak)
    assert peaks[0] < peaks[1] < peaks[2]


def test_its_least_impulse_is_checked_and_switches_by_block():
    problem = two_windows(DISC)
    least = minimum_peak(problem, search=ONE, refinement=Refinement(mesh_gap=1e-3)).peak
    found = minimum_impulse(problem, 1.5 * least, search=ONE, refinement=Refinement(mesh_gap=1e-2))
    assert found.found
    assert found.answer.standing is Standing.CHECKED, found.answer.reason
    assert found.answer.history.peak <= 1.5 * least * (1 + 1e-9)
    control = found.answer.history.control
    spent = np.hypot(control[:, 0], control[:, 1]) + np.abs(control[:, 2])
    np.testing.assert_allclose(DISC.consumption(control), spent, rtol=1e-14)


def test_a_torque_limit_is_proved_and_one_of_forces_left_open():
    law = PersistenceFilter(lambda_=F("0.525"), R0=F("0.15"))
    question = missions.question(law=law, body=J1, schedule=paper_schedule(), max_angle_deg=F(30))
    generous = missions.other(question, torque_limit=F(10**4), torque_norm=DISC)
    claims = {claim.key: claim for claim in answer(generous).claims}
    assert claims["torque.limit"].verdict is Verdict.PROVED
    assert "(disc-and-axis)" in claims["torque.limit"].statement
    # the certified bound of a torque's length says nothing about the forces that it takes
    five = thrusters([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1]])
    forces = missions.other(generous, torque_norm=five)
    claims = {claim.key: claim for claim in answer(forces).claims}
    assert claims["torque.limit"].verdict is Verdict.UNDECIDED
    assert "what 5 one-sided thrusters need for it is not bounded" in claims["torque.limit"].reason


def test_a_ball_without_room_to_turn_in_is_refused():
    with pytest.raises(ValueError, match="three controls with independent axes"):
        Norm("flat", "flat", (Ball(2),), BODY_AXES[:2])
    with pytest.raises(ValueError, match="one is a box"):
        Ball(1)
