"""The main job: a scenario in, every claim about it out."""

from __future__ import annotations

from collections.abc import Iterable

from ...models.types import Interrupted, Progress, silent
from ...scenario import Scenario
from ..claims.counting import count, counted_keys
from ..options import CheckOptions
from ..simulated_run import Run, run_law, seen_in
from .case import Case, CaseOptions, Findings
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
    Interrupted
        With the study so far, where the user interrupts.
    """
    options = options if options is not None else CheckOptions()
    tell = progress if progress is not None else silent
    counted_keys(scenario)
    tell("schedule", 0.0)
    schedule = count(scenario_claims(scenario), scenario)
    wanted = CaseOptions(margins=options.margins, search=options.search)
    runs: list[Run | None] = []

    def study(found: Iterable[tuple[int, Findings]]) -> CheckStudy:
        cases = (Case(scenario.laws[i], f, count(f.claims, scenario), runs[i]) for i, f in found)
        return CheckStudy(scenario, schedule, tuple(cases))

    with crew(len(scenario.laws), options.workers, tell) as workers:
        try:
            for choice in scenario.laws:
                tell(f"{choice.label}: simulation", 0.05)
                run = run_law(scenario, choice.build()) if options.simulate else None
                runs.append(run)
                workers.add(scenario, choice, seen_in(scenario, run), wanted)
            findings = workers.findings()
        except KeyboardInterrupt:
            partial = study(workers.done())
            done = {case.choice.label for case in partial.cases}
            missing = ", ".join(c.label for c in scenario.laws if c.label not in done)
            raise Interrupted(partial, f"not finished: {missing}") from None
    complete = study(enumerate(findings))
    tell("done", 1.0)
    return complete
