"""Certified conditions that a tuned law, or a schedule, must meet."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import final

from ...models.laws import Law
from ...models.mission import InitialSet, Mission
from ...verify.filter.answer import answer
from ...verify.filter.certify import certify_floor
from ...verify.filter.question import FloorQuestion, initial_gain_term
from ...verify.filter.sets import InitialSet as ComparedSet
from ...verify.verdict import Verdict


@final
@dataclass(frozen=True)
class CertifiedConvergence:
    """R_min > 0 and convergence, proved for every start of the set, on a body that the controller knows."""

    mission: Mission

    def __call__(self, law: Law) -> str | None:
        """None if both are PROVED for the law, else the reason why not."""
        for claim in answer(FloorQuestion(law=law, mission=self.mission)).claims:
            if claim.key in {"filter.floor", "convergence"} and claim.verdict is not Verdict.PROVED:
                return claim.reason or f"{claim.title}: {claim.verdict.value}"
        return None


def certified_floor(law: Law, mission: Mission) -> float | None:
    """Certified lower bound on R from the mission's own start, s, over all time (a finite table: to its end).

    None where the law has no comparison system or nothing positive can be proved that far.
    """
    schedule = mission.schedule
    question = FloorQuestion(law=law, mission=replace(mission, starts=InitialSet.around(mission.start)))
    if mission.inertia_tolerance is None:  # one body: the state is a smaller set than what is around it
        gain_term = initial_gain_term(law, schedule)
        start = ComparedSet.from_state(
            mission.body, mission.start.exact_quaternion, mission.start.exact_rate, gain_term
        )
    else:
        start = question.initial
    finite_end = None if schedule.period is not None else schedule.end
    floor = certify_floor(law, question.bounds, schedule, start, horizon=finite_end)
    if floor is None or floor.failed_at is not None or not 0 < floor.value < math.inf:
        return None
    if floor.system.part is not None:  # counts only with its certificate checked: see `answer`
        return None
    return floor.value
