"""E4, E7, E10, E11: the bounds on V' and on the filter state."""

from __future__ import annotations

from fractions import Fraction

import casadi as ca
import numpy as np

from ....models.closed_loop import close_loop
from ....models.laws import AdaptiveScaling, PersistenceFilter
from ....verify.exact.ball import ball, float_above
from ....verify.exact.direction import rational_direction
from ....verify.exact.rational_quantity import rational_quantity
from ....verify.lyapunov.candidates import bracket_terms
from ....verify.lyapunov.conditions import sharp_threshold
from ....verify.lyapunov.exact_states import ExactState
from ....verify.verdict import Witness
from .item import J1, AuditItem, exact_values, proved, refuted, tilted_state, undecided, vanishes

F = Fraction
LAMBDA = F("0.525")
CLAIMED_FLOOR = F(1, 10**12)
"""A floor that the printed assumptions would have to allow, s; any other falls the same way, later."""


def final_bound() -> AuditItem:
    """E4: sign in the final bound on V'."""
    loop = close_loop(PersistenceFilter(LAMBDA, F(1)))
    jmin = ca.SX.sym("Jmin")
    R, Omega, b0, bv = loop.controller_states["R"], loop.augmented_rate, loop.plant.b0, loop.plant.bv
    lam, J = loop.parameter_symbols["lambda"], loop.plant.J
    bracket, _ = bracket_terms(loop, 1)
    attitude = 2 * (lam - (1 + b0) / 4) * R * (1 - b0)
    printed = -(lam * jmin + 0.5) * R * ca.sumsqr(Omega) - attitude
    corrected = -(lam * jmin - 0.5) * R * ca.sumsqr(Omega) - attitude
    # the slack is a sum of two terms that are >= 0, for J >= Jmin I
    slack = R * (lam * (ca.dot(Omega, J @ Omega) - jmin * ca.sumsqr(Omega)) + ca.sumsqr(Omega - bv) / 2)
    statement = "V' <= -(lambda Jmin - 1/2) R |Omega|^2 - 2 (lambda - (1 + b0)/4) R (1 - b0)"
    holds = vanishes(loop, corrected - R * bracket - slack, {"Jmin": jmin})
    _, vectors = np.linalg.eigh(J1.inertia)
    n = rational_direction(vectors[:, 0].tolist())
    sine, cosine = F(3, 5), F(4, 5)
    state = ExactState((cosine, *(sine * x for x in n)), tuple(sine * x for x in n), {"R": F(1)}, F(0), F(0))
    # Jmin = 1/(4 sharp^2) at or below: the printed bound grows with it, so its upper end is taken
    least = 1 / (4 * F(sharp_threshold(J1).high) ** 2)
    (violation,) = exact_values(loop, R * bracket - printed, state, J1, {"Jmin": (jmin, least)})
    witness = Witness(
        "g = 0, |bv| = |Omega| = 3/5 along the axis of least inertia (Jmin enclosed from below)",
        state.floats(),
        rational_quantity("V' - printed bound", violation),
    )
    return AuditItem(
        "E4",
        "final bound on V'",
        "V' <= (-lambda Jmin/Jmax - 1/(2 Jmax)) R Jmax |Omega|^2 - 2 (lambda - (1 + b0)/4) R (1 - b0)",
        statement,
        refuted("E4", "the printed bound holds", witness),
        proved(
            "E4", statement, "the slack is R [lambda Omega'(J - Jmin I) Omega + |Omega - bv|^2/2], exactly"
        )
        if holds
        else undecided("E4", statement, "the slack is not the expected sum of squares"),
        ("as printed the rate term is negative for every lambda > 0: 1/(2 Jmin) would be idle",),
    )


def bounding_step() -> AuditItem:
    """E7: the power of |bv| in the bounding step."""
    loop = close_loop(AdaptiveScaling(LAMBDA, F("0.1"), F(1), F(0)))
    g, b0, bv = loop.time_symbols.g, loop.plant.b0, loop.plant.bv
    term = 2 * g**2 * (1 + b0) * (1 - b0)
    statement = "the filter contributes 2 g^2 (1 - b0)(1 + b0) = 2 g^2 |bv|^2 to V'"
    state = tilted_state(quaternion=(F(4, 5), F(3, 5), F(0), F(0)))
    (violation,) = exact_values(loop, term - 2 * g**2 * ca.norm_2(bv), state, J1)
    witness = Witness(
        "|bv| = 3/5, g = 1", state.floats(), rational_quantity("2 g^2 |bv|^2 - 2 g^2 |bv|", violation)
    )
    return AuditItem(
        "E7",
        "text of the bounding step",
        "the non-negative term 2 g^2 |bv|",
        "the non-negative term 2 g^2 |bv|^2",
        refuted("E7", "the term is 2 g^2 |bv|", witness),
        proved("E7", statement, "exact polynomial identity on |beta| = 1")
        if vanishes(loop, term - 2 * g**2 * ca.sumsqr(bv))
        else undecided("E7", statement, "the difference does not vanish"),
    )


