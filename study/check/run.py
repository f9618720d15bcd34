"""The main job: a scenario in, every claim about it out."""

from __future__ import annotations

from ...models.types import Progress, silent
from ...scenario import Scenario
from ..claims.counting import count, counted_keys
from ..options import CheckOptions
from ..simulated_run import run_law, seen_in
from .case import Case, CaseOptions
from .makers import scenario_claims
from .result import CheckStudy
from .workers import crew


def run_check(
    scenario: Scenario, options: CheckOptions | None = None, progress: Progress | None = None
) -> CheckStudy:
    """Check a scenario: its schedule, then each of its laws, and simulate each law.

    Raises
    ------
    ScenarioError
        If the scenario asks for a claim that does not exist, or a law cannot be built.
    """
    options = options if options is not None else CheckOptions()
    tell = progress if progress is not None else silent
    counted_keys(scenario)
    tell("schedule", 0.0)
    schedule = count(scenario_claims(scenario), scenario)
    wanted = CaseOptions(margins=options.margins, search=options.search)
    runs = []
    with crew(len(scenario.laws), options.workers, tell) as workers:
        for choice in scenario.laws:
            tell(f"{choice.label}: simulation", 0.05)
            run = run_law(scenario, choice.build()) if options.simulate else None
            runs.append(run)
            workers.add(scenario, choice, seen_in(scenario, run), wanted)
        findings = workers.findings()
    cases = (
        Case(choice, found, count(found.claims, scenario), run)
        for choice, found, run in zip(scenario.laws, findings, runs, strict=True)
    )
    study = CheckStudy(scenario, schedule, tuple(cases))
    tell("done", 1.0)
    return study
