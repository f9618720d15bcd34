"""From a local optimum on a coarse mesh to a checked answer: refine, solve again, check."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import final

from ...problem import TransferProblem
from ..check.switching import switching_function
from ..solvers.nlp import NonlinearProgram
from ..solvers.scp import LocalAnswer
from .assemble import Effort, checked
from .options import LocalSolver, Refinement
from .refine import refined, smoothed
from .result import PeakAnswer, Search, Standing

MAX_FALLBACK_WORK = 150_000
"""Cells times iterations that the nonlinear program may take for one least peak: about half a minute."""


@final
@dataclass
class FallbackWork:
    """What the nonlinear program has done for one least peak, whichever local optimum it was for.

    A count, not a clock: the same problem ends at the same mesh on every machine.
    """

    done: int = 0
    exhausted: bool = False

    def add(self, local: LocalAnswer, iterations: int) -> None:
        """Count one solution."""
        self.done += local.shooting.mesh.size * iterations

    def forbids(self, cells: int, iterations: int) -> bool:
        """Whether one more, on a mesh of so many cells, would be too much; remembered."""
        self.exhausted = self.exhausted or self.done + cells * iterations > MAX_FALLBACK_WORK
        return self.exhausted


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
    fallback: FallbackWork = field(default_factory=FallbackWork)

    def __call__(self, candidate: LocalAnswer) -> PeakAnswer:
        """Refine and check one local optimum."""
        local, rounds, total, solver = candidate, 0, candidate.iterations, self.solver
        sigma = switching_function(local)
        shooting, control = local.shooting, local.trajectory.control
        stopped = ""
        while rounds < self.refinement.max_rounds:
            if solver is not self.solver and self.fallback.forbids(shooting.mesh.size, local.iterations):
                stopped = (
                    f"the fast solver did not converge, and the nonlinear program would go on to a mesh of "
                    f"{shooting.mesh.size} cells, beyond its limit of work"
                )
                break
            rounds += 1
            local = solver.solve(shooting, control)
            total += local.iterations
            if not local.converged and self.may_fall_back and solver is self.solver:
                # what the fast solver finds hard on one mesh it finds hard on a finer one
                solver, local = NonlinearProgram(), _fall_back(local)
            if solver is not self.solver:
                self.fallback.add(local, local.iterations)
            sigma = switching_function(local)
            rough = smoothed(local, self.refinement.step_error)
            if rough is not None:
                shooting, control = rough
            elif sigma.total_loss > self.refinement.mesh_gap:
                shooting, control = refined(sigma, self.refinement.mesh_gap)
            else:
                break
        effort = Effort(solver.name, total, rounds)
        answer = checked(self.problem, local, sigma, self.refinement, self.record, effort)
        if not stopped or answer.standing is Standing.CHECKED:
            return answer
        step = "allow a larger mesh gap, fewer windows or a slower start, or try other seeds"
        return replace(answer, reason=f"{stopped}: {answer.reason}", next_step=step)


def _fall_back(local: LocalAnswer) -> LocalAnswer:
    """Nonlinear program from where the fast solver stopped; whichever answer is better converged."""
    other = NonlinearProgram().solve(local.shooting, local.trajectory.control)
    better = other.violation <= 1e-8 and other.gap < local.gap
    return other if better else local
