"""Which claims decide the exit code."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import replace
from difflib import get_close_matches

from ...scenario import Scenario, ScenarioError
from ...verify.claim_table import CLAIM_KEYS
from ...verify.verdict import Claim, Verdict


def counted_keys(scenario: Scenario) -> frozenset[str]:
    """Keys that count for a scenario: those it lists, else the schedule's facts, R_min > 0 and convergence.

    Raises
    ------
    ScenarioError
        If it lists a key that no claim has.
    """
    listed = scenario.check.claims
    if listed is None:
        return frozenset(key for key, entry in CLAIM_KEYS.items() if entry.counts)
    for key in listed:
        if key not in CLAIM_KEYS:
            near = get_close_matches(key, CLAIM_KEYS, n=1)
            hint = f"did you mean '{near[0]}'?" if near else f"keys: {', '.join(CLAIM_KEYS)}"
            raise ScenarioError(
                f"{scenario.path.name}: check.claims", f"no claim has the key '{key}' ({hint})"
            )
    return frozenset(listed)


def count(claims: Iterable[Claim], scenario: Scenario) -> tuple[Claim, ...]:
    """Mark each claim as counted or not.

    A claim that its maker excused (g asked for as printed, with its known erratum) stays excused
    unless the scenario lists it by name.
    """
    keys = counted_keys(scenario)
    listed = scenario.check.claims is not None
    return tuple(replace(claim, counted=claim.key in keys and (listed or claim.counted)) for claim in claims)


def exit_code(claims: Iterable[Claim]) -> int:
    """0 if all counted claims hold, 1 if one is refuted, else 3 if one is undecided."""
    verdicts = {claim.verdict for claim in claims if claim.counted}
    for verdict in (Verdict.REFUTED, Verdict.UNDECIDED):
        if verdict in verdicts:
            return verdict.exit_code
    return Verdict.PROVED.exit_code


def sentence(claims: Iterable[Claim]) -> str:
    """The outcome in one sentence."""
    counted = [claim for claim in claims if claim.counted]
    number = {v: sum(claim.verdict is v for claim in counted) for v in Verdict}
    if not counted:
        return "No claim counts."
    if number[Verdict.PROVED] == len(counted):
        return f"All {len(counted)} counted claims are proved."
    parts = [f"{n} {v.value}" for v, n in number.items() if n]
    return f"Of {len(counted)} counted claims: {', '.join(parts)}."
