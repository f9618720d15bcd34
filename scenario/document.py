"""From TOML text to one raw document, with `extends` resolved and the origin of every key kept."""

from __future__ import annotations

import tomllib
from dataclasses import dataclass
from decimal import Decimal
from pathlib import Path
from typing import Any, final

from .errors import ScenarioError, quote
from .files import read_text

DEEPEST_CHAIN = 8
"""How many files `extends` may chain."""
MERGED_TABLES = frozenset({"law_defaults"})
"""Tables merged key by key; any other table replaces the extended file's whole."""


@final
@dataclass(frozen=True)
class Document:
    """The raw tables of a scenario, the file that each came from, and the text of the scenario's own file."""

    tables: dict[str, Any]
    origins: dict[str, Path]
    path: Path
    text: str = ""

    def origin(self, key: str) -> Path:
        """Return the file in which a top-level key was written (the scenario itself if nowhere)."""
        return self.origins.get(key, self.path)

    def where(self, key: str) -> str:
        """How a message names a key: 'file: key'; the table's file if the key was inherited."""
        return f"{self.origin(top(key)).name}: {key}"


def top(key: str) -> str:
    """Return the top-level name of a dotted key."""
    return key.split(".", 1)[0].split("[", 1)[0]


def read_document(path: Path, text: str | None = None) -> Document:
    """Read a scenario file and the files it extends; with `text`, what a file at `path` would say.

    Raises
    ------
    ScenarioError
        If a file cannot be read or is not TOML, or `extends` does not name a file or goes in a circle.
    """
    chain: list[Path] = []
    raws: list[dict[str, Any]] = []
    current, named, first = path, str(path), ""
    while True:
        if current.resolve() in (p.resolve() for p in chain):
            raise ScenarioError(named, "extends a file that extends it in turn")
        if len(chain) == DEEPEST_CHAIN:
            raise ScenarioError(named, f"more than {DEEPEST_CHAIN} files extend each other")
        said = text if text is not None and not chain else read_text(current, named)
        raw = _parse(said, named)
        first = said if not chain else first
        chain.append(current)
        raws.append(raw)
        base = raw.pop("extends", None)
        if base is None:
            break
        if not isinstance(base, str):
            raise ScenarioError(
                f"{current.name}: extends", f"expected a file name in quotes, received {quote(base)}"
            )
        named = f"{current.name}: extends: {base}"
        current = current.parent / base
    tables: dict[str, Any] = {}
    origins: dict[str, Path] = {}
    for file, raw in zip(reversed(chain), reversed(raws), strict=True):
        for key, value in raw.items():
            if key in MERGED_TABLES and isinstance(value, dict) and isinstance(tables.get(key), dict):
                value = {**tables[key], **value}
            tables[key] = value
            origins[key] = file
    return Document(tables, origins, path, first)


def _parse(text: str, where: str) -> dict[str, Any]:
    try:
        return tomllib.loads(text, parse_float=Decimal)
    except tomllib.TOMLDecodeError as error:
        raise ScenarioError(where, f"is not valid TOML: {error}") from None
    except RecursionError:
        raise ScenarioError(where, "is not valid TOML: nested too deeply") from None
    except ValueError as error:
        raise ScenarioError(where, f"holds a number that cannot be read: {error}") from None
