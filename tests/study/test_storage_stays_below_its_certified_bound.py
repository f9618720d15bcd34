"""Along a run V and V' lie below what is proved of them, and a bound that claims more is broken."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest
from intermit.reports.record import read_record

ADAPTIVE = '[[law]]\ntype = "adaptive-scaling"\ngamma = 0.1\n'
FILTER = '[[law]]\ntype = "persistence-filter"\n'


@pytest.mark.slow
@pytest.mark.parametrize("law", [ADAPTIVE, FILTER])
def test_histories_respect_their_bounds(
    law: str,
    intermit: Callable[..., tuple[int, str, str]],
    write_scenario: Callable[..., Path],
    tmp_path: Path,
) -> None:
    out = tmp_path / "found.json"
    options = ("--no-margins", "--no-search", "--workers", "1")
    intermit("check", *options, write_scenario(law), "--json", out)
    record = read_record(out)
    V, bound, rate, rate_bound = (
        record.array(f"law1.run.{name}")
        for name in ("storage", "storage_bound", "storage_rate", "storage_rate_bound")
    )
    # V is a sum of terms no larger than V(0); the run is good to 1e-8 of that
    slack = 1e-8 * V[0]
    assert np.all(bound + slack >= V)
    assert np.all(rate <= rate_bound + slack)
    assert np.any(rate > 3 * rate_bound + slack)
    time = record.array("law1.run.time")
    assert np.abs(np.diff(V) - np.diff(time) * (rate[1:] + rate[:-1]) / 2).max() < 1e-3 * V[0]