def filter_ceiling() -> AuditItem:
    """E10: the upper bound on R needs a condition on R(0)."""
    start, ceiling = F(5), 2 / LAMBDA
    witness = Witness(
        "R(0) = 5 s, lambda = 0.525 1/s, max g = 1, t = 0",
        {"R0": float(start)},
        rational_quantity("R(0) - 2 max g^2/lambda", start - ceiling, unit="s"),
    )
    return AuditItem(
        "E10",
        "bounds of the filter state",
        "R(t) <= 2 max g^2/lambda for all t >= 0, for any R(0) > 0",
        "R(t) <= max(R(0), 2 max g^2/lambda); the printed bound if R(0) <= 2 max g^2/lambda",
        refuted("E10", "R <= 2 max g^2/lambda for every R(0) > 0", witness),
        proved(
            "E10",
            "R <= max(R(0), 2 max g^2/lambda)",
            "R' = -lambda R + g^2 (1 + b0) <= -lambda R + 2 max g^2 < 0 wherever R exceeds 2 max g^2/lambda",
        ),
    )


def filter_floor() -> AuditItem:
    """E11: persistent excitation and isolated b0 = -1 do not keep R away from zero."""
    instant = 100
    bound = _unwinding_bound(instant)
    witness = Witness(
        "b0(t) = -1 + exp(-t), never -1: R(100 s), where R(0) = 1 s, lambda = 0.525 1/s, 0 <= g <= 1",
        {"t": float(instant), "R_upper": bound},
        rational_quantity("claimed floor - R", CLAIMED_FLOOR - F(bound), CLAIMED_FLOOR, "s"),
    )
    equilibrium = _turned_over_equilibrium()
    statement = "b0 = -1 at rest is an equilibrium of both closed loops, with R' = -lambda R whatever g does"
    return AuditItem(
        "E11",
        "existence of R_min",
        "g persistently exciting and b0 = -1 only at isolated instants give R_min > 0",
        "they do not: a floor must be proved over a set of starts",
        refuted("E11", "under these assumptions R stays above 1e-12 s", witness),
        proved("E11", statement, "state rates evaluated exactly at (-1, 0, 0, 0), w = 0")
        if equilibrium
        else undecided("E11", statement, "a state rate does not vanish"),
        (
            "along b0(t) = -1 + exp(-t) the bound exp(-lambda t) + (exp(-t) - exp(-lambda t))/(lambda - 1) "
            "on R tends to 0",
            "at the equilibrium V = 4 R + (k - k*)^2/(2 gamma) keeps falling although the attitude never "
            "moves: V' <= 0 alone proves no convergence",
        ),
    )


def _unwinding_bound(instant: int) -> float:
    """Upper bound on R(t) for b0 = -1 + exp(-t), g <= 1, R(0) = 1.

    R <= exp(-lambda t) + (exp(-t) - exp(-lambda t))/(lambda - 1).
    """
    fast, slow = (-ball(instant)).exp(), (-ball(LAMBDA * instant)).exp()
    return float_above(slow + (fast - slow) / ball(LAMBDA - 1))


def _turned_over_equilibrium() -> bool:
    """Whether every rate vanishes at b0 = -1, w = 0, but R' = -lambda R, for any g and g'."""
    laws = (PersistenceFilter(LAMBDA, F(1)), AdaptiveScaling(LAMBDA, F("0.1"), F(1), F("0.2")))
    state = tilted_state(
        quaternion=(F(-1), F(0), F(0), F(0)), rate=(F(0), F(0), F(0)), gain=F(3, 4), gain_rate=F(1, 7)
    )
    for law in laws:
        loop = close_loop(law)
        names = loop.state_names
        rates = dict(zip(names, exact_values(loop, loop.state_rate, state, J1), strict=True))
        if rates.pop("R") != -LAMBDA * state.controller["R"] or any(rates.values()):
            return False
    return True
