"""Least impulse of a transfer within a torque limit: the propellant any controller needs at least here.

The same transcription, checks and refinement as for the least peak; the convex program pays for
the integral of w consumption(control) and holds effort(control) below the limit. Starts are
transfers that meet the limit: the least-peak transfers themselves, and bends of them.
"""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from ....models.types import Array
from ...problem import TransferProblem
from ..solvers.goal import LeastImpulse
from ..solvers.scp import LocalAnswer, SequentialConvex
from ..transcription.mesh import mesh_on
from ..transcription.scaling import ScaledProblem, scale
from ..transcription.shooting import Shooting
from .explain import arrives_by_itself
from .finish import Finish
from .guess import bend, control_at
from .minimum_peak import minimum_peak, until_last_window
from .options import MultiStart, Refinement
from .resolution import resolved
from .result import PeakAnswer, Search, Standing, Start


@final
@dataclass(frozen=True)
class LeastImpulseFound:
    """Least impulse found within a limit.

    Attributes
    ----------
    limit : float
        Largest effort, in the norm's unit.
    answer : PeakAnswer
        Checked transfer of the least impulse found (its gaps are fractions of the impulse): an upper bound on
        the least impulse. Without a transfer within the limit, the least peak that shows it.
    found : bool
        Whether `answer` is a transfer within the limit.
    """

    limit: float
    answer: PeakAnswer
    found: bool

    @property
    def impulse(self) -> float:
        """Impulse of the transfer found (N m s; N s for thrusters); inf if none was."""
        return self.answer.impulse if self.found else math.inf


@final
@dataclass(frozen=True)
class _ForImpulse:
    """The sequential convex program with the impulse as its goal."""

    limit: float
    inner: SequentialConvex

    @property
    def name(self) -> str:
        """Name in the record."""
        return self.inner.name

    def solve(self, shooting: Shooting, control: Array, *, tolerance: float | None = None) -> LocalAnswer:
        """Local optimum near a control."""
        # the cone solver may exceed a limit by its own tolerance: leave it that much room
        goal = LeastImpulse((1.0 - 1e-9) * self.limit / shooting.scaled.units.control)
        return self.inner.solve(shooting, control, tolerance=tolerance, goal=goal)


def minimum_impulse(
    problem: TransferProblem,
    limit: float,
    *,
    solver: SequentialConvex | None = None,
    search: MultiStart | None = None,
    refinement: Refinement | None = None,
) -> LeastImpulseFound:
    """Find the least integral of w consumption(torque) over transfers with peak(torque(t)) <= limit w(t).

    Consumption is the norm's own: the torque's length (Euclidean), the sum of its components' sizes
    (each axis has thrusters of its own) or the sum of the thruster forces.

    Parameters
    ----------
    problem : TransferProblem
        The transfer.
    limit : float
        Largest effort, in the norm's unit.
    solver, search, refinement
        As for `minimum_peak`; by default two starts for each sign.

    Raises
    ------
    ValueError
        If the limit is not > 0.
    """
    if limit <= 0:
        raise ValueError(f"the limit must be > 0, received {limit:g}")
    search, refinement = search or MultiStart(starts=2), refinement or Refinement()
    peaks = _least_peaks(problem, search)
    best = min(peaks, key=lambda answer: answer.peak)
    if arrives_by_itself(problem):
        return LeastImpulseFound(limit, best, best.standing is Standing.CHECKED)
    within = [answer for answer in peaks if answer.standing is Standing.CHECKED and answer.peak <= limit]
    if not within:
        return LeastImpulseFound(limit, best, found=False)
    # arcs of intermediate thrust converge slowly
    fast = _ForImpulse(limit, solver or SequentialConvex(max_iterations=120))
    candidates, record = _search(problem, within, fast, search)
    finish = Finish(problem, fast, may_fall_back=False, refinement=refinement, record=record)
    # only starts that led to the same impulse may stand in for one that is not fully checked
    alike = [finish(c) for c in candidates if c.value <= candidates[0].value * (1.0 + 1e-3)]
    if not alike:
        return LeastImpulseFound(limit, best, found=False)
    answer = next((a for a in alike if a.standing is Standing.CHECKED), alike[0])
    return LeastImpulseFound(limit, answer, found=True)


def _least_peaks(problem: TransferProblem, search: MultiStart) -> list[PeakAnswer]:
    """Least peak for each target sign by itself, roughly refined."""
    rough = Refinement(mesh_gap=1e-3)
    return [
        minimum_peak(replace(problem, signs=(sign,)), search=search, refinement=rough)
        for sign in problem.signs
    ]


def _search(
    problem: TransferProblem, within: list[PeakAnswer], solver: _ForImpulse, search: MultiStart
) -> tuple[list[LocalAnswer], Search]:
    """Solve from every start; the feasible answers, cheapest first, and the record of all."""
    scaled = scale(resolved(until_last_window(problem)))
    answers: list[LocalAnswer] = []
    starts: list[Start] = []
    for sign, seed, shooting, control in _starts(scaled, within, solver.limit, search):
        answer = solver.solve(shooting, control, tolerance=search.tolerance)
        usable = answer.violation <= 1e-4
        total = float(shooting.mesh.impulse.sum()) * scaled.units.time
        starts.append(
            Start(
                sign=sign,
                seed=seed,
                peak=answer.value * scaled.units.control * total if usable else math.inf,
                converged=answer.converged,
                iterations=answer.iterations,
            )
        )
        if usable:
            answers.append(answer)
    return sorted(answers, key=lambda a: a.value), Search(tuple(starts))


def _starts(
    scaled: ScaledProblem, within: list[PeakAnswer], limit: float, search: MultiStart
) -> Iterator[tuple[int, int | None, Shooting, Array]]:
    """Target sign, seed of the bend (None for none), mesh and control of every start, within the limit."""
    for number in range(search.starts):
        for peak in within:
            if peak.history is None:
                continue
            inside = peak.history.edges <= float(scaled.problem.horizon) * (1 + 1e-12)
            edges = peak.history.edges[inside] / scaled.units.time
            shooting = Shooting(scaled, mesh_on(scaled.problem.window, edges), peak.sign)
            control = control_at(peak.history, shooting.mesh, scaled.units.time) / scaled.units.control
            seed = search.seed + number - 1 if number else None
            if seed is not None:
                rng = np.random.default_rng([seed, peak.sign + 1])
                control = _within(shooting, bend(shooting, control, rng, search.bend), limit)
            yield peak.sign, seed, shooting, control


def _within(shooting: Shooting, control: Array, limit: float) -> Array:
    """Controls shortened to the limit (and one-sided thrust clipped at zero)."""
    norm = shooting.scaled.problem.norm
    control = norm.clipped(control)
    effort = np.maximum(norm.effort(control), 1e-300)
    most = limit / shooting.scaled.units.control
    return np.asarray(control * np.minimum(1.0, most / effort)[:, None])
