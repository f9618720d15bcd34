"""The switching function, and Pontryagin's condition measured cell by cell.

With y the multiplier of the terminal residual, sigma(t) = -(d residual / d impulse at t)' y is
the switching function: the least peak asks that the control be, at each instant of a window,
a unit effort times the peak that makes sigma . v greatest. What a control constant on cells
loses against that is

    loss_k = integral over the cell of w support(sigma) - support(integral of w sigma)  >=  0,

and the sum over the cells (normalised: the first terms sum to about 1) estimates, to first
order, by which fraction the peak would still fall with infinitely fine cells.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from numpy.typing import NDArray

from ....models.types import Array
from ..solvers.scp import LocalAnswer

GAUSS_NODES, GAUSS_WEIGHTS = (
    np.polynomial.legendre.leggauss(8)[0] / 2 + 0.5,
    np.polynomial.legendre.leggauss(8)[1] / 2,
)


@final
@dataclass(frozen=True)
class SwitchingFunction:
    """sigma on every open cell, as quadratics that match both ends and the cell's own integral.

    Attributes
    ----------
    cells : (n,) int
        Index of each open cell in the mesh.
    start, length : (n,)
        Solver time.
    coefficients : (n, 3, m)
        sigma(s) = c0 + c1 s + c2 s^2 with s in [0, 1] on the cell.
    loss : (n,)
        What the constant control loses on each cell, as a fraction of the peak.
    largest_worth : float
        Largest support(sigma) at an edge: fraction of the peak gained by a unit of open solver time.
    """

    answer: LocalAnswer
    cells: NDArray[np.int64]
    start: Array
    length: Array
    coefficients: Array
    loss: Array
    largest_worth: float

    @property
    def total_loss(self) -> float:
        """Fraction by which finer cells would still lower the peak, to first order."""
        return float(self.loss.sum())

    def at(self, s: Array) -> Array:
        """Sigma at the fractions s (q,) of every open cell, (n, q, m)."""
        powers = np.asarray(s)[:, None] ** np.arange(3)
        return np.asarray(np.einsum("qj,njm->nqm", powers, self.coefficients))

    @cached_property
    def pontryagin_residual(self) -> float:
        """Integral over the windows of what the control misses of its worth against sigma, as a fraction.

        For the least peak that is w (peak * support(sigma) - sigma . v) / peak; 0 at an extremal,
        never below.
        """
        mesh = self.answer.shooting.mesh
        norm = self.answer.shooting.scaled.problem.norm
        sigma = self.at(GAUSS_NODES)
        w = np.stack([mesh.window_at(float(s))[self.cells] for s in GAUSS_NODES], axis=1)
        measure = w * GAUSS_WEIGHTS * self.length[:, None]
        goal, flow = self.answer.goal, np.full(sigma.shape[:-1], 1.0 / float(mesh.impulse.sum()))
        control, value = self.answer.trajectory.control[:, None, :], self.answer.value
        missed = goal.hamiltonian_gain(norm, sigma, flow) - goal.gain(norm, sigma, flow, control, value)
        return float((measure * missed).sum() / goal.unit(value))


def switching_function(answer: LocalAnswer) -> SwitchingFunction:
    """Build sigma from the multipliers and the sensitivities of a local answer."""
    mesh, norm = answer.shooting.mesh, answer.shooting.scaled.problem.norm
    cells = np.flatnonzero(mesh.open)
    nodes = -np.einsum("i,ikm->km", answer.multiplier, answer.sensitivity.response)
    integral = -np.einsum("i,ikm->km", answer.multiplier, answer.sensitivity.terminal)
    left, right, length = nodes[cells], nodes[cells + 1], mesh.lengths[cells]
    moments = _moments(mesh.profile[cells])
    target = integral / length[:, None]
    # sigma = left + (right - left) s + bulge s (s - 1): the bulge makes the integral of w sigma right
    chord = left * moments[:, :1] + (right - left) * moments[:, 1:2]
    curve = moments[:, 2:3] - moments[:, 1:2]
    bulge = (target - chord) / np.where(np.abs(curve) > 1e-12, curve, np.inf)
    coefficients = np.stack([left, right - left - bulge, bulge], axis=1)
    powers = GAUSS_NODES[:, None] ** np.arange(3)
    sigma = np.einsum("qj,njm->nqm", powers, coefficients)
    w = np.stack([mesh.window_at(float(s))[cells] for s in GAUSS_NODES], axis=1)
    goal, flow = answer.goal, np.full(sigma.shape[:-1], 1.0 / float(mesh.impulse.sum()))
    ideal = ((w * GAUSS_WEIGHTS) * goal.hamiltonian_gain(norm, sigma, flow)).sum(axis=1) * length
    done = goal.hamiltonian_gain(norm, integral, answer.shooting.weights)
    loss = np.maximum(ideal - done, 0.0) / goal.unit(answer.value)
    cost = np.full(nodes.shape[:-1], 1.0 / float(mesh.impulse.sum()))
    worth = float(goal.hamiltonian_gain(norm, nodes, cost).max()) / goal.unit(answer.value)
    return SwitchingFunction(answer, cells, mesh.edges[cells], length, coefficients, loss, worth)


def _moments(profile: Array) -> Array:
    """Integrals over [0, 1] of w, w s and w s^2 on each cell, (n, 3)."""
    power = np.arange(profile.shape[1])
    return np.stack([(profile / (power + j + 1)).sum(axis=1) for j in range(3)], axis=1)


def switch_points(sigma: SwitchingFunction, cell: int) -> list[tuple[float, int]]:
    """Fractions inside one open cell where the best control switches, and which control; -1: a ball's.

    With limits on each control (or least impulse, off or full) a switch shows as a value strictly
    between the limits: the mean of the two sides, which says where between them the switch lies.
    (The zero of sigma does not: the solver puts its mean over such a cell at zero.) With a peak of a
    ball's length it is where |sigma| dips, because the direction swings round there.
    """
    answer, norm = sigma.answer, sigma.answer.shooting.scaled.problem.norm
    fraction = answer.goal.switch_fraction(norm, answer.trajectory.control[cell], answer.value)
    ends = answer.goal.switching_function(norm, sigma.at(np.array([0.0, 1.0]))[cell])
    found = [
        (float(f if up <= 0 else 1.0 - f), j)
        for f, up, j in zip(fraction, ends[1] - ends[0], answer.goal.switches(norm), strict=True)
        if 1e-3 < f < 1.0 - 1e-3
    ]
    return sorted(found + [(s, -1) for s in _turning_points(sigma, cell)])


def _turning_points(sigma: SwitchingFunction, cell: int) -> list[float]:
    """Fractions inside one open cell where a ball's best direction swings round."""
    found, grid = [], np.linspace(0.0, 1.0, 33)
    for at in sigma.answer.goal.turning(sigma.answer.shooting.scaled.problem.norm):
        size = np.linalg.norm(sigma.at(grid)[cell][:, at], axis=1)
        k = int(np.argmin(size))
        if 0 < k < 32 and size[k] < 0.5 * min(size[0], size[-1]):
            found.append(float(grid[k]))
    return found


