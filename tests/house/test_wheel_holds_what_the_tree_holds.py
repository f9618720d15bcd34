"""The wheel is the package's sources and data and nothing else; it works away from the checkout."""

from __future__ import annotations

import os
import re
import shutil
import subprocess
import sys
import tomllib
import zipfile
from pathlib import Path

import pytest

NOT_PACKAGE = {"tests", "docs", "benchmarks", "examples", "build", "dist"}
"""Folders of the checkout whose Python files are not modules of the package."""


def source_files(checkout: Path) -> list[str]:
    """Files of the checkout, as git tracks them; without git, as they lie there."""
    if shutil.which("git") and (checkout / ".git").exists():
        command = ["git", "ls-files", "--cached", "--others", "--exclude-standard"]
        listed = subprocess.run(command, cwd=checkout, capture_output=True, text=True, check=True).stdout
        return [name for name in listed.splitlines() if (checkout / name).is_file()]
    found = (p.relative_to(checkout) for p in checkout.rglob("*") if p.is_file())
    hidden = (p for p in found if not any(part.startswith(".") or part == "__pycache__" for part in p.parts))
    return [str(p) for p in hidden]


@pytest.fixture(scope="module")
def wheel(checkout: Path, tmp_path_factory: pytest.TempPathFactory) -> Path:
    """A wheel built from a copy of the tree in a folder whose name is no Python name."""
    copy = tmp_path_factory.mktemp("build") / "we ird-1.clone"
    for name in source_files(checkout):
        target = copy / name
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(checkout / name, target)
    out = copy.parent / "wheels"
    command = [
        sys.executable,
        "-m",
        "pip",
        "wheel",
        "--quiet",
        "--no-deps",
        "--wheel-dir",
        str(out),
        str(copy),
    ]
    done = subprocess.run(command, capture_output=True, text=True, check=False)
    if done.returncode and "Could not find" in done.stderr + done.stdout:
        pytest.skip("no package index within reach to build a wheel")
    assert done.returncode == 0, done.stderr
    return next(out.glob("*.whl"))


@pytest.mark.slow
def test_the_wheel_holds_every_file_and_nothing_else(checkout: Path, wheel: Path) -> None:
    names = zipfile.ZipFile(wheel).namelist()
    inside = {n.removeprefix("intermit/") for n in names if n.startswith("intermit/")}
    tracked = source_files(checkout)
    modules = {n for n in tracked if n.endswith(".py") and n.split("/")[0] not in NOT_PACKAGE}
    data = {n for n in tracked if n.startswith("examples/") and n.endswith((".toml", ".csv", ".py"))}
    data |= {n for n in tracked if n.startswith(("reports/templates/", "reports/vendor/"))}
    data |= {"py.typed", "verify/checker/README.md"}
    assert inside == modules | data
    outside = {n for n in names if not n.startswith("intermit/") and ".dist-info/" not in n}
    assert outside == set()


@pytest.mark.slow
def test_the_readmes_commands_run_from_the_wheel(checkout: Path, wheel: Path, tmp_path: Path) -> None:
    target, empty = tmp_path / "site", tmp_path / "empty"
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(target)
    empty.mkdir()
    readme = (checkout / "README.md").read_text(encoding="utf-8")
    (console,) = re.findall(r"^```console\n(.*?)^```", readme, flags=re.DOTALL | re.MULTILINE)
    commands = [line.split()[1:] for line in console.splitlines() if line.startswith("venv/bin/intermit")]
    assert [command[0] for command in commands] == ["init", "check"]
    for command in commands:
        done = subprocess.run(
            [sys.executable, "-m", "intermit", *command],
            cwd=empty,
            env={**os.environ, "PYTHONPATH": str(target)},
            capture_output=True,
            text=True,
            check=False,
        )
        assert done.returncode == 0, done.stdout + done.stderr
    assert (empty / "my-study" / "paper.toml").is_file()


def test_every_subpackage_is_named_once(checkout: Path) -> None:
    settings = tomllib.loads((checkout / "pyproject.toml").read_text())["tool"]["setuptools"]["packages"]
    roots = {Path(n).parent for n in source_files(checkout) if n.endswith("/__init__.py")}
    here = {".".join(("intermit", *p.parts)) for p in roots if p.parts[0] not in NOT_PACKAGE} | {"intermit"}
    assert sorted(settings) == sorted(set(settings))
    assert set(settings) == here
