"""Refinement: cut the cells where a constant control loses, until what is left to gain is negligible.

Cells in which a component switches are cut close to it on both sides; cells in which the best torque
turns are cut into equal parts, shared out so that the total loss meets the target with the
fewest cells.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from ....models.types import Array
from ..check.switching import SwitchingFunction, switch_points
from ..solvers.scp import LocalAnswer
from ..transcription.mesh import split
from ..transcription.shooting import Shooting

MIN_CUT = 1e-11
"""Shorter cells are not cut: their parts would be a few digits long."""
MAX_CUT = 6
"""A cell is cut into at most this many parts in one round: the estimate is local."""
BRACKET = 0.05
"""Half of the cell left around a switch, as a fraction of the cell it was found in."""


def refined(sigma: SwitchingFunction, target: float) -> tuple[Shooting, Array]:
    """Finer mesh for the same problem, and the old control carried over to it."""
    points: list[list[float]] = [[] for _ in range(sigma.answer.shooting.mesh.size)]
    parts = _parts(sigma, target)
    for i, cell in enumerate(sigma.cells):
        points[int(cell)] = _cuts(sigma, i, int(parts[i]), target)
    return _carried(sigma.answer, points)


def _parts(sigma: SwitchingFunction, target: float) -> NDArray[np.int64]:
    """Parts for each open cell: loss falls as parts^-2, so parts grow as loss^(1/3)."""
    root = np.cbrt(sigma.loss)
    wanted = root * np.sqrt(root.sum() / (0.5 * target))
    return np.asarray(np.clip(np.ceil(wanted - 0.05), 1, MAX_CUT).astype(np.int64))


def _cuts(sigma: SwitchingFunction, cell: int, parts: int, target: float) -> list[float]:
    """Where to cut one cell; nowhere if it loses less than its fair share."""
    if parts < 2 or sigma.length[cell] < MIN_CUT or sigma.loss[cell] < 0.05 * target / len(sigma.loss):
        return []
    inside = [(s, j) for s, j in switch_points(sigma, cell) if 1e-3 < s < 1 - 1e-3]
    brackets, turns = _bracketed([s for s, j in inside if j >= 0]), [s for s, j in inside if j < 0]
    norm = sigma.answer.shooting.scaled.problem.norm
    if any(j >= 0 for _, j in inside) and not any(block.is_round for block in norm.blocks):
        return _apart(brackets)
    equal = [j / parts for j in range(1, parts)]
    return _apart(sorted(equal + turns + brackets))


def _bracketed(switches: list[float]) -> list[float]:
    """Cuts on both sides of each switch: where its place is not quite known yet, it is in a short cell.

    A switch inside a cell of length h loses in proportion to h^2, so that a bracket shrinks the
    loss as much as the place is known; a cut at the place itself leaves the error times a long cell.
    """
    around = sorted(s + d for s in switches for d in (-BRACKET, BRACKET))
    return [s for s in around if 1e-2 < s < 1 - 1e-2]


def _apart(points: list[float]) -> list[float]:
    """Drop points closer than a hundredth of the cell to the one before."""
    kept: list[float] = []
    for s in points:
        if not kept or s - kept[-1] > 1e-2:
            kept.append(s)
    return kept


def smoothed(answer: LocalAnswer, tolerance: float) -> tuple[Shooting, Array] | None:
    """Halve every cell whose integration error exceeds the tolerance; None if none does."""
    shooting, trajectory = answer.shooting, answer.trajectory
    error = shooting.propagator.step_errors(trajectory.states, trajectory.torque)
    if not (error > tolerance).any():
        return None
    return _carried(answer, [[0.5] if bad else [] for bad in error > tolerance])


def _carried(answer: LocalAnswer, points: list[list[float]]) -> tuple[Shooting, Array]:
    """Cut the cells at the points and carry the control over."""
    shooting = answer.shooting
    mesh, scaled = shooting.mesh, shooting.scaled
    finer, parents = split(mesh, scaled.problem.window, points)
    full = np.zeros((mesh.size, answer.trajectory.control.shape[1]))
    full[mesh.open] = answer.trajectory.control
    return Shooting(scaled, finer, shooting.sign), full[parents][finer.open]
