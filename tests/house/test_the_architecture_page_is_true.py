"""The architecture page's drawing and table are what the import contracts and the sources say."""

from __future__ import annotations

import ast
import re
import sys
import tomllib
from pathlib import Path

import pytest

ROOMS = ("cli", "study", "scenario", "reports", "optim", "verify", "models")


def layers(checkout: Path) -> list[list[str]]:
    """The contract's layers, highest first, rooms beside each other in one list."""
    contracts = tomllib.loads((checkout / "pyproject.toml").read_text())["tool"]["importlinter"]["contracts"]
    (contract,) = (c for c in contracts if c["type"] == "layers")
    return [[room.strip() for room in layer.split("|")] for layer in contract["layers"]]


def drawing(checkout: Path) -> str:
    """Rooms and the arrows between layers, as the page draws them."""
    lines: list[str] = []
    for layer in layers(checkout):
        if not set(layer) & set(ROOMS):
            continue
        boxes = "   ".join(f"[ {room} ]" for room in layer)
        lines += ["|".center(40).rstrip(), "v".center(40).rstrip()] if lines else []
        lines.append(boxes.center(40).rstrip())
    return "\n".join(lines)


def imports(checkout: Path, room: str) -> tuple[set[str], set[str]]:
    """Rooms of the package, and packages of others, that a room's files import anywhere."""
    rooms: set[str] = set()
    others: set[str] = set()
    for file in (checkout / room).rglob("*.py"):
        package = ("intermit", *file.relative_to(checkout).parts[:-1])
        for node in ast.walk(ast.parse(file.read_text(encoding="utf-8"))):
            names = [a.name for a in node.names] if isinstance(node, ast.Import) else []
            if isinstance(node, ast.ImportFrom):
                base = package[: len(package) - node.level + 1] if node.level else ()
                stem = ".".join((*base, *filter(None, [node.module])))
                names = [stem] if node.module else [f"{stem}.{a.name}" for a in node.names]
            for name in names:
                head, *rest = name.split(".")
                if head == "intermit":
                    rooms |= set(rest[:1]) & set(ROOMS)
                elif head not in sys.stdlib_module_names and head != "__future__":
                    others.add(head)
    return rooms - {room}, others


def table(checkout: Path) -> dict[str, tuple[str, str]]:
    """Rooms and packages that the page grants each room."""
    text = (checkout / "docs" / "architecture.md").read_text(encoding="utf-8")
    rows = re.findall(r"^\| `(\w+)/` \| [^|]+ \| ([^|]*) \| ([^|]*) \|$", text, flags=re.MULTILINE)
    return {room: (rooms, packages) for room, rooms, packages in rows}


def words(cell: str) -> set[str]:
    return {word.strip(" `") for word in cell.split(",")} - {"", "-"}


def test_the_drawing_is_the_contracts(checkout: Path) -> None:
    assert drawing(checkout) in (checkout / "docs" / "architecture.md").read_text(encoding="utf-8")


@pytest.mark.parametrize("room", ROOMS)
def test_what_a_room_touches_is_what_the_table_says(checkout: Path, room: str) -> None:
    rooms, packages = table(checkout)[room]
    assert (words(rooms), words(packages)) == imports(checkout, room)


def test_every_folder_named_on_the_page_is_there(checkout: Path) -> None:
    text = (checkout / "docs" / "architecture.md").read_text(encoding="utf-8")
    named = re.findall(r"`((?:cli|study|scenario|reports|optim|verify|models)/[\w/.]*)`", text)
    assert len(named) > 20
    assert [name for name in named if not (checkout / name).exists()] == []
