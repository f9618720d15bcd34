"""Text for paper: what no font at hand can draw is written as its code point."""

from __future__ import annotations

import unicodedata
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from .wording import visible

EAST_ASIAN = ("cvttf_NotoSansCJK_Regular", "NotoSansCJKtc-Regular.otf", "Noto Sans CJK TC")
"""Package, file and family of the font for Chinese, Japanese and Korean, used where it is installed."""
ISOLATE, END_ISOLATE = "\u2068", "\u2069"


@cache
def font_folders() -> tuple[Path, ...]:
    """Folders of the fonts: DejaVu, which comes with matplotlib, and the East Asian one if installed."""
    import matplotlib

    further = east_asian_font()
    return (Path(matplotlib.get_data_path()) / "fonts" / "ttf", *((further.parent,) if further else ()))


@cache
def font_names() -> tuple[str, ...]:
    """Families that stand in, in this order, for what a text's own font lacks."""
    return ("DejaVu Sans", EAST_ASIAN[2]) if east_asian_font() else ("DejaVu Sans",)


@cache
def east_asian_font() -> Path | None:
    """File of the East Asian font, None if its package is not installed."""
    package, name, _ = EAST_ASIAN
    found = find_spec(package)
    places = [Path(p) / name for p in found.submodule_search_locations or ()] if found else []
    return next((p for p in places if p.is_file()), None)


@cache
def _drawable() -> frozenset[int]:
    from matplotlib.ft2font import FT2Font

    further = east_asian_font()
    files = [font_folders()[0] / "DejaVuSans.ttf", *([further] if further else [])]
    return frozenset(code for file in files for code in FT2Font(str(file)).get_charmap())


def printable(text: str) -> str:
    """Visible text in which a character without a glyph stands as "‹U+6F22›"."""
    drawable = _drawable()
    return "".join(c if c in "\n\t" or ord(c) in drawable else f"‹U+{ord(c):04X}›" for c in visible(text))


def directed(text: str) -> str:
    """Isolate a text that holds right-to-left letters, so that it is ordered by its own first letter."""
    rightward = any(unicodedata.bidirectional(c) in {"R", "AL"} for c in text)
    return f"{ISOLATE}{text}{END_ISOLATE}" if rightward else text
