"""How large a job is, in one line before it starts, where that is long."""

from __future__ import annotations

from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..scenario import Scenario

LONG_CHECK, LONG_OPTIMUM, LONG_SEARCH, LONG_SWEEP = 100, 100, 30_000, 4
"""Windows times laws, windows times starts times norms, windows times candidates, schedules: long above."""


def check_size(scenario: Scenario) -> str:
    """Size of a check; empty if it is short."""
    windows, laws = scenario.schedule.windows_before(scenario.horizon), len(scenario.laws)
    if windows * laws <= LONG_CHECK:
        return ""
    return f"{laws} laws through {windows} windows, {scenario.check.samples} samples of V' each"


def optimum_size(scenario: Scenario, norms: int, starts: int | None) -> str:
    """Size of an optimum in so many norms; empty if it is short."""
    from ..study.optimum.run import final_time

    windows = scenario.schedule.windows_before(final_time(scenario))
    searches = starts if starts is not None else scenario.optimum.starts
    if windows * norms * searches <= LONG_OPTIMUM:
        return ""
    return f"{norms} norms with {searches} starts through {windows} windows"


def compare_size(scenario: Scenario) -> str:
    """Size of a comparison; empty if it is short."""
    laws, norms = len(scenario.laws), len(scenario.compare.norms)
    return (
        "" if laws * norms <= LONG_SWEEP else f"{laws * norms} optima with bounds: {laws} laws, {norms} norms"
    )


def tune_size(scenario: Scenario, searches: int = 1) -> str:
    """Size of so many searches of parameters; empty if they are short."""
    windows = scenario.schedule.windows_before(scenario.horizon)
    candidates = searches * (scenario.tune.evaluations + scenario.tune.evaluations // 2)
    if windows * candidates <= LONG_SEARCH:
        return ""
    return f"{candidates} candidates through {windows} windows each"


def sweep_size(scenario: Scenario) -> str:
    """Size of a study of schedules; empty if it is short."""
    from ..study.sweep.run import DEFAULT_DUTY

    schedules = max(len(scenario.study.periods), 1) * len(scenario.study.duty_cycles or DEFAULT_DUTY)
    return "" if schedules <= LONG_SWEEP else f"{schedules} schedules, each with an optimum and its bound"


def state_size(words: str) -> None:
    """Note a size on stderr."""
    from .console import note

    if words:
        note(f"size: {words}")
