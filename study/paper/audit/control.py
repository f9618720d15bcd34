"""E1 to E3: the update law, the dynamics of the augmented state, the persistence-filter law."""

from __future__ import annotations

import random
from dataclasses import replace
from fractions import Fraction

import casadi as ca

from ....models.closed_loop import close_loop
from ....models.laws import (
    AdaptiveScaling,
    AdaptiveScalingAsPrinted,
    Law,
    PersistenceFilter,
    PersistenceFilterAsPrinted,
)
from ....verify.exact.rational_quantity import rational_quantity
from ....verify.lyapunov.candidates import candidate
from ....verify.lyapunov.exact_states import ExactDerivative, ExactState
from ....verify.lyapunov.identity import identity_certificate, random_state, refute_identity
from ....verify.verdict import Claim, Quantity, Witness
from .item import J1, AuditItem, exact_values, proved, refuted, tilted_state, undecided, vanishes
from .trajectory import printed_update_trajectory
from .variants import AdaptiveScalingSignCorrected

F = Fraction
LAMBDA, GAMMA = F("0.525"), F("0.1")
STATES = 400
"""Random rational states for residuals that are figures, not proofs."""
BOX = "any attitude, |Omega_i| <= 0.25 rad/s, R in [0.25, 1] s, R_min = 0.25 s, k in [0, 4] 1/s, 0 < g <= 1"
"""Where those states are drawn from; another box gives other figures."""


def update_law() -> AuditItem:
    """E1: sign and power of the last term of the update law."""
    state = tilted_state(
        quaternion=(F(4, 5), F(3, 5), F(0), F(0)),
        rate=(F(0), F(0), F(0)),
        controller={"R": F(1), "k": F(0)},
        gain=F(1),
        gain_rate=F(0),
        floor=F(1),
    )
    printed = AdaptiveScalingAsPrinted(LAMBDA, GAMMA, F(1), F(0))
    witness = _growth(printed, state, "R = R_min = 1 s, k = 0, at rest, |bv| = 3/5: V grows")
    k_star = 1 / F("0.15")
    half = F(1, 200)  # tangent of half the angle whose sine is |bv|, about 0.01
    cosine, sine = (1 - half**2) / (1 + half**2), 2 * half / (1 + half**2)
    near = ExactState(
        (cosine, sine, F(0), F(0)),
        tuple(-2 * (k_star + F("0.1")) * x for x in (sine, F(0), F(0))),
        {"R": F("0.15"), "k": k_star + F("0.1")},
        F(1),
        F(0),
        k_star,
    )
    half_way = AdaptiveScalingSignCorrected(LAMBDA, GAMMA, F(1), F(0))
    sign_only = _growth(half_way, near, "sign alone corrected: R = R_min, Omega = 0, k = k* + 0.1")
    correct = AdaptiveScaling(LAMBDA, GAMMA, F(1), F(0))
    return AuditItem(
        "E1",
        "update law of the scaling factor",
        "k' = gamma R g^2 (1 + b0) Omega'J Omega - 2 gamma g^2 R |bv|",
        "k' = gamma R g^2 (1 + b0) Omega'J Omega + 2 gamma g^2 R |bv|^2",
        refuted("E1", "with the printed update V' <= 0", witness),
        _identity("E1", correct),
        (
            f"sign alone corrected fails too: V' = {sign_only.violation.low:.3g} at R = R_min, Omega = 0, "
            "g = 1, k = k* + 0.1, |bv| = 0.01",
            *printed_update_trajectory(printed),
        ),
        (_share_of_growth(printed),),
    )


def augmented_dynamics() -> AuditItem:
    """E2: which rate stands in the gyroscopic term of J Omega'."""
    loop = close_loop(AdaptiveScaling(LAMBDA, GAMMA, F(1), F(0)))
    Omega, w, J, b0 = loop.augmented_rate, loop.plant.w, loop.plant.J, loop.plant.b0
    damping = loop.time_symbols.g**2 / 2 * loop.controller_states["k"] * (1 + b0) * (J @ Omega)
    printed = loop.augmented_momentum_rate - (-ca.cross(w, J @ w) - damping)
    corrected = loop.augmented_momentum_rate - (-ca.cross(Omega, J @ w) - damping)
    values = exact_values(loop, printed, tilted_state(), J1)
    statement = "J Omega' = -S(Omega) J w - (g^2/2) k (1 + b0) J Omega identically"
    return AuditItem(
        "E2",
        "dynamics of the augmented state",
        "J Omega' = -S(w) J w - (g^2/2) k (1 + b0) J Omega",
        "J Omega' = -S(Omega) J w - (g^2/2) k (1 + b0) J Omega",
        refuted("E2", "the printed control law gives the printed J Omega'", _residual(values)),
        proved("E2", statement, "exact polynomial identity")
        if vanishes(loop, corrected)
        else undecided("E2", statement, "the residual does not vanish"),
        ("Omega'S(w)Jw does not vanish: the printed form would leave in V' a term that the paper drops",),
    )


