"""Certified conditions that a tuned law, or a schedule, must meet."""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import final

from ...models.laws import Law
from ...models.rigid_body import ExactMatrix
from ...verify.filter.answer import answer
from ...verify.filter.certify import certify_floor
from ...verify.filter.comparison import BodyBounds
from ...verify.filter.question import FloorQuestion, initial_gain_term
from ...verify.filter.sets import InitialSet
from ...verify.verdict import Verdict
from ..comparison.measure import Task


@final
@dataclass(frozen=True)
class CertifiedConvergence:
    """R_min > 0 and convergence, proved for every start of a set.

    Attributes
    ----------
    task : its body may be off by the tolerance
    max_angle_deg : bound on 2 acos(b0), deg
    max_rate, max_weighted_rate : bounds on |w(0)| (rad/s) and |Omega(0)|_J; both None is at rest
    inertia_tolerance : largest deviation of each entry of J, kg m^2, or None
    """

    task: Task
    max_angle_deg: Fraction
    max_rate: Fraction | None = None
    max_weighted_rate: Fraction | None = None
    inertia_tolerance: ExactMatrix | None = None

    def __call__(self, law: Law) -> str | None:
        """None if both are PROVED for the law, else the reason why not."""
        question = FloorQuestion(
            law=law,
            body=self.task.body,
            schedule=self.task.schedule,
            max_angle_deg=self.max_angle_deg,
            max_rate=self.max_rate,
            max_weighted_rate=self.max_weighted_rate,
            inertia_tolerance=self.inertia_tolerance,
            attitude=self.task.attitude_tolerance,
            rate=self.task.rate_tolerance,
        )
        for claim in answer(question).claims:
            if claim.key in {"filter.floor", "convergence"} and claim.verdict is not Verdict.PROVED:
                return claim.reason or f"{claim.title}: {claim.verdict.value}"
        return None


def certified_floor(law: Law, task: Task) -> float | None:
    """Certified lower bound on R from the task's own start, s, over all time (a finite table: to its end).

    None where the law has no comparison system or nothing positive can be proved that far.
    """
    bounds = BodyBounds.of(task.body)
    start = InitialSet.from_state(
        task.body,
        [Fraction(x) for x in task.quaternion],
        task.rate,
        initial_gain_term(law, task.schedule),
    )
    finite_end = None if task.schedule.period is not None else task.schedule.end
    floor = certify_floor(law, bounds, task.schedule, start, horizon=finite_end)
    if floor is None or floor.failed_at is not None or not 0 < floor.value < math.inf:
        return None
    return floor.value
