"""Storage functions and their exact derivatives along a closed loop.

V = R (2 a (1 - b0) + Omega'J Omega) + (k - k*)^2 / (2 gamma)

with k* = 1/R_min; the last term only where the law has a gain state k. a = 1 is the function
of Ram & Akella (AAS 21-402), 2 (1 - b0) R + R Omega'J Omega + (k - k*)^2/(2 gamma).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

import casadi as ca

from .closed_loop import ClosedLoop
from .laws import Expression


@final
@dataclass(frozen=True, eq=False)
class Storage:
    """A storage function on a closed loop.

    Attributes
    ----------
    weight : SX, the symbol a, kg m^2/s^2
    gain_target : SX or None, the symbol k* = 1/R_min, 1/s (laws with a gain state)
    value : V
    derivative : V' along the closed loop, by the chain rule on the loop's own expressions
    reference : W = R (2 a (1 - b0) + Omega'J Omega), what a decay rate is stated against
    """

    weight: Expression
    gain_target: Expression | None
    value: Expression
    derivative: Expression
    reference: Expression


def weighted_storage(loop: ClosedLoop) -> Storage:
    """Storage function of a law of the family on its closed loop.

    Raises
    ------
    ValueError
        If the law has no filter state R or no gain kappa.
    """
    if "R" not in loop.controller_states or loop.control.gain is None:
        raise ValueError(
            f"law {loop.law.name} offers no storage function, and is not of the family "
            "Omega = w + 2 g^2 kappa bv whose V is known"
        )
    a = ca.SX.sym("a_storage")
    R, Omega = loop.controller_states["R"], loop.augmented_rate
    energy = ca.dot(Omega, loop.plant.J @ Omega)
    reference = R * (2 * a * (1 - loop.plant.b0) + energy)
    value, derivative = reference, _weighted_derivative(loop, R, a, energy)
    target = None
    if "k" in loop.controller_states:
        target = ca.SX.sym("k_target")
        k, gamma = loop.controller_states["k"], loop.parameter_symbols["gamma"]
        value = value + (k - target) ** 2 / (2 * gamma)
        derivative = derivative + (k - target) * loop.control.state_rates["k"] / gamma
    return Storage(a, target, value, derivative, reference)


def _weighted_derivative(loop: ClosedLoop, R: Expression, a: Expression, energy: Expression) -> Expression:
    """d/dt of R (2 a (1 - b0) + Omega'J Omega), free of J^-1 (through J Omega')."""
    R_rate = loop.control.state_rates["R"]
    kinetic_rate = 2 * ca.dot(loop.augmented_rate, loop.augmented_momentum_rate)
    inner_rate = -2 * a * loop.plant.b0_rate + kinetic_rate
    return R_rate * (2 * a * (1 - loop.plant.b0) + energy) + R * inner_rate
