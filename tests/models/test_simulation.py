"""A run obeys the closed loop's exact relations, conserves what it must, and meets its tolerance."""

import itertools
from dataclasses import replace
from fractions import Fraction as F

import numpy as np
import pytest
from intermit.models.closed_loop import Saturation
from intermit.models.laws import AdaptiveScalingAsPrinted
from intermit.models.norms import EUCLIDEAN, LARGEST_COMPONENT
from intermit.models.simulation import (
    DOP853,
    SimulationError,
    filter_minimum,
    invariants,
    minimum,
    settling_time,
    simulate,
    torque_metrics,
)
from intermit.models.simulation.right_hand_side import _why_stopped
from problems import ADAPTIVE, CONVERGED_FILTER_FLOOR, J1, J2, PERSISTENCE, REST, TILTED, paper_schedule

RATE = np.array([0.05, -0.03, 0.04])
HORIZON = F(56)


def run(law, *, body=J1, rate=RATE, horizon=HORIZON, **options):
    return simulate(law, body, paper_schedule(), quaternion=TILTED, rate=rate, horizon=horizon, **options)


@pytest.mark.parametrize("law", [ADAPTIVE, PERSISTENCE])
def test_error_is_below_1e_8_relative_to_a_tight_reference(law):
    t = np.linspace(0, 56, 2801)
    value = run(law).state(t)
    reference = run(law, method=DOP853(rtol=1e-13, atol=1e-15)).state(t)
    scale = np.abs(reference).max(axis=1, keepdims=True)
    assert np.abs((value - reference) / scale).max() < 1e-8


@pytest.mark.parametrize("law", [ADAPTIVE, PERSISTENCE])
def test_norm_and_free_momentum_are_conserved(law):
    drift = invariants(run(law))
    assert drift.quaternion_norm < 1e-9
    assert drift.free_momentum < 1e-9


def test_persistence_filter_keeps_its_invariant():
    """R |Omega|_J^2 exp(lambda t) is constant along every run."""
    trajectory = run(PERSISTENCE)
    t = np.linspace(0, 24, 601)
    Omega = trajectory.signals(t).augmented_rate
    energy = np.einsum("it,ij,jt->t", Omega, J1.inertia, Omega)
    invariant = trajectory.controller_state("R", t) * energy * np.exp(0.525 * t)
    assert np.abs(invariant / invariant[0] - 1).max() < 1e-8


def test_adaptive_law_does_not_keep_that_invariant():
    trajectory = run(ADAPTIVE)
    t = np.array([0.0, 16.0])
    Omega = trajectory.signals(t).augmented_rate
    energy = np.einsum("it,ij,jt->t", Omega, J1.inertia, Omega)
    invariant = trajectory.controller_state("R", t) * energy * np.exp(0.525 * t)
    assert abs(invariant[1] / invariant[0] - 1) > 1e-2


@pytest.mark.parametrize("law", [ADAPTIVE, PERSISTENCE])
def test_from_rest_the_angle_follows_its_exact_law(law):
    """tan(Phi/4) = tan(Phi0/4) exp(-int g^2 kappa), by quadrature of the run's own gain."""
    trajectory = run(law, rate=REST)
    nodes, weights = np.polynomial.legendre.leggauss(20)
    exponent = 0.0
    for segment in trajectory.segments:
        a, b = float(segment.phase.start), float(segment.phase.end)
        if b > 24:
            break
        edges = np.linspace(a, b, 9)
        for low, high in itertools.pairwise(edges):
            t = (low + high) / 2 + (high - low) / 2 * nodes
            name = "k" if law is ADAPTIVE else "R"
            kappa = trajectory.controller_state(name, t)
            kappa = kappa if law is ADAPTIVE else 1 / kappa
            exponent += (high - low) / 2 * float(weights @ (trajectory.time_signals(t)[0] ** 2 * kappa))
    phi = 4 * np.arctan(np.tan(np.arccos(TILTED[0]) / 2) * np.exp(-exponent))
    bv = np.linalg.norm(trajectory.state(24.0)[1:4])
    assert abs(2 * np.arcsin(bv) - phi) < 1e-8


def test_filter_converges_to_its_closed_form_floor():
    trajectory = run(PERSISTENCE, rate=REST, horizon=F(120))
    late = minimum(trajectory, lambda t: np.where(t > 80, trajectory.controller_state("R", t), np.inf))
    assert abs(late.value - CONVERGED_FILTER_FLOOR) < 1e-6
    assert abs(late.time % 8 - 0.2385) < 2e-3


