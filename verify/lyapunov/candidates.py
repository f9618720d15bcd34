"""Storage functions to be proved: the weighted family's, with its exact derivative; or the law's own.

For a law of the family the derivative is, with Omega = w + 2 g^2 kappa bv,

    V' = R Q + g^2 (1 - k* R) P                     adaptive gain, V with the term (k - k*)^2/(2 gamma)
    V' = R Q                                        kappa = 1/R
    Q = -lambda Omega'J Omega - 2 a lambda (1 - b0) + a bv.Omega
    P = 2 a |bv|^2 + (1 + b0) Omega'J Omega

where a is the weight (1 in Ram & Akella, AAS 21-402).
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

import casadi as ca
import numpy as np

from ...models.closed_loop import ClosedLoop, close_loop
from ...models.laws import LAWS, Expression, Law
from ...models.storage import weighted_storage


class NoStorageError(ValueError):
    """A law without a storage function."""


@final
@dataclass(frozen=True)
class Candidate:
    """A storage function on a closed loop, ready to be proved.

    Attributes
    ----------
    loop : the closed loop
    value : V
    derivative : V' along the loop, or None if only the chain rule gives it
    reference : W, what a rate is stated against
    right_side : what V' should equal identically, or None
    shift : y - w in the coordinate y = w + shift (Omega for the family), (3,)
    momentum_gradient : q with J q = dV/dw, (3,), if there is one that does not depend on J^-1
    floor : the symbol k* = 1/R_min if V has it; the claim is then about R >= R_min
    weight : the symbol a in V if it is free, else None (it is then a parameter of the law, or absent)
    """

    loop: ClosedLoop
    value: Expression
    derivative: Expression | None
    reference: Expression
    right_side: Expression | None
    shift: Expression
    momentum_gradient: Expression | None
    floor: Expression | None
    weight: Expression | None


def offers_storage(law: Law) -> bool:
    """Whether there is a V to speak of: the law's own, or its family's (filter state R, gain kappa)."""
    own = "storage" in vars(law) or type(law).storage is not Law.storage
    has_filter = any(state.name == "R" for state in law.controller_states)
    return own or (has_filter and close_loop(law).control.gain is not None)


def storage_step(law: Law) -> str:
    """What the user of a law can do where nothing follows from V' for it."""
    if LAWS.get(law.name) is type(law):
        return "leave lyapunov.* out of [check] claims: the law's other claims do not rest on V"
    return f"return a storage function V from {type(law).__name__}.storage (docs/theory-lyapunov.md)"


def candidate(loop: ClosedLoop) -> Candidate:
    """Return the law's own storage function if it has one, else the weighted family's.

    Raises
    ------
    NoStorageError
        If there is neither, or the law's states jump.
    """
    if "reset_instants" in vars(loop.law) or type(loop.law).reset_instants is not Law.reset_instants:
        raise NoStorageError(f"law {loop.law.name} resets its states: a jump of V is not covered by V' <= 0")
    own = loop.law.storage(loop.plant, loop.time_symbols, loop.controller_states, loop.parameter_symbols)
    if own is not None:
        return _own(loop, ca.SX(own))
    given = loop.law.parameters
    for name in ("lambda", "gamma", "a"):
        if given.get(name, Fraction(1)) <= 0:
            raise NoStorageError(f"law {loop.law.name}: the family's V needs {name} > 0")
    try:
        return _family(loop)
    except ValueError as error:
        raise NoStorageError(str(error)) from None


def _own(loop: ClosedLoop, value: Expression) -> Candidate:
    if value.shape != (1, 1):
        raise NoStorageError(f"law {loop.law.name}: Law.storage must be scalar, received {value.shape}")
    if strays := loop.strays(value):
        raise NoStorageError(f"law {loop.law.name}: Law.storage uses the symbol {strays[0]} of its own")
    if ca.depends_on(value, loop.time_symbols.g_rate):
        raise NoStorageError(f"law {loop.law.name}: Law.storage must not use time.g_rate")
    gradient = ca.gradient(value, loop.plant.w)
    unit = ca.substitute(gradient, loop.body[:6], ca.SX([1, 0, 0, 1, 0, 1]))
    momentum_gradient = unit if _agree(loop, loop.plant.J @ unit, gradient) else None
    return Candidate(loop, value, None, value, None, _shift(loop), momentum_gradient, None, None)


def _agree(loop: ClosedLoop, left: Expression, right: Expression) -> bool:
    """Whether two expressions look equal, at one state (what rests on it is checked as polynomials)."""
    size = sum(argument.numel() for argument in loop.arguments)
    numbers = ca.DM([1 + (0.618 * i) % 1 for i in range(size)])
    function = ca.Function("difference", [ca.veccat(*loop.arguments)], [left - right, left])
    difference, value = (np.array(x) for x in function(numbers))
    return bool(np.all(np.abs(difference) <= 1e-9 * np.abs(value).max()))


def _shift(loop: ClosedLoop) -> Expression:
    """Omega - w, for a gain that does not depend on the rate; otherwise nothing is gained by it."""
    gain, w = loop.control.gain, loop.plant.w
    if gain is None or ca.depends_on(ca.SX(gain), w):
        return ca.SX.zeros(3)
    return ca.substitute(loop.augmented_rate, w, ca.SX.zeros(3))


def _family(loop: ClosedLoop) -> Candidate:
    needed = ["lambda", *(["gamma"] if "k" in loop.controller_states else [])]
    in_family = "R" in loop.controller_states and loop.control.gain is not None
    if in_family and any(name not in loop.parameter_symbols for name in needed):
        raise NoStorageError(
            f"law {loop.law.name} offers no storage function, and that of the family "
            f"Omega = w + 2 g^2 kappa bv is stated in parameters {' and '.join(needed)} that it does not have"
        )
    storage = weighted_storage(loop)
    weight, parameters = storage.weight, loop.parameter_symbols
    own_weight = parameters.get("a")
    Q, P = bracket_terms(loop, weight)
    R, g = loop.controller_states["R"], loop.time_symbols.g
    right = R * Q
    if storage.gain_target is not None:
        right = right + g**2 * (1 - storage.gain_target * R) * P
    fixed = own_weight if own_weight is not None else (ca.SX(1) if "k" in loop.controller_states else None)

    def settle(expression: Expression) -> Expression:
        return expression if fixed is None else ca.substitute(expression, weight, fixed)

    return Candidate(
        loop=loop,
        value=settle(storage.value),
        derivative=settle(storage.derivative),
        reference=settle(storage.reference),
        right_side=settle(right),
        shift=_shift(loop),
        momentum_gradient=2 * R * loop.augmented_rate,
        floor=storage.gain_target,
        weight=weight if fixed is None else None,
    )


def bracket_terms(loop: ClosedLoop, weight: Expression | Fraction | int) -> tuple[Expression, Expression]:
    """Q and P of the derivative of the family's storage function (see the module)."""
    a = weight if isinstance(weight, ca.SX) else ca.SX(float(weight))
    lam, Omega, b0, bv = loop.parameter_symbols["lambda"], loop.augmented_rate, loop.plant.b0, loop.plant.bv
    energy = ca.dot(Omega, loop.plant.J @ Omega)
    Q = -lam * energy - 2 * a * lam * (1 - b0) + a * ca.dot(bv, Omega)
    P = 2 * a * ca.sumsqr(bv) + (1 + b0) * energy
    return Q, P
