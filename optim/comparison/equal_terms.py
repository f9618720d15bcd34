"""One law against the best any controller could do: same start, windows, time and terminal set.

The law's own torque history is then feasible for the optimum's problem, so that
certified bound <= optimum <= law's peak must hold; the three are computed apart and never clipped.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, final

from ...models.norms import Norm
from ..problem import Terminal, TransferProblem, WindowProfile
from .measure import Goal, LawRun

if TYPE_CHECKING:
    from ..bounds.bound import LowerBound
    from ..peak import PeakAnswer

SLACK = 1e-6
"""Relative allowance for the optimum's mesh gap and the run's error; the bound gets none."""


class OrderError(RuntimeError):
    """certified bound <= optimum <= law is broken: an internal error, never a result."""


@final
@dataclass(frozen=True, eq=False)
class EqualTerms:
    """A law, the optimum and the certified bound on one problem.

    Attributes
    ----------
    problem : the transfer to the law's own goal
    law_peak, optimum, bound : N m; optimum is None where the search gave no checked answer
    answer, certificate : where optimum and bound come from
    """

    norm: Norm
    problem: TransferProblem
    law_peak: float
    optimum: float | None
    bound: float
    answer: PeakAnswer
    certificate: LowerBound

    @property
    def ratio_to_optimum(self) -> float | None:
        """Law's peak over the optimum found; None where no torque is needed at all."""
        return self.law_peak / self.optimum if self.optimum else None

    @property
    def ratio_to_bound(self) -> float:
        """Law's peak over the certified bound: no controller can make the ratio larger than this."""
        return self.law_peak / self.bound if self.bound > 0 else float("inf")

    @property
    def gap(self) -> float | None:
        """(optimum - bound)/optimum: how much of the optimum is not certified."""
        return (self.optimum - self.bound) / self.optimum if self.optimum else None


def problem_of(run: LawRun, norm: Norm, goal: Goal, profile: WindowProfile) -> TransferProblem:
    """The transfer a law made, as a problem for any controller; long idle ends left out, exactly."""
    terminal = Terminal(attitude=goal.attitude, rate=goal.rate)
    stated = TransferProblem.of(run.mission, norm, horizon=goal.time, terminal=terminal, profile=profile)
    return stated.without_idle()[0]


def on_equal_terms(
    run: LawRun, norm: Norm, *, goal: Goal | None = None, profile: WindowProfile = WindowProfile.FULL
) -> EqualTerms:
    """Find the optimum and the certified bound for a law's own transfer, and check their order.

    Parameters
    ----------
    run : LawRun
        The law's run, with its mission.
    norm : Norm
        Norm of the torque whose peak is compared.
    goal : Goal, optional
        The end asked for; None for the law's settling.
    profile : WindowProfile
        GAIN compares the command u through w = g, FULL the applied torque g u.

    Raises
    ------
    ValueError
        If the law did not settle within its run and no goal is given.
    OrderError
        If certified bound <= optimum <= law is broken.
    """
    from ..bounds.bound import certified_lower_bound
    from ..peak import minimum_peak
    from ..peak.search.result import Standing

    goal = goal if goal is not None else run.goal
    if goal is None:
        end = float(run.mission.horizon)
        raise ValueError(f"{run.label} does not settle by {end:g} s: nothing to compare")
    problem = problem_of(run, norm, goal, profile)
    peak = run.peak(norm, commanded=profile is WindowProfile.GAIN)
    answer = minimum_peak(problem)
    certificate = certified_lower_bound(problem)
    optimum = answer.peak if answer.standing is Standing.CHECKED else None
    terms = EqualTerms(norm, problem, peak, optimum, certificate.value, answer, certificate)
    check_order(terms.bound, terms.optimum, terms.law_peak, what=f"{run.label}, {norm.key}")
    return terms


def check_order(bound: float, optimum: float | None, law: float | None, *, what: str) -> None:
    """Stop if certified bound <= optimum <= law is broken.

    Raises
    ------
    OrderError
        Naming the two numbers. An optimum above the law is a local trap that the law's own
        history refutes; an optimum or a law below the bound refutes the bound.
    """
    allowed = 1 + SLACK
    if optimum is not None and bound > optimum * allowed:
        raise OrderError(f"{what}: certified bound {bound:.9g} N m exceeds the optimum {optimum:.9g} N m")
    if law is not None and bound > law * allowed:
        raise OrderError(f"{what}: certified bound {bound:.9g} N m exceeds the law's peak {law:.9g} N m")
    if optimum is not None and law is not None and optimum > law * allowed:
        raise OrderError(f"{what}: optimum {optimum:.9g} N m exceeds the law's peak {law:.9g} N m")