def test_printed_update_ends_upside_down():
    """The printed update of k ends with k < 0, the body at b0 = -1 and the filter dead."""
    law = AdaptiveScalingAsPrinted(lambda_=F("0.525"), gamma=F("0.1"), R0=F(1), k0=F(0))
    end = run(law, rate=REST).state(56.0)
    assert end[0] < -0.999
    assert end[7] < 1e-8
    assert end[8] == pytest.approx(-0.78, abs=5e-3)


def test_metrics_agree_with_a_fine_grid_and_bite():
    trajectory = run(ADAPTIVE)
    metrics = torque_metrics(trajectory)
    t = np.linspace(0, 56, 200_001)
    torque = trajectory.signals(t).applied_torque
    assert np.abs(torque).max() <= metrics.peak[LARGEST_COMPONENT].value * (1 + 1e-9)
    assert metrics.peak[LARGEST_COMPONENT].value == pytest.approx(np.abs(torque).max(), rel=1e-6)
    assert metrics.peak[EUCLIDEAN].value == pytest.approx(np.linalg.norm(torque, axis=0).max(), rel=1e-6)
    impulse = np.trapezoid(np.linalg.norm(torque, axis=0), t)
    assert metrics.impulse == pytest.approx(impulse, rel=1e-6)
    early = torque_metrics(trajectory, until=1.0)
    assert early.peak[LARGEST_COMPONENT].value < metrics.peak[LARGEST_COMPONENT].value


def test_settling_is_the_last_time_outside():
    trajectory = run(PERSISTENCE, rate=REST)
    settled = settling_time(trajectory, attitude=1e-2, rate=1e-2)
    x = trajectory.state(np.array([settled - 1e-6, settled + 1e-6]))
    size = np.maximum(np.linalg.norm(x[1:4], axis=0), np.linalg.norm(x[4:7], axis=0))
    assert size[0] > 1e-2 > size[1]
    assert settling_time(trajectory, attitude=1e-12, rate=1e-12) is None


def test_saturation_holds_and_changes_the_run():
    limited = run(ADAPTIVE, saturation=Saturation(F("1.5")))
    assert limited.is_saturated_model
    t = limited.grid()
    assert np.abs(limited.signals(t).applied_torque).max() <= 1.5 + 1e-12
    assert np.abs(run(ADAPTIVE).signals(t).applied_torque).max() > 1.5
    euclidean = run(ADAPTIVE, saturation=Saturation(F(3), EUCLIDEAN))
    assert np.linalg.norm(euclidean.signals(t).applied_torque, axis=0).max() <= 3 + 1e-12


def test_escape_under_saturation_is_an_error_naming_the_state():
    """With the torque held at 0.5 N m the adaptive gain runs away like k' ~ k^2."""
    with pytest.raises(SimulationError, match=r"stopped at t = 9\.78.* k grew to .*finite time"):
        run(ADAPTIVE, saturation=Saturation(F("0.5")))


def test_a_stiff_motion_is_not_said_to_escape():
    """Steps vanish for both; only a state that grew escapes."""
    still = np.ones((2, 80))
    grown = np.vstack([np.ones(80), np.geomspace(1, 1e9, 80)])
    assert "stiff" in _why_stopped(("b0", "k"), 3.0, still)
    assert "k grew to 1e+09" in _why_stopped(("b0", "k"), 3.0, grown)


@pytest.mark.parametrize("decay", ["1e7", "1e12"])
def test_a_filter_far_quicker_than_the_run_stops_by_its_pace(decay):
    with pytest.raises(SimulationError, match=r"after 100000 right-hand sides, and would take \de\+\d+ more"):
        run(replace(ADAPTIVE, lambda_=F(decay)))
    with pytest.raises(SimulationError, match="the filter has forgotten its start"):
        run(replace(PERSISTENCE, lambda_=F(decay)))


def test_filter_minimum_is_below_every_sample():
    trajectory = run(ADAPTIVE, body=J2)
    least = filter_minimum(trajectory)
    assert np.all(trajectory.controller_state("R", trajectory.grid(20)) >= least.value - 1e-12)


def test_bad_start_is_refused():
    with pytest.raises(ValueError, match="unit"):
        simulate(ADAPTIVE, J1, paper_schedule(), quaternion=[1, 1, 0, 0], rate=REST, horizon=HORIZON)
    with pytest.raises(ValueError, match="end after it starts"):
        run(ADAPTIVE, horizon=F(0))
