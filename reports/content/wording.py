"""Names made safe and short, and the words for what the record abbreviates."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable

MAX_LABEL = 60
"""Characters of a name kept inside a figure; the full name stands in the text."""


def short(text: str, most: int = MAX_LABEL) -> str:
    """One line, at most `most` characters."""
    line = " ".join(text.split())
    return line if len(line) <= most else line[: most - 1] + "…"


def slug(text: str, index: int) -> str:
    """Name a file or an anchor: letters, digits and dashes, with a number so that none collide."""
    safe = re.sub(r"[^a-z0-9]+", "-", text.lower().encode("ascii", "ignore").decode())[:30].strip("-")
    return f"{safe}-{index}" if safe else str(index)


def visible(text: str) -> str:
    """Replace control characters by their pictures, so that they are seen and harm nothing.

    Newline and tab stay; bidirectional controls are shown as what they are.
    """
    return text.replace("\r\n", "\n").translate(_PICTURES)


_BIDIRECTIONAL = {"\u202a": "LRE", "\u202b": "RLE", "\u202c": "PDF", "\u202d": "LRO", "\u202e": "RLO"} | {
    "\u2066": "LRI",
    "\u2067": "RLI",
    "\u2068": "FSI",
    "\u2069": "PDI",
    "\u200e": "LRM",
    "\u200f": "RLM",
}

_PICTURES = str.maketrans(
    {chr(code): chr(0x2400 + code) for code in range(0x20) if chr(code) not in "\n\t"}
    | {"\x7f": "\u2421"}
    | {c: f"‹{name}›" for c, name in _BIDIRECTIONAL.items()}
    | dict.fromkeys([*map(chr, range(0x80, 0xA0)), *"\ufffe\uffff\u2028\u2029"], "\ufffd")
)


def json_text(value: object) -> str:
    """Write a value of a record as JSON, text as it is."""
    return value if isinstance(value, str) else json.dumps(value, sort_keys=True, ensure_ascii=False)


def plural(count: int, word: str) -> str:
    """Count and word: "1 claim", "3 claims"."""
    return f"{count} {word}" if count == 1 else f"{count} {word}s"


def shared(notes: Iterable[tuple[str, str]]) -> tuple[str, ...]:
    """Notes with the name they are about; a note that several names share is said once."""
    by_note: dict[str, list[str]] = {}
    for name, note in notes:
        by_note.setdefault(note, []).append(name)
    return tuple(f"{', '.join(names)}: {note}" for note, names in by_note.items())


def shares(columns: Iterable[Iterable[int]]) -> tuple[float, ...]:
    """Part of a table's width for each column, from the lengths of its texts; together 1."""
    weights = [min(max((*lengths, 5)), 36) for lengths in columns]
    return tuple(w / sum(weights) for w in weights)
