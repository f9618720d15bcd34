"""V' as a function of the coordinates in which its sign is studied: (beta, Omega, controller, g, g').

The model's own expressions are taken and w is replaced by Omega - 2 g^2 kappa bv; nothing of the
dynamics is written again here. What is added is what the theory states about V', so that the two can
be compared: the paper's bound, and the exact form V' = R Q + g^2 (1 - k* R) P, which follows by
|beta| = 1 (Q and P: `verify.lyapunov.candidates`).

Source: Ram & Akella, AAS 21-402, stability analysis.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any, final

import casadi as ca

from ...models.closed_loop import ClosedLoop
from ...models.laws import Expression
from ...models.storage import Storage, weighted_storage
from ..lyapunov.candidates import bracket_terms, candidate

EXTRA_NAMES = ("a", "k_target", "J_min")
RESULTS = ("rate", "storage", "bound", "by_differentiation", "stated", "scale")


@final
@dataclass(frozen=True)
class DerivativeFunction:
    """V' and what is stated about it, as one CasADi function.

    Attributes
    ----------
    function : (coordinates, parameters, body, extra) -> RESULTS, scalars
        coordinates: b0..b3, Omega (3), controller states, g, g'; extra: `EXTRA_NAMES`.
        Results: V' by the chain rule free of J^-1; W = R (2 a (1 - b0) + Omega'J Omega) (V itself
        for a law's own storage function); the paper's upper bound on V'; V' by automatic
        differentiation through w' = J^-1 (...); V' in the stated closed form; the size of the terms
        that cancel in V', for relative residuals.
    in_family : bool
        Whether the law has a gain kappa and a filter state, so that a closed form is stated.
    uses_augmented_rate : bool
        Whether coordinates 4 to 6 are Omega; w otherwise.
    """

    loop: ClosedLoop
    function: Any
    in_family: bool
    uses_augmented_rate: bool


def derivative_function(loop: ClosedLoop) -> DerivativeFunction:
    """Build V' for a law of the family, or for a law that brings its own storage function.

    Raises
    ------
    ValueError
        If the law has neither, resets its states, misstates the rate of its gain, or uses signals of
        time beside g.
    """
    if loop.time_symbols.signals:
        raise ValueError(f"law {loop.law.name} uses signals of time beside g: its V' is not sampled")
    if not loop.has_true_gain_rate():
        raise ValueError(
            f"law {loop.law.name} returns a Control.gain_rate that is not the rate of Control.gain"
        )
    chosen = candidate(loop)
    extra = {name: ca.SX.sym(name) for name in EXTRA_NAMES}
    own = chosen.value if chosen.right_side is None else None
    if own is None:
        results = _family_results(loop, extra)
    else:
        rate = loop.total_derivative(own)
        results = [rate, own, ca.SX(0), rate, rate, ca.fabs(rate) + ca.fabs(own)]
    return _in_coordinates(loop, extra, results, in_family=own is None)


def _family_results(loop: ClosedLoop, extra: Mapping[str, Expression]) -> list[Expression]:
    storage = weighted_storage(loop)
    stated, bound = _stated(loop, storage, extra["J_min"])
    by_differentiation = loop.total_derivative(storage.value)
    results = [storage.derivative, storage.reference, bound, by_differentiation, stated, _scale(loop)]
    symbols, values = [storage.weight], [extra["a"]]
    if storage.gain_target is not None:
        symbols, values = [*symbols, storage.gain_target], [*values, extra["k_target"]]
    replaced: list[Expression] = ca.substitute(results, symbols, values)
    return replaced


def _stated(loop: ClosedLoop, storage: Storage, J_min: Expression) -> tuple[Expression, Expression]:
    """V' in the stated closed form, and the paper's bound on it."""
    b0, Omega = loop.plant.b0, loop.augmented_rate
    R, lam = loop.controller_states["R"], loop.parameter_symbols["lambda"]
    a, g = storage.weight, loop.time_symbols.g
    Q, P = bracket_terms(loop, a)
    stated = R * Q
    if storage.gain_target is not None:
        stated = stated + g**2 * (1 - storage.gain_target * R) * P
    rate_part = -(lam * J_min - a / 2) * R * ca.sumsqr(Omega)
    return stated, rate_part - 2 * a * (lam - (1 + b0) / 4) * R * (1 - b0)


def _scale(loop: ClosedLoop) -> Expression:
    """Size of the terms that cancel in V': R |Omega| times the torques, and the filter's own terms."""
    Omega, w, J = loop.augmented_rate, loop.plant.w, loop.plant.J
    R, lam = loop.controller_states["R"], loop.parameter_symbols["lambda"]
    torques = ca.norm_2(loop.applied_torque) + ca.norm_2(ca.cross(w, J @ w))
    shift = ca.norm_2(loop.augmented_momentum_rate - loop.momentum_rate)
    filter_terms = (lam * R + loop.time_symbols.g**2) * (2 + ca.dot(Omega, J @ Omega))
    return 2 * R * ca.norm_2(Omega) * (torques + shift) + filter_terms


def _in_coordinates(
    loop: ClosedLoop, extra: Mapping[str, Expression], results: list[Expression], *, in_family: bool
) -> DerivativeFunction:
    gain = loop.control.gain
    rate = ca.SX.sym("Omega", 3)
    augmented = gain is not None and not ca.depends_on(gain, loop.plant.w)
    w = rate - 2 * loop.time_symbols.g**2 * gain * loop.plant.bv if augmented else rate
    results = ca.substitute(results, [loop.plant.w], [w])
    states = list(loop.controller_states.values())
    coordinates = ca.vertcat(
        loop.plant.b0, loop.plant.bv, rate, *states, loop.time_symbols.g, loop.time_symbols.g_rate
    )
    arguments = [coordinates, loop.parameters, loop.body, ca.vertcat(*extra.values())]
    function = ca.Function("derivative", arguments, results)
    return DerivativeFunction(loop, function, in_family, augmented)
