"""What a search for V' > 0 counts in, so that it finds the same in any units of inertia and time."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import Any, final

import casadi as ca
import numpy as np

from ...models.closed_loop import body_values
from ...models.rigid_body import RigidBody
from ...models.types import Array
from .candidates import Candidate


@final
@dataclass(frozen=True)
class SearchUnits:
    """Units of a search.

    Attributes
    ----------
    states : unit of each controller state: one in s counts in the start of the first such state, one in
        1/s in its reciprocal, any other in its own start, or in 1 if that is 0
    target : k* = 1/R_min of the search, 1/s; R is searched above R_min
    ratio : J^(1/2) Omega over the half error angle at which rate and attitude weigh the same in W
    reference : W at a half error angle of 1 rad and at rest
    """

    states: dict[str, Fraction]
    target: Fraction
    ratio: float
    reference: float

    @classmethod
    def of(cls, candidate: Candidate, body: RigidBody, weight: Fraction) -> SearchUnits:
        """Read them off the law's states and its W."""
        states = candidate.loop.law.controller_states
        times = [s.initial for s in states if s.unit == "s" and s.initial > 0]
        time = times[0] if times else Fraction(1)
        known = {"s": time, "1/s": 1 / time}
        units = {s.name: known.get(s.unit, abs(s.initial) or Fraction(1)) for s in states}
        reference = _reference(candidate, body, weight, 1 / time)
        still, along, against = (
            float(reference([0, 1, 0, 0, x, 0, 0, *map(float, units.values())], 0.0))
            for x in (0.0, 1.0, -1.0)
        )
        turning = (along + against) / 2 - still
        sized = still > 0 and turning > 0 and math.isfinite(still) and math.isfinite(turning)
        return cls(units, 1 / time, math.sqrt(still / turning) if sized else 1.0, still if sized else 1.0)


def _reference(candidate: Candidate, body: RigidBody, weight: Fraction, target: Fraction) -> Any:
    """W as a CasADi function of the coordinates but time, at g given by its second argument."""
    loop, n = candidate.loop, len(candidate.loop.controller_states)
    z, g = ca.SX.sym("z", 7 + n), ca.SX.sym("g")
    theta, axis = ca.exp(z[0]), z[1:4] / ca.norm_2(z[1:4])
    w = theta * ca.mtimes(ca.DM(inverse_root(body)), z[4:7]) - ca.SX(candidate.shift)
    value = ca.substitute(ca.SX(candidate.reference), loop.plant.w, w)
    time = ca.vertcat(g, ca.SX.zeros(loop.time.shape[0] - 1))
    symbols = [loop.plant.b0, loop.plant.bv, *loop.controller_states.values(), loop.time]
    values = [ca.cos(theta), ca.sin(theta) * axis, *(z[7 + i] for i in range(n)), time]
    for symbol, number in ((candidate.floor, target), (candidate.weight, weight)):
        if symbol is not None:
            symbols, values = [*symbols, symbol], [*values, ca.SX(float(number))]
    symbols, values = (
        [*symbols, loop.parameters, loop.body],
        [*values, ca.SX(loop.parameter_values()), ca.SX(body_values(body))],
    )
    return ca.Function("W", [z, g], ca.substitute([value], symbols, values))


def inverse_root(body: RigidBody) -> Array:
    """J^(-1/2) in floats, (3, 3)."""
    values, vectors = np.linalg.eigh(np.asarray(body.inertia))
    root: Array = (vectors / np.sqrt(values)) @ vectors.T
    return root
