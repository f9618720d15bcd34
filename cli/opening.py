"""How a command opens a scenario: read, with its warnings on stderr."""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from ..scenario import Scenario


def open_scenario(path: Path, *, says_clock: bool = False) -> Scenario:
    """Load a scenario and note its warnings; what its times count from too, where no page `says_clock`."""
    from ..scenario import load_scenario
    from .console import note

    scenario = load_scenario(path)
    for warning in scenario.warnings:
        note(f"warning: {warning}")
    if scenario.clock.words and not says_clock:
        note(scenario.clock.words)
    return scenario
