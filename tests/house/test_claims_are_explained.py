"""Every claim key has its words, and the page it points to is there."""

from __future__ import annotations

from pathlib import Path

import pytest
from intermit.study.claims.keys import CLAIM_KEYS, order_of


@pytest.mark.parametrize("key", list(CLAIM_KEYS))
def test_key_points_to_a_page_that_is_there(checkout: Path, key: str) -> None:
    entry = CLAIM_KEYS[key]
    assert (checkout / entry.page).is_file()
    assert entry.says.endswith(".")
    assert entry.rests_on.endswith(".")


def test_unknown_keys_come_last() -> None:
    assert order_of("no.such") == len(CLAIM_KEYS)
