"""Every claim key has its words, and the page it points to is there."""

from __future__ import annotations

from pathlib import Path

import pytest
from intermit.scenario import load_scenario
from intermit.study.check.makers import ABOUT_LAW, ABOUT_SCHEDULE, decided_claims, scenario_claims
from intermit.verify.claim_table import CLAIM_KEYS, order_of, stated
from intermit.verify.verdict import Verdict


@pytest.mark.parametrize("key", list(CLAIM_KEYS))
def test_key_points_to_a_page_that_is_there(checkout: Path, key: str) -> None:
    entry = CLAIM_KEYS[key]
    assert (checkout / entry.page).is_file()
    assert entry.says.endswith(".")
    assert entry.rests_on.endswith(".")


def test_unknown_keys_come_last() -> None:
    assert order_of("no.such") == len(CLAIM_KEYS)


def test_every_claim_has_one_maker_and_every_maker_a_claim() -> None:
    keys = [key for maker in (*ABOUT_SCHEDULE, *ABOUT_LAW) for key in maker.keys]
    assert sorted(keys) == sorted(CLAIM_KEYS)
    assert {key for maker in ABOUT_LAW for key in maker.keys} == {
        k for k, e in CLAIM_KEYS.items() if e.by_law
    }


def test_what_is_claimed_stands_in_the_table(checkout: Path) -> None:
    scenario = load_scenario(checkout / "examples" / "user-law.toml")
    claims = [*scenario_claims(scenario)]
    for choice in scenario.laws:
        claims += decided_claims(scenario, choice.build())
    assert len(claims) > 10
    for claim in claims:
        entry = CLAIM_KEYS[claim.key]
        assert claim.title.startswith(entry.title)
        assert claim.source == entry.source
        assert not claim.counted or entry.counts


def test_a_claim_that_the_table_does_not_know_cannot_be_made() -> None:
    with pytest.raises(KeyError):
        stated("no.such", "x", Verdict.UNDECIDED, reason="r", next_step="s")