def switch_times(sigma: SwitchingFunction) -> tuple[tuple[float, int], ...]:
    """Instants (s) and controls at which the best control switches inside a window; -1: a ball's.

    A control switches inside a cell where its value lies between the limits, and at an edge
    where it goes from one limit to the other. Changes across a closed arc are not switches.
    """
    answer = sigma.answer
    norm = answer.shooting.scaled.problem.norm
    unit = answer.shooting.scaled.units.time
    found = [
        (float(sigma.start[i] + s * sigma.length[i]), -1)
        for i in range(len(sigma.cells))
        for s in _turning_points(sigma, i)
    ]
    high = answer.goal.switch_fraction(norm, answer.trajectory.control, answer.value)
    for column, control in enumerate(answer.goal.switches(norm)):
        found += [(t, control) for t in _throws(sigma, high, column)]
    return tuple(sorted((t * unit, j) for t, j in found))


def _throws(sigma: SwitchingFunction, high: Array, j: int) -> list[float]:
    """Instants, solver time, at which switch j is thrown inside the windows."""
    found = []
    last: tuple[float, float] | None = None
    for i in range(len(sigma.cells)):
        joined = i > 0 and sigma.cells[i] == sigma.cells[i - 1] + 1
        switch_fraction = float(high[i, j])
        start, end = float(sigma.start[i]), float(sigma.start[i] + sigma.length[i])
        if not joined:
            last = None
        if 1e-3 < switch_fraction < 1 - 1e-3:
            # between the limits: the switch lies inside, nearer the limit held longer
            after = _next_side(high, i, j)
            part = switch_fraction if after < 0.5 else 1.0 - switch_fraction
            found.append(start + part * (end - start))
            last = (end, after)
            continue
        if last is not None and abs(switch_fraction - last[1]) > 0.5:
            found.append(start)
        last = (end, switch_fraction)
    return found


def _next_side(high: Array, cell: int, j: int) -> float:
    """Limit (0 low, 1 high) component j is at after a cell in which it switches."""
    for value in high[cell + 1 :, j]:
        if value < 1e-3 or value > 1 - 1e-3:
            return float(round(value))
    return 1.0 - float(round(high[cell - 1, j])) if cell > 0 else 0.0
