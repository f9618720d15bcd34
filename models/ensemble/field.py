"""The closed loop's right-hand side over a stack of runs."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from fractions import Fraction
from functools import lru_cache
from typing import Any, final

import numpy as np

from ..closed_loop import ClosedLoop, Saturation, close_loop
from ..laws import Law
from ..lowering import ArrayFunction, shared, walk
from ..lowering.jumps import jumps
from ..simulation.coasting import PLANT
from ..simulation.phases import Phase, phase_arguments
from ..types import Array
from .step import Index, Mask

COEFFICIENTS, PARAMETERS, BODY = 2, 3, 4
"""Arguments of the lowered right-hand side after (tau, state)."""


@final
@dataclass(frozen=True)
class Structure:
    """What a closed loop's expressions depend on: all of a law but its exact and float parameters."""

    law: Law = field(compare=False)
    saturation: Saturation | None
    kind: type[Law]
    settings: tuple[tuple[str, Any], ...]

    @classmethod
    def of(cls, law: Law, saturation: Saturation | None) -> Structure:
        """Structure of a law; two laws of one structure share all compiled functions."""
        law_fields: Any = law
        values = {f.name: getattr(law, f.name) for f in fields(law_fields)}
        settings = tuple((k, v) for k, v in values.items() if not isinstance(v, (Fraction, float)))
        return cls(law, saturation, type(law), settings)


@lru_cache(maxsize=64)
def representative_loop(structure: Structure) -> ClosedLoop:
    """One closed loop for all laws of a structure; parameters are symbols in it."""
    return close_loop(structure.law, structure.saturation)


def field_function(structure: Structure, degree: int, *, coasting: bool, held: bool = False) -> Any:
    """Right-hand side (tau, state, coefficients, parameters, body) as a CasADi function.

    `coasting` is for phases without torque: g and g' are exact zeros and their terms are gone. The
    controller states are `held` where what they do meanwhile is known exactly.
    """
    import casadi as ca

    loop = representative_loop(structure)
    tau, coefficients, time = phase_arguments(loop, degree)
    if coasting:
        time[0], time[1] = 0, 0
    (rate,) = ca.substitute([loop.state_rate], [loop.time], [time])
    if coasting and held:
        rate[PLANT:] = 0
    arguments = [tau, loop.state, coefficients, loop.parameters, loop.body]
    return ca.Function("stacked_field", arguments, [ca.densify(ca.SX(rate))])


@lru_cache(maxsize=64)
def lowered_field(
    structure: Structure, degree: int, uniform: frozenset[int], *, coasting: bool, held: bool
) -> ArrayFunction:
    """Right-hand side as an array function."""
    program = shared(walk(field_function(structure, degree, coasting=coasting, held=held)))
    return ArrayFunction(program, uniform=sorted({COEFFICIENTS} | uniform))


@final
class StackedField:
    """Right-hand side of the runs in a stack, phase after phase.

    Parameters
    ----------
    structure : Structure
        Of the law.
    parameters : (p, N), or (p,) if all runs share them.
    body : (12, N), or (12,) if all runs share them.
    degree : int
        Largest degree of the signals.
    held : bool
        Whether coasts leave the controller states alone.
    """

    def __init__(
        self, structure: Structure, parameters: Array, body: Array, *, degree: int, held: bool = False
    ) -> None:
        self._all = (parameters, body)
        self._degree = degree
        both = ((PARAMETERS, parameters), (BODY, body))
        uniform = frozenset(i for i, values in both if values.ndim == 1)
        self._functions = [
            lowered_field(structure, degree, uniform, coasting=coasting, held=held)
            for coasting in (False, True)
        ]
        self._origin = 0.0

    @property
    def jumps(self) -> bool:
        """Whether the right-hand side jumps anywhere."""
        return any(jumps(function.program) for function in self._functions)

    def enter(self, phase: Phase, runs: Index) -> None:
        """Take the signals of a phase and the given runs."""
        self._function = self._functions[phase.is_torque_free]
        self._origin = float(phase.origin)
        self._coefficients = phase.coefficient_array(self._degree).ravel(order="F")
        self._parameters, self._body = (_chosen(values, runs) for values in self._all)
        self._know()

    def keep(self, kept: Mask) -> None:
        """Drop the other runs."""
        self._parameters, self._body = _chosen(self._parameters, kept), _chosen(self._body, kept)

    def __call__(self, t: Array, y: Array, out: Array) -> None:
        """Write x' (n, m) at times t (m,) and states y (n, m) into `out`."""
        rows = ((t - self._origin)[None], y, self._coefficients, self._parameters, self._body)
        self._function.run_blocks(rows, (out,), self._known, t.size)

    def _know(self) -> None:
        empty = np.empty((0, 0))
        rows = (empty, empty, self._coefficients, self._parameters, self._body)
        self._known = self._function.known(rows)


def _chosen(values: Array, runs: Index | Mask) -> Array:
    """Values (p, N) of some of the runs; shared ones (p,) as they are."""
    return values if values.ndim == 1 else np.ascontiguousarray(values[:, runs])
