"""Torques, filter state and distance from the target along runs, as one array function."""

from __future__ import annotations

from functools import lru_cache
from typing import final

import numpy as np

from ..lowering import ArrayFunction, shared, walk
from ..norms import EUCLIDEAN, Norm
from ..simulation.phases import Phase, phase_arguments, signal_degree
from ..types import Array
from .field import Structure, representative_loop
from .runs import Runs
from .step import Index

Name = tuple[str, Norm | None]
"""What is looked at, and in which norm if it is a torque."""
LENGTH: Name = ("length", None)
FILTER: Name = ("filter_minimum", None)
SETTLING: Name = ("settling", None)


def extremes(norms: tuple[Norm, ...]) -> tuple[Name, ...]:
    """Quantities whose largest value along a run is wanted (the filter state with its sign turned)."""
    peaks = [(name, norm) for name in ("peak", "peak_commanded") for norm in norms]
    return (*peaks, FILTER, SETTLING)


@final
class Observables:
    """Observables of runs at given states, (name -> (m, p)): the extremes, and the torque's length."""

    def __init__(
        self, runs: Runs, phases: tuple[Phase, ...], attitude: float, rate: float, norms: tuple[Norm, ...]
    ) -> None:
        degree = signal_degree(phases)
        self._names = (*extremes(norms), LENGTH)
        self._function = _lowered(runs.structure, degree, norms)
        self._origins = np.array([float(p.origin) for p in phases])
        self._coefficients = np.stack([p.coefficient_array(degree).ravel(order="F") for p in phases], axis=1)
        self._parameters, self._body = (
            np.broadcast_to(v if v.ndim == 2 else v[:, None], (v.shape[0], runs.count))
            for v in (runs.parameters, runs.body)
        )
        self._tolerances = np.array([attitude, rate])

    def __call__(self, runs: Index, phase: Index, times: Array, states: Array) -> dict[Name, Array]:
        """Values for runs (m,) in phases (m,) at times (m, p), s, and states (m, p, n)."""
        points = times.shape[1]
        each = np.repeat(np.arange(runs.size), points)
        tau = (times - self._origins[phase][:, None]).reshape(1, -1)
        (values,) = self._function(
            tau,
            np.ascontiguousarray(states.reshape(-1, states.shape[2]).T),
            self._coefficients[:, phase[each]],
            self._parameters[:, runs[each]],
            self._body[:, runs[each]],
            self._tolerances,
        )
        return {name: row.reshape(times.shape) for name, row in zip(self._names, values, strict=True)}


@lru_cache(maxsize=64)
def _lowered(structure: Structure, degree: int, norms: tuple[Norm, ...]) -> ArrayFunction:
    """Observables of (tau, state, coefficients, parameters, body, tolerances)."""
    import casadi as ca

    loop = representative_loop(structure)
    tau, coefficients, time = phase_arguments(loop, degree)
    tolerances = ca.SX.sym("tolerances", 2)
    u, applied = loop.control.torque, loop.applied_torque
    # commanded torque counts in phases with g only: all of g's coefficients vanish in the others
    acts = ca.if_else(ca.sumsqr(coefficients[0, :]) > 0, 1, 0)
    R = loop.controller_states.get("R")
    expressions = [
        *(norm.peak_expression(applied) for norm in norms),
        *(acts * norm.peak_expression(u) for norm in norms),
        -R if R is not None else -ca.SX(np.inf),
        ca.fmax(ca.norm_2(loop.plant.bv) / tolerances[0], ca.norm_2(loop.plant.w) / tolerances[1]) - 1,
        EUCLIDEAN.peak_expression(applied),
    ]
    (values,) = ca.substitute([ca.vertcat(*expressions)], [loop.time], [time])
    arguments = [tau, loop.state, coefficients, loop.parameters, loop.body, tolerances]
    program = shared(walk(ca.Function("observables", arguments, [ca.densify(values)])))
    return ArrayFunction(program, uniform=(5,))
