"""The question about R_min, convergence and torque that a scenario asks of one of its laws."""

from __future__ import annotations

from dataclasses import replace

from ...models.laws import Law
from ...models.schedule import Schedule
from ...scenario import Scenario
from ...verify.filter.certify import FloorOptions, certify_floor
from ...verify.filter.claims import reaches_far_enough
from ...verify.filter.question import FloorQuestion
from ...verify.filter.worst_found import Search
from ...verify.robust.answer import RobustQuestion
from ..simulated_run import RunFigures

COARSE = FloorOptions(max_bins=1, max_periods=8)
"""A certificate that is cheap enough to be tried many times; one that it misses may still exist."""


def floor_question(scenario: Scenario, law: Law, seen: RunFigures, *, search: bool) -> FloorQuestion:
    """Put a scenario's question about one law; what the run showed stands beside the answer."""
    return FloorQuestion(
        law=law,
        mission=scenario.mission,
        run_floor=None if seen.floor is None else (seen.floor, float(scenario.horizon)),
        run_peak=seen.peak,
        search=Search(samples=64, rounds=2, local=24, seed=scenario.check.seed) if search else None,
    )


def robust_question(scenario: Scenario, law: Law) -> RobustQuestion:
    """Put the same question about every body of the scenario's uncertainty."""
    return RobustQuestion(law=law, mission=scenario.mission)


def is_certified(question: FloorQuestion, law: Law, schedule: Schedule) -> bool:
    """Whether convergence is certified, coarsely, with another law or schedule in the same question."""
    other = replace(question, law=law, mission=replace(question.mission, schedule=schedule))
    floor = certify_floor(law, other.bounds, schedule, other.initial, options=COARSE)
    return floor is not None and reaches_far_enough(floor) and floor.value > 0
