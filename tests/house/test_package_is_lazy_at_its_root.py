"""`import intermit` costs nothing, and what it exports is there when asked for."""

from __future__ import annotations

import subprocess
import sys

import intermit
import pytest

HEAVY = ("numpy", "scipy", "casadi", "cvxpy", "clarabel", "matplotlib", "flint", "pydantic", "rich", "typer")


def test_import_loads_nothing_heavy() -> None:
    program = f"import sys, intermit; sys.exit(str([m for m in {HEAVY!r} if m in sys.modules] or '') or 0)"
    done = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stderr


@pytest.mark.parametrize("name", [n for n in intermit.__all__ if n != "__version__"])
def test_every_export_is_there_and_is_no_module(name: str) -> None:
    value = getattr(intermit, name)
    assert type(value).__name__ != "module"


def test_unknown_name_is_an_attribute_error() -> None:
    with pytest.raises(AttributeError, match="nonsense"):
        _ = intermit.nonsense