def filter_law() -> AuditItem:
    """E3: the inertia missing in one term of the persistence-filter law."""
    printed, correct = PersistenceFilterAsPrinted(LAMBDA, F(1)), PersistenceFilter(LAMBDA, F(1))
    witness = refute_identity(candidate(close_loop(printed)), J1.exact_inertia)
    assert witness is not None
    return AuditItem(
        "E3",
        "control law of the persistence filter, third term",
        "u = ... + (2 g R'/R^2) bv ...",
        "u = ... + (2 g R'/R^2) J bv ...",
        refuted("E3", "with the printed law V' = R Q identically", witness),
        _identity("E3", correct),
        ("the printed term lacks the kg m^2 of the inertia: it is no torque",),
        (_relative_residual(printed),),
    )


def _growth(law: Law, state: ExactState, description: str) -> Witness:
    """Witness of V' > 0 at a state."""
    rate, _, _ = ExactDerivative(candidate(close_loop(law)), J1.exact_inertia).at(state)
    return Witness(description, state.floats(), rational_quantity("V'", rate))


def _residual(values: list[Fraction]) -> Witness:
    difference = rational_quantity("J Omega' - printed J Omega'", max(values, key=abs), unit="N m")
    return Witness("largest component at this state, J1", tilted_state().floats(), difference)


def _identity(number: str, law: Law) -> Claim:
    statement = "V' has its closed form identically, for every inertia and all positive parameters"
    try:
        certificate, words = identity_certificate(candidate(close_loop(law)))
    except ValueError as error:
        return undecided(number, statement, str(error))
    how = "polynomial identity modulo |beta|^2 = 1, accepted by the stand-alone checker"
    return proved(number, statement, how, {"certificate": certificate, "claim": list(words)})


def _share_of_growth(law: Law) -> Quantity:
    """Share of random states with V' > 0 (a figure: it depends on the box the states are drawn from)."""
    derivative, states = _in_box(law)
    grown = sum(derivative.at(state)[0] > 0 for state in states)
    label = f"share of {STATES} random states with V' > 0 ({BOX})"
    return Quantity.point("share_of_states", grown / STATES, label=label, digits=3)


def _relative_residual(law: Law) -> Quantity:
    """Root mean square of V' minus its closed form over that of the closed form, at random states."""
    derivative, states = _in_box(law)
    differences, sizes = 0.0, 0.0
    for state in states:
        rate, _, stated = derivative.at(state)
        differences += float(rate - stated) ** 2
        sizes += float(stated) ** 2
    label = f"root mean square of V' - R Q over that of R Q, {STATES} random states ({BOX})"
    return Quantity.point("relative_residual", (differences / sizes) ** 0.5, label=label, digits=3)


def _in_box(law: Law) -> tuple[ExactDerivative, list[ExactState]]:
    """Draw states of the box `BOX`."""
    chosen = candidate(close_loop(law))
    generator = random.Random(1)  # noqa: S311 (figures, not secrets)
    states = []
    for _ in range(STATES):
        drawn = random_state(chosen.loop, generator)
        R, k = F(generator.randint(16, 64), 64), F(generator.randint(0, 64), 16)
        gain = k if "k" in drawn.controller else 1 / R
        shift = [2 * drawn.gain**2 * gain * x for x in drawn.quaternion[1:]]
        rate = tuple(F(generator.randint(-16, 16), 64) - x for x in shift)
        controller = {"R": R, "k": k} if "k" in drawn.controller else {"R": R}
        states.append(replace(drawn, rate=rate, controller=controller, floor=F(4)))
    return ExactDerivative(chosen, J1.exact_inertia), states
