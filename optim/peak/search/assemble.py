"""From a solver's answer to the user's: units restored, everything checked again, verdict drawn."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import final

import numpy as np

from ...problem import TransferProblem
from ..check.switching import SwitchingFunction, switch_times
from ..check.verify_answer import replay
from ..solvers.scp import LocalAnswer
from ..transcription.history import TorqueHistory
from ..transcription.mesh import build_mesh
from .options import Refinement
from .resolution import resolved, unresolved
from .result import PeakAnswer, Search, Standing, Switching

GAP_STANDARD = 1e-6
"""Largest relative optimality gap of an answer called CHECKED."""


@final
@dataclass(frozen=True)
class Effort:
    """Solver that gave the answer, its iterations and the rounds of refinement, all told."""

    solver: str
    iterations: int
    rounds: int


def checked(
    problem: TransferProblem,
    local: LocalAnswer,
    sigma: SwitchingFunction,
    refinement: Refinement,
    record: Search,
    effort: Effort,
) -> PeakAnswer:
    """Turn a local answer into the user's units and check it from scratch against the problem as stated."""
    units = local.shooting.scaled.units
    history = _history(problem, local)
    flown = replay(problem, history)
    ours = local.trajectory.states * np.r_[np.ones(4), np.full(3, 1 / units.time)]
    difference = ours - flown.states[: len(ours)]
    defect = float(np.abs(difference * np.r_[np.ones(4), np.full(3, units.time)]).max())
    rounding = unresolved(problem, sigma)
    mesh_gap = sigma.total_loss + rounding
    faults = flown.faults
    # each standard is met or not: what is not a number meets none
    if not local.gap <= GAP_STANDARD:
        faults.append(f"the optimality gap is {local.gap:.1e} (standard {GAP_STANDARD:.0e})")
    if not sigma.total_loss <= refinement.mesh_gap:
        faults.append(
            f"finer cells would still gain {sigma.total_loss:.1e} (asked for {refinement.mesh_gap:.0e})"
        )
    elif not mesh_gap <= refinement.mesh_gap:
        faults.append(
            f"double precision resolves the windows so little within tf = {float(problem.horizon):g} s "
            f"that {rounding:.1e} of the peak is open (asked for {refinement.mesh_gap:.0e}): "
            "let tf end nearer to the windows, or leave out windows of no use"
        )
    return PeakAnswer(
        problem=problem,
        standing=Standing.UNDECIDED if faults else Standing.CHECKED,
        peak=history.peak,
        sign=local.shooting.sign,
        history=history,
        flown=flown,
        switching=_plot_ready(sigma),
        optimality_gap=local.gap,
        mesh_gap=mesh_gap,
        defect=defect,
        solver=effort.solver,
        iterations=effort.iterations,
        rounds=effort.rounds,
        search=record,
        reason="; ".join(faults),
        next_step="raise the number of starts or cells, or use the other solver" if faults else "",
    )


def _history(problem: TransferProblem, local: LocalAnswer) -> TorqueHistory:
    """Torque history in the user's units; zero after the last window if the solver left that time out."""
    scaled, mesh = local.shooting.scaled, local.shooting.mesh
    edges, profile = mesh.edges * scaled.units.time, mesh.profile
    control = np.zeros((mesh.size, scaled.control_matrix.shape[1]))
    control[mesh.open] = local.trajectory.control * scaled.units.control
    if scaled.problem.horizon < problem.horizon:
        edges = np.r_[edges, float(problem.horizon)]
        profile, control = (np.vstack([rows, np.zeros(rows.shape[1])]) for rows in (profile, control))
    return TorqueHistory(edges, profile, control, problem.norm)


def _plot_ready(sigma: SwitchingFunction) -> Switching:
    """Switching function in seconds on a grid of each open cell."""
    time = sigma.answer.shooting.scaled.units.time
    grid = np.linspace(0.0, 1.0, 5)
    times = (sigma.start[:, None] + sigma.length[:, None] * grid) * time
    answer = sigma.answer
    costate = -np.einsum("i,kij->kj", answer.multiplier, answer.sensitivity.adjoint)
    return Switching(
        times=times,
        sigma=sigma.at(grid) / time,
        switch_times=switch_times(sigma),
        costate_times=answer.shooting.mesh.edges * time,
        costate=costate * np.r_[np.ones(4), np.full(3, time)],
        residual=sigma.pontryagin_residual,
    )


def at_rest_already(problem: TransferProblem) -> PeakAnswer:
    """Answer of a start at rest at the target, within the tolerances: no torque, checked all the same."""
    window = resolved(problem).window
    mesh = build_mesh(window, [1] * len(window.shapes))
    control = np.zeros((mesh.size, problem.norm.control_matrix.shape[1]))
    history = TorqueHistory(mesh.edges * float(problem.horizon), mesh.profile, control, problem.norm)
    flown = replay(problem, history)
    empty = without_history(problem, Standing.CHECKED, "", "")
    good = not flown.faults
    return replace(
        empty,
        standing=Standing.CHECKED if good else Standing.UNDECIDED,
        peak=0.0,
        sign=1 if problem.unit_attitude[0] >= 0 else -1,
        history=history,
        flown=flown,
        optimality_gap=0.0,
        mesh_gap=0.0,
        defect=0.0,
        reason="; ".join(flown.faults),
        next_step="" if good else "state the start's attitude more exactly",
    )


def without_history(problem: TransferProblem, standing: Standing, reason: str, next_step: str) -> PeakAnswer:
    """Answer without a history."""
    return PeakAnswer(
        problem=problem,
        standing=standing,
        peak=math.inf,
        sign=0,
        history=None,
        flown=None,
        switching=None,
        optimality_gap=math.inf,
        mesh_gap=math.inf,
        defect=math.inf,
        solver="none",
        iterations=0,
        rounds=0,
        search=Search(()),
        reason=reason,
        next_step=next_step,
    )
