"""`intermit compare`."""

from __future__ import annotations

from .options import Debug, JsonFile, ScenarioFile


def run(scenario: ScenarioFile, json: JsonFile = None, debug: Debug = False) -> int:
    """Put every law of a scenario beside the optimum for its own settling time, with a certified bound."""
    del debug
    from ..scenario import load_scenario
    from ..study.compare import comparison_record, run_comparison
    from .console import progress
    from .finish import finish

    loaded = load_scenario(scenario)
    with progress(loaded.name):
        record = comparison_record(run_comparison(loaded))
    return finish(record, json)
