"""Least peak torque of a transfer: search on a coarse mesh, refine the best, check it, or say why not."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np

from ....models.types import Array
from ...problem import TransferProblem
from ..solvers.nlp import NonlinearProgram
from ..solvers.scp import LocalAnswer, SequentialConvex
from ..transcription.mesh import Mesh, build_mesh
from ..transcription.scaling import ScaledProblem, scale
from ..transcription.shooting import Shooting
from .assemble import at_rest_already, without_history
from .explain import arrives_by_itself, explain, missing_direction
from .finish import Finish
from .guess import bend, control_at, first_guess
from .options import LocalSolver, MultiStart, Refinement
from .resolution import resolved
from .result import PeakAnswer, Search, Standing, Start


def coarse_mesh(problem: TransferProblem, cells: int) -> Mesh:
    """Mesh with about `cells` open cells, none of them or of the arcs turning far."""
    # torque-free motion keeps the energy, so that a flat body turns no faster than this
    energy = float(problem.start_rate @ problem.start_momentum)
    tumbling = math.sqrt(energy / float(problem.body.principal_inertias[0]))
    moving = float(problem.horizon) if tumbling else float(problem.horizon - problem.open_pieces[0].start)
    rate = 1.5 * tumbling + 3.0 * problem.angle / moving
    each = max(2, math.ceil(cells / max(len(problem.open_pieces), 1)))
    parts = []
    for piece in problem.window.pieces:
        need = math.ceil(rate * float(piece.length) / 0.35)
        parts.append(max(each if piece.shape else 1, need))
    return build_mesh(problem.window, parts)


_ALIKE = 1e-4
"""Difference of two torque histories over their peak below which they are one local optimum."""


def minimum_peak(
    problem: TransferProblem,
    *,
    solver: LocalSolver | None = None,
    search: MultiStart | None = None,
    refinement: Refinement | None = None,
    near: PeakAnswer | None = None,
) -> PeakAnswer:
    """Find the least p such that some torque with peak(torque(t)) <= p w(t) makes the transfer.

    Parameters
    ----------
    problem : TransferProblem
        The transfer.
    solver : LocalSolver, optional
        The sequential convex program by default, with the nonlinear program as its fallback.
    search : MultiStart, optional
        How many starts, from which seeds.
    refinement : Refinement, optional
        How fine a mesh.
    near : PeakAnswer, optional
        Answer of a neighbouring problem (in a sweep, say): its history, at the same
        instants, is one more start.

    Returns
    -------
    PeakAnswer
        CHECKED only if an independent integration of the returned history meets the terminal
        condition to 1e-8, the optimality gap recomputed outside the solver is below 1e-6, and
        the mesh gap is below what was asked for.

    Notes
    -----
    The answer is a local optimum, the best of the starts that could be checked: an upper bound on
    the least peak. Where a start led lower without meeting every standard, the reason says so.
    """
    search, refinement = search or MultiStart(), refinement or Refinement()
    fast: LocalSolver = solver or SequentialConvex()
    nothing = explain(problem)
    if nothing is not None:
        standing = Standing.IMPOSSIBLE if nothing.impossible else Standing.UNDECIDED
        return without_history(problem, standing, nothing.reason, nothing.next_step)
    if arrives_by_itself(problem):
        return at_rest_already(problem)
    active = resolved(until_last_window(problem))
    if not active.open_pieces:
        shortest = float(min(piece.length for piece in problem.open_pieces))
        return without_history(
            problem,
            Standing.UNDECIDED,
            f"double precision does not resolve a window of {shortest:.1g} s "
            f"within tf = {float(active.horizon):g} s",
            "let the run start and end nearer to the windows",
        )
    scaled = scale(active)
    mesh = coarse_mesh(active, refinement.cells)
    candidates, record = _search(scaled, mesh, fast, search, near)
    if not candidates and solver is None:
        candidates, record = _search(scaled, mesh, NonlinearProgram(), search, near)
    if not candidates:
        lack = missing_direction(problem)
        reason, step = ("no start led to a feasible transfer", "raise the number of starts")
        if lack is not None:
            reason, step = lack.reason, lack.next_step
        return replace(without_history(problem, Standing.UNDECIDED, reason, step), search=record)
    finish = Finish(problem, fast, solver is None, refinement, record)
    first = finish(candidates[0])
    if first.standing is Standing.CHECKED:
        return first
    rest = _distinct(candidates)[1:]
    others = (finish(candidate) for candidate in rest if not finish.fallback.exhausted)
    second = next((other for other in others if other.standing is Standing.CHECKED), first)
    return second if second is first else _beside(first, second)


def _distinct(candidates: list[LocalAnswer]) -> list[LocalAnswer]:
    """Return the candidates without those that repeat an earlier one: refined, they would end alike."""
    found: list[LocalAnswer] = []
    for one in candidates:
        if not any(_same(one, other) for other in found):
            found.append(one)
    return found


def _same(one: LocalAnswer, other: LocalAnswer) -> bool:
    """Whether two answers on one mesh hold the same torque, as far as the search solves for it."""
    if one.shooting.sign != other.shooting.sign:
        return False
    apart = float(np.abs(one.trajectory.control - other.trajectory.control).max())
    return apart <= _ALIKE * one.peak


def _beside(lower: PeakAnswer, answer: PeakAnswer) -> PeakAnswer:
    """The checked answer, saying so if a lower peak was reached that could not be checked in full."""
    if lower.flown is None or not lower.flown.feasible or lower.peak >= answer.peak:
        return answer
    reached = (
        f"a feasible transfer with a lower peak, {lower.peak:.7g} {lower.problem.norm.unit}, was reached"
    )
    return replace(answer, reason=f"{reached} but not checked: {lower.reason}", next_step=lower.next_step)


def until_last_window(problem: TransferProblem) -> TransferProblem:
    """The same transfer without the time after its last window, if it must end at rest.

    Without torque |J w| is constant, so a body at rest at the end is at rest since the last window.
    """
    last = problem.open_pieces[-1].end
    return problem if problem.terminal.rate > 0 or last == problem.horizon else problem.until(last)


def _search(
    scaled: ScaledProblem, mesh: Mesh, solver: LocalSolver, search: MultiStart, near: PeakAnswer | None
) -> tuple[list[LocalAnswer], Search]:
    """Solve from every start on the coarse mesh; the feasible answers, cheapest first."""
    answers: list[LocalAnswer] = []
    starts: list[Start] = []
    for sign, seed, control in _starts(scaled, mesh, search, near):
        shooting = Shooting(scaled, mesh, sign)
        if not np.isfinite(shooting.fly(control).residual).all():
            starts.append(Start(sign=sign, seed=seed, peak=math.inf, converged=False, iterations=0))
            continue
        answer = solver.solve(shooting, control, tolerance=search.tolerance)
        usable = answer.violation <= 1e-4
        starts.append(
            Start(
                sign=sign,
                seed=seed,
                peak=answer.peak * scaled.units.control if usable else math.inf,
                converged=answer.converged,
                iterations=answer.iterations,
            )
        )
        if usable:
            answers.append(answer)
    return sorted(answers, key=lambda a: a.peak), Search(tuple(starts))


def _starts(
    scaled: ScaledProblem, mesh: Mesh, search: MultiStart, near: PeakAnswer | None
) -> Iterator[tuple[int, int | None, Array]]:
    """Target sign, seed of the bend (None for none) and control of every start."""
    if near is not None and near.history is not None:
        control = control_at(near.history, mesh, scaled.units.time) / scaled.units.control
        if control.shape[1] == scaled.control_matrix.shape[1]:
            yield near.sign, None, control
    for number in range(search.starts):
        for sign in scaled.problem.signs:
            shooting = Shooting(scaled, mesh, sign)
            control = first_guess(shooting)
            if number == 0:
                yield sign, None, control
                continue
            seed = search.seed + number - 1
            yield sign, seed, bend(shooting, control, np.random.default_rng([seed, sign + 1]), search.bend)
