"""Small scenarios and the command line run in this process."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path

import pytest
from intermit.cli.app import run
from intermit.scenario.template import example_files

EXAMPLES = {path.name: path for path in example_files()}


ONE_LAW = '[[law]]\ntype = "persistence-filter"\n'
"""The law whose proofs are quickest."""


@pytest.fixture(scope="session")
def examples() -> dict[str, Path]:
    """The shipped examples by name."""
    return EXAMPLES


@pytest.fixture
def write_scenario(tmp_path: Path) -> Callable[..., Path]:
    """Write a scenario that extends a shipped example; fewer samples keep it quick."""

    def write(
        text: str = ONE_LAW, *, base: str = "paper.toml", check: str = "", name: str = "case.toml"
    ) -> Path:
        path = tmp_path / name
        table = f"[check]\nsamples = 1024\n{check}\n"
        path.write_text(f'extends = "{EXAMPLES[base]}"\n{text}\n{table}', encoding="utf-8")
        return path

    return write


Run = Callable[..., tuple[int, str, str]]


@pytest.fixture
def intermit(capfd: pytest.CaptureFixture[str]) -> Run:
    """Run a command line; return its exit code, stdout and stderr."""

    def call(*arguments: object) -> tuple[int, str, str]:
        capfd.readouterr()
        code = run([str(a) for a in arguments])
        captured = capfd.readouterr()
        return code, captured.out, captured.err

    return call
