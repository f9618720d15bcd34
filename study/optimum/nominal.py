"""Which body optima and bounds speak of where the scenario knows its inertia within a tolerance only."""

from __future__ import annotations

from ...scenario import Scenario


def nominal_words(scenario: Scenario) -> str:
    """Say that they are those of the nominal body, and which key they do not cover; empty without one."""
    if scenario.inertia_tolerance is None and scenario.uncertainty.is_nominal:
        return ""
    named = "spacecraft.inertia_tolerance" if scenario.inertia_tolerance is not None else "[uncertainty]"
    return f"of the nominal body alone: {named} is not covered"
