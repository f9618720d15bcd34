"""What the runs of an ensemble start from: laws, bodies and states, one or one each."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import final

import numpy as np
from numpy.typing import ArrayLike

from ..closed_loop import ClosedLoop, Saturation, body_values
from ..laws import Law
from ..rigid_body import RigidBody
from ..types import Array
from .field import Structure, representative_loop


@final
@dataclass(frozen=True, eq=False)
class Runs:
    """Inputs of N runs, checked.

    Attributes
    ----------
    structure : Structure
        Common to the laws.
    law : Law
        The first one: its signals and reset instants serve all runs.
    states : (n, N), quaternion, rate, controller states
    parameters : (p, N), or (p,) if one law serves all runs
    body : (12, N), or (12,) if one body serves all runs
    """

    structure: Structure
    law: Law
    states: Array
    parameters: Array
    body: Array

    @property
    def count(self) -> int:
        """Number of runs, N."""
        return int(self.states.shape[1])

    @property
    def loop(self) -> ClosedLoop:
        """Closed loop of the first law, with parameters as symbols."""
        return representative_loop(self.structure)

    def part(self, start: int, stop: int) -> Runs:
        """Runs start, ..., stop - 1."""
        parameters = self.parameters if self.parameters.ndim == 1 else self.parameters[:, start:stop]
        body = self.body if self.body.ndim == 1 else self.body[:, start:stop]
        return Runs(self.structure, self.law, self.states[:, start:stop], parameters, body)


def gather_runs(
    laws: Law | Sequence[Law],
    bodies: RigidBody | Sequence[RigidBody],
    initial_states: ArrayLike,
    saturation: Saturation | None,
) -> Runs:
    """Check the inputs of an ensemble and bring them to one number of runs.

    Raises
    ------
    ValueError
        If numbers of runs differ, laws differ in structure, a state has the wrong size or a
        quaternion is not unit to 1e-9.
    """
    many_laws = [laws] if isinstance(laws, Law) else list(laws)
    many_bodies = [bodies] if isinstance(bodies, RigidBody) else list(bodies)
    states = np.atleast_2d(np.asarray(initial_states, dtype=float))
    if not many_laws or not many_bodies or not states.size:
        raise ValueError("an ensemble needs at least one law, one body and one initial state")
    counts = {len(many_laws), len(many_bodies), len(states)}
    count = max(counts)
    if counts - {1, count}:
        raise ValueError(
            f"an ensemble of {count} runs needs one law, body and initial state, or {count} of each: "
            f"received {len(many_laws)} laws, {len(many_bodies)} bodies, {len(states)} states"
        )
    structure = _common_structure(many_laws, saturation)
    full = _with_controller_states(many_laws, states)
    parameters = _columns([np.array([float(v) for v in law.parameters.values()]) for law in many_laws])
    body = _columns([body_values(b) for b in many_bodies])
    return Runs(structure, many_laws[0], np.broadcast_to(full.T, (full.shape[1], count)), parameters, body)


def _common_structure(laws: list[Law], saturation: Saturation | None) -> Structure:
    structure = Structure.of(laws[0], saturation)
    for number, law in enumerate(laws[1:], start=1):
        other = Structure.of(law, saturation)
        if other != structure:
            raise ValueError(
                f"laws of one ensemble may differ in their exact or float parameters only: law {number} is "
                f"{other.kind.__name__}{dict(other.settings)}, law 0 {structure.kind.__name__}"
                f"{dict(structure.settings)}"
            )
    return structure


def _with_controller_states(laws: list[Law], states: Array) -> Array:
    """States (1 or N, n): where only attitude and rate are given, each law's own initial values follow."""
    norms = np.linalg.norm(states[:, :4], axis=1)
    wrong = np.flatnonzero(~(np.abs(norms - 1) <= 1e-9))
    if wrong.size:
        raise ValueError(f"initial quaternions must be unit: run {wrong[0]} has norm {norms[wrong[0]]}")
    if not np.isfinite(states).all():
        raise ValueError("initial states must be finite numbers")
    size = 7 + len(laws[0].controller_states)
    if states.shape[1] == size:
        return states
    if states.shape[1] != 7:
        raise ValueError(
            f"an initial state has 7 numbers (quaternion, rate) or {size} (controller states too): "
            f"received {states.shape[1]}"
        )
    controllers = np.array([[float(s.initial) for s in law.controller_states] for law in laws])
    count = max(len(laws), len(states))
    shapes = (count, 7), (count, size - 7)
    return np.hstack([np.broadcast_to(x, s) for x, s in zip((states, controllers), shapes, strict=True)])


def _columns(rows: list[Array]) -> Array:
    return rows[0] if len(rows) == 1 else np.stack(rows, axis=1)
