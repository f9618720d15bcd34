"""The README's library example works, and its tables name what is there; its commands run from the wheel."""

from __future__ import annotations

import re
import tomllib
from pathlib import Path

import pytest
from intermit.cli.app import COMMANDS, run
from matplotlib import pyplot


def text(checkout: Path) -> str:
    return (checkout / "README.md").read_text(encoding="utf-8")


def blocks(readme: str, language: str) -> list[str]:
    return re.findall(rf"^```{language}\n(.*?)^```", readme, flags=re.DOTALL | re.MULTILINE)


@pytest.mark.slow
def test_python_block_runs(
    checkout: Path, tmp_path: Path, monkeypatch: pytest.MonkeyPatch, capsys: pytest.CaptureFixture[str]
) -> None:
    """In the folder that the console block has made."""
    monkeypatch.chdir(tmp_path)
    assert run(["init", "--paper", "my-study"]) == 0
    capsys.readouterr()
    for block in blocks(text(checkout), "python"):
        exec(compile(block, "README.md", "exec"), {})  # noqa: S102
    said = capsys.readouterr().out
    settling = re.search(r"^settling time +([0-9.]+) s$", said, flags=re.MULTILINE)
    assert 0 < float(settling[1]) < 56  # before the horizon
    assert "claims are proved." in said
    assert (tmp_path / "run.png").stat().st_size > 10_000
    pyplot.close("all")


def test_command_table_names_real_commands(checkout: Path) -> None:
    named = set(re.findall(r"^\| `intermit ([a-z-]+)", text(checkout), flags=re.MULTILINE))
    assert named <= {name.replace("_", "-") for name in COMMANDS}


def test_dependency_table_is_complete(checkout: Path) -> None:
    project = tomllib.loads((checkout / "pyproject.toml").read_text())["project"]
    needed = {re.split(r"[<>=\[ ]", item)[0] for item in project["dependencies"]}
    table = text(checkout).split("## Dependencies")[1].split("## ")[0]
    rows = re.findall(r"^\| ([a-z0-9, -]+) \|", table, flags=re.MULTILINE)
    named = {name.strip() for row in rows for name in row.split(",")} - {"package"}
    assert named == needed


def test_every_make_verb_named_is_in_the_makefile(checkout: Path) -> None:
    makefile = (checkout / "Makefile").read_text()
    for page in ("README.md", "CONTRIBUTING.md"):
        for verb in re.findall(r"^ {4}make ([a-z]+)", (checkout / page).read_text(), flags=re.MULTILINE):
            assert re.search(rf"^{verb}:", makefile, flags=re.MULTILINE), (page, verb)
