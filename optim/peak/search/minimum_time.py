"""Least transfer time within a torque limit: the least peak is a falling function of the time allowed.

More time never costs: a transfer that arrives early may stay. So the least time is where the
least peak meets the limit, and bisection on the final time finds it with the solver of the
least peak. Inside a gap between windows the least peak is constant, so the answer ends inside a
window.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...problem import TransferProblem
from .explain import absorption_peak, arrives_by_itself, open_time, travel_peak
from .minimum_peak import minimum_peak
from .options import MultiStart, Refinement
from .result import PeakAnswer, Standing


@final
@dataclass(frozen=True)
class LeastTime:
    """Least transfer time found within a limit.

    Attributes
    ----------
    answer : PeakAnswer
        Checked transfer that ends at `time`, its peak at most the limit: an upper bound on the
        least time. Not CHECKED if no transfer within the limit was found by the latest time.
    time : Fraction or None
        Transfer time, s; None if none was found.
    earlier : Fraction
        Latest time tried at which no transfer within the limit was found, s.
    solves : int
        Least-peak problems solved.
    """

    limit: float
    answer: PeakAnswer
    time: Fraction | None
    earlier: Fraction
    solves: int


def minimum_time(
    problem: TransferProblem,
    limit: float,
    *,
    resolution: Fraction = Fraction(1, 10**6),
    search: MultiStart | None = None,
    refinement: Refinement | None = None,
) -> LeastTime:
    """Find the least time, at most the problem's own horizon, for which the limit suffices.

    Parameters
    ----------
    problem : TransferProblem
        Its horizon is the latest time allowed.
    limit : float
        Largest effort, in the norm's unit.
    resolution : Fraction
        Relative to the horizon.
    search, refinement
        As for `minimum_peak`; by default two starts for each sign.

    Raises
    ------
    ValueError
        If the limit is not > 0.
    """
    if limit <= 0:
        raise ValueError(f"the limit must be > 0, received {limit:g}")
    search, refinement = search or MultiStart(starts=2), refinement or Refinement()
    late = minimum_peak(problem, search=search, refinement=refinement)
    if late.standing is not Standing.CHECKED or late.peak > limit:
        return LeastTime(limit, late, None, problem.horizon, 1)
    if arrives_by_itself(problem):
        return LeastTime(limit, late, Fraction(0), Fraction(0), 1)
    low, high, best, solves = Fraction(0), problem.horizon, late, 1
    step = problem.horizon * resolution
    while high - low > step:
        middle = _inside_a_window(problem, (low + high) / 2, low)
        trial = problem.until(middle)
        if _ruled_out(trial, limit):
            low = middle
            continue
        answer = minimum_peak(trial, search=search, refinement=refinement, near=best)
        solves += 1
        if answer.standing is Standing.CHECKED and answer.peak <= limit:
            high, best = middle, answer
        else:
            low = middle
    return LeastTime(limit, best, high, low, solves)


def _inside_a_window(problem: TransferProblem, time: Fraction, low: Fraction) -> Fraction:
    """The time itself, or the end of the window before it if it lies in a gap (but above `low`)."""
    ends = [piece.end for piece in problem.open_pieces if low < piece.end <= time]
    inside = any(piece.start < time < piece.end for piece in problem.open_pieces)
    return time if inside or not ends else ends[-1]


def _ruled_out(problem: TransferProblem, limit: float) -> bool:
    """Whether momentum or path alone already rule the limit out, with nothing to solve."""
    if open_time(problem) == 0:
        return True
    return max(absorption_peak(problem), travel_peak(problem)) > limit
