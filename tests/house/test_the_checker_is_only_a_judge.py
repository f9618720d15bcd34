"""What writes certificates computes by itself: the stand-alone checker gives verdicts, no mathematics."""

import ast
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
JUDGE = {
    "check_text",  # is this certificate valid
    "compared_law",  # which comparison theorem are these equations of
    "same_law",  # do two certificates speak of one law
    *(
        "Finding",
        "Invalid",
        "Node",
        "report",
        "exact",
        "read_scaled",
        "gain_numbers",
        "known_laws",
        "Part",
        "read_part",
    ),  # its words, and parts of it from outside
}
"""What the package may call of its checker."""


def names_used(source):
    """Names that a file takes from a package called checker, by import or as attributes of it."""
    tree = ast.parse(source)
    found = set()
    for node in ast.walk(tree):
        if isinstance(node, ast.ImportFrom) and (node.module or "").split(".")[-1] == "checker":
            found |= {alias.name for alias in node.names}
        elif (
            isinstance(node, ast.Attribute)
            and isinstance(node.value, ast.Name)
            and node.value.id == "checker"
        ):
            found.add(node.attr)
    return found - {"__file__"}


def test_no_search_borrows_the_checkers_mathematics():
    rooms = [ROOT / room for room in ("verify", "optim", "study", "scenario", "cli")]
    files = [p for room in rooms for p in room.rglob("*.py") if (ROOT / "verify/checker") not in p.parents]
    assert len(files) > 100
    assert any(names_used(path.read_text(encoding="utf-8")) for path in files)
    borrowed = {
        str(path.relative_to(ROOT)): names - JUDGE
        for path in files
        if (names := names_used(path.read_text(encoding="utf-8"))) - JUDGE
    }
    assert borrowed == {}


@pytest.mark.parametrize(
    "line", ["from ..checker import Ring", "from .. import checker\nx = checker.inverse_matrix(J)"]
)
def test_borrowing_is_seen(line):
    assert names_used(line) - JUDGE
