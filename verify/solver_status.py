"""What a solver says of itself, in our words. A hint for the search, never evidence."""

from __future__ import annotations

from enum import Enum


class SolverStatus(Enum):
    """How a solver ended; the value says it to a user.

    SOLVED, ACCEPTABLE: it met its own tolerances, or looser ones; its numbers are worth checking.
    The others: they are not.
    """

    SOLVED = "met its tolerances"
    ACCEPTABLE = "met looser tolerances than asked for"
    INFEASIBLE = "took the problem for infeasible"
    UNBOUNDED = "took the problem for unbounded"
    LIMIT = "reached its limit of iterations or time"
    FAILED = "made no further progress"

    @property
    def is_usable(self) -> bool:
        """Whether its numbers are worth checking."""
        return self in (SolverStatus.SOLVED, SolverStatus.ACCEPTABLE)


CLARABEL = {
    "Solved": SolverStatus.SOLVED,
    "AlmostSolved": SolverStatus.ACCEPTABLE,
    "PrimalInfeasible": SolverStatus.INFEASIBLE,
    "AlmostPrimalInfeasible": SolverStatus.INFEASIBLE,
    "DualInfeasible": SolverStatus.UNBOUNDED,
    "AlmostDualInfeasible": SolverStatus.UNBOUNDED,
    "MaxIterations": SolverStatus.LIMIT,
    "MaxTime": SolverStatus.LIMIT,
}
"""Clarabel's words; the rest (numerical errors, too little progress) are failures."""

IPOPT = {
    "Solve_Succeeded": SolverStatus.SOLVED,
    "Solved_To_Acceptable_Level": SolverStatus.ACCEPTABLE,
    "Infeasible_Problem_Detected": SolverStatus.INFEASIBLE,
    "Diverging_Iterates": SolverStatus.UNBOUNDED,
    "Maximum_Iterations_Exceeded": SolverStatus.LIMIT,
    "Maximum_CpuTime_Exceeded": SolverStatus.LIMIT,
    "Maximum_WallTime_Exceeded": SolverStatus.LIMIT,
}
"""IPOPT's words, as CasADi gives them; the rest are failures."""


def clarabel_status(answer: object) -> SolverStatus:
    """Our word for how Clarabel ended; `answer` is its solution object."""
    return CLARABEL.get(str(getattr(answer, "status", "")), SolverStatus.FAILED)


def ipopt_status(word: str) -> SolverStatus:
    """Our word for IPOPT's `return_status`."""
    return IPOPT.get(word, SolverStatus.FAILED)
