"""Programs of the operating system that some tests need: skipped by name where missing, required in CI.

`INTERMIT_FORBID_SKIPS=1` turns every such skip into a failure.
"""

import importlib.util
import os
import shutil

import pytest


def need(program: str) -> str:
    """Path of a program; skips the test (or fails it, in CI) if it is missing."""
    found = shutil.which(program)
    if found is None:
        _missing(program)
    return str(found)


def need_module(name: str) -> None:
    """Skip the test (or fail it, in CI) if a Python package is missing."""
    if importlib.util.find_spec(name) is None:
        _missing(f"the Python package {name}")


def _missing(what: str) -> None:
    if os.environ.get("INTERMIT_FORBID_SKIPS") == "1":
        pytest.fail(f"{what} is missing and INTERMIT_FORBID_SKIPS=1 forbids skipping", pytrace=False)
    pytest.skip(f"needs {what}: run .ci/debian-packages")
