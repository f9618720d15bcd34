"""Text for paper: what the shipped fonts cannot draw is written as its code point."""

from __future__ import annotations

from functools import cache
from pathlib import Path

from .wording import visible


@cache
def font_folder() -> Path:
    """Folder of the DejaVu fonts that come with matplotlib: the same on every machine."""
    import matplotlib

    return Path(matplotlib.get_data_path()) / "fonts" / "ttf"


@cache
def _drawable() -> frozenset[int]:
    from matplotlib.ft2font import FT2Font

    return frozenset(FT2Font(str(font_folder() / "DejaVuSans.ttf")).get_charmap())


def printable(text: str) -> str:
    """Visible text in which a character without a glyph stands as "‹U+6F22›"."""
    drawable = _drawable()
    return "".join(c if c in "\n\t" or ord(c) in drawable else f"‹U+{ord(c):04X}›" for c in visible(text))
