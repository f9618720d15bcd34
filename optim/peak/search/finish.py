"""From a local optimum on a coarse mesh to a checked answer: refine, solve again, check."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final

from ...problem import TransferProblem
from ..check.switching import switching_function
from ..solvers.nlp import NonlinearProgram
from ..solvers.scp import LocalAnswer
from .assemble import Effort, checked
from .options import LocalSolver, Refinement
from .refine import refined, smoothed
from .result import PeakAnswer, Search


@final
@dataclass(frozen=True)
class Finish:
    """Refines one local optimum to the mesh gap, then checks it against the problem as stated.

    Attributes
    ----------
    solver : LocalSolver
    may_fall_back : bool
        Whether the nonlinear program may take over where the solver does not converge.
    """

    problem: TransferProblem
    solver: LocalSolver
    may_fall_back: bool
    refinement: Refinement
    record: Search

    def __call__(self, candidate: LocalAnswer) -> PeakAnswer:
        """Refine and check one local optimum."""
        local, rounds, total, solver = candidate, 0, candidate.iterations, self.solver
        sigma = switching_function(local)
        shooting, control = local.shooting, local.trajectory.control
        while rounds < self.refinement.max_rounds:
            rounds += 1
            local = solver.solve(shooting, control)
            total += local.iterations
            if not local.converged and self.may_fall_back and solver is self.solver:
                # what the fast solver finds hard on one mesh it finds hard on a finer one
                solver, local = NonlinearProgram(), _fall_back(local)
            sigma = switching_function(local)
            rough = smoothed(local, self.refinement.step_error)
            if rough is not None:
                shooting, control = rough
            elif sigma.total_loss > self.refinement.mesh_gap:
                shooting, control = refined(sigma, self.refinement.mesh_gap)
            else:
                break
        effort = Effort(solver.name, total, rounds)
        return checked(self.problem, local, sigma, self.refinement, self.record, effort)


def _fall_back(local: LocalAnswer) -> LocalAnswer:
    """Nonlinear program from where the fast solver stopped; whichever answer is better converged."""
    other = NonlinearProgram().solve(local.shooting, local.trajectory.control)
    better = other.violation <= 1e-8 and other.gap < local.gap
    return other if better else local
