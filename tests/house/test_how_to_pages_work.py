"""The worked examples of the how-to pages run as they stand, block after block."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

PAGES = sorted((Path(__file__).resolve().parents[2] / "docs" / "how-to").glob("*.md"))


SHOWN = {"add-a-law": "tests/outside/test_a_law_brings_its_own_proof.py"}
"""Pages whose blocks are pieces of files that another test runs and compares with the page."""


@pytest.mark.slow
@pytest.mark.parametrize("page", [p for p in PAGES if p.stem not in SHOWN], ids=lambda page: page.stem)
def test_the_example_runs(page: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.chdir(tmp_path)
    blocks = re.findall(
        r"^```python\n(.*?)^```", page.read_text(encoding="utf-8"), flags=re.DOTALL | re.MULTILINE
    )
    assert sum(block.count("assert ") for block in blocks) >= 1
    scope = {"__name__": "page"}
    for block in blocks:
        exec(compile(block, page.name, "exec"), scope)  # noqa: S102


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.stem)
def test_the_files_it_names_are_there(page: Path, checkout: Path) -> None:
    rows = re.findall(r"^\| `([\w/.-]+)` \|", page.read_text(encoding="utf-8"), flags=re.MULTILINE)
    assert len(rows) >= 3
    assert page.stem not in SHOWN or SHOWN[page.stem] in rows
    assert [name for name in rows if not (checkout / name).exists()] == []
