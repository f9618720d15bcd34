"""Least peak torque of a transfer: search on a coarse mesh, refine the best, check it, or say why not."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from ..problem import TransferProblem
from .assemble import at_rest_already, checked, without_history
from .explain import arrives_by_itself, explain
from .guess import bend, first_guess, stretched
from .mesh import Mesh, build_mesh
from .options import LocalSolver, MultiStart, Refinement
from .refine import refined, smoothed
from .result import PeakAnswer, Search, Standing, Start
from .scaling import ScaledProblem, scale
from .scp import LocalAnswer, SequentialConvex
from .shooting import Shooting
from .switching import switching_function

Array = NDArray[np.float64]


def coarse_mesh(problem: TransferProblem, cells: int) -> Mesh:
    """Mesh with about `cells` open cells, none of them or of the arcs turning far."""
    inertias = problem.body.principal_inertias
    wobble = float(inertias[-1] / inertias[0])
    rate = 1.5 * wobble * float(np.linalg.norm(problem.start_rate)) + 3.0 * problem.angle / float(
        problem.horizon
    )
    each = max(2, math.ceil(cells / max(len(problem.open_pieces), 1)))
    parts = []
    for piece in problem.window.pieces:
        need = math.ceil(rate * float(piece.length) / 0.35)
        parts.append(max(each if piece.shape else 1, need))
    return build_mesh(problem.window, parts)


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
        Answer of a neighbouring problem (in a sweep, say): its history, stretched to this transfer
        time, is one more start.

    Returns
    -------
    PeakAnswer
        CHECKED only if an independent integration of the returned history meets the terminal
        condition to 1e-8, the optimality gap recomputed outside the solver is below 1e-6, and
        the mesh gap is below what was asked for.

    Notes
    -----
    The answer is a local optimum, the best of the starts: an upper bound on the least peak.
    """
    search, refinement = search or MultiStart(), refinement or Refinement()
    fast: LocalSolver = solver or SequentialConvex()
    nothing = explain(problem)
    if nothing is not None:
        standing = Standing.IMPOSSIBLE if nothing.impossible else Standing.UNDECIDED
        return without_history(problem, standing, nothing.reason, nothing.next_step)
    if arrives_by_itself(problem):
        return at_rest_already(problem)
    scaled = scale(problem)
    mesh = coarse_mesh(problem, refinement.cells)
    candidates, record = _search(scaled, mesh, fast, search, near)
    if not candidates:
        return replace(
            without_history(
                problem,
                Standing.UNDECIDED,
                "no start led to a feasible transfer",
                "raise the number of starts",
            ),
            search=record,
        )
    tried = [_finish(candidate, fast, solver is None, refinement, record) for candidate in candidates[:1]]
    best = tried[0]
    for candidate in candidates[1:]:
        if best.standing is Standing.CHECKED:
            break
        best = _finish(candidate, fast, solver is None, refinement, record)
    return best if best.standing is Standing.CHECKED else tried[0]


def _search(
    scaled: ScaledProblem, mesh: Mesh, solver: LocalSolver, search: MultiStart, near: PeakAnswer | None
) -> tuple[list[LocalAnswer], Search]:
    """Solve from every start on the coarse mesh; the feasible answers, cheapest first."""
    answers: list[LocalAnswer] = []
    starts: list[Start] = []
    for sign, seed, control in _starts(scaled, mesh, search, near):
        answer = solver.solve(Shooting(scaled, mesh, sign), control, tolerance=search.tolerance)
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
        control = stretched(near.history, mesh) / scaled.units.control
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


def _finish(
    candidate: LocalAnswer, solver: LocalSolver, may_fall_back: bool, refinement: Refinement, record: Search
) -> PeakAnswer:
    """Refine one local optimum to the mesh gap, then check it."""
    local, rounds, total, name = candidate, 0, candidate.iterations, solver.name
    sigma = switching_function(local)
    shooting, control = local.shooting, local.flight.control
    while rounds < refinement.max_rounds:
        rounds += 1
        local = solver.solve(shooting, control)
        total += local.iterations
        if not local.converged and may_fall_back:
            local, name = _fall_back(local), "nonlinear program"
        sigma = switching_function(local)
        rough = smoothed(local, refinement.step_error)
        if rough is not None:
            shooting, control = rough
        elif sigma.total_loss > refinement.mesh_gap:
            shooting, control = refined(sigma, refinement.mesh_gap)
        else:
            break
    return checked(local, sigma, refinement, record, name=name, iterations=total, rounds=rounds)


def _fall_back(local: LocalAnswer) -> LocalAnswer:
    """Nonlinear program from where the fast solver stopped; whichever answer is better converged."""
    from .nlp import NonlinearProgram

    other = NonlinearProgram().solve(local.shooting, local.flight.control)
    better = other.violation <= 1e-8 and other.gap < local.gap
    return other if better else local
