"""Equations set by Typst as SVG that follows the text's colour; the same glyphs as in the PDF."""

from __future__ import annotations

import re
from functools import lru_cache
from typing import Any

from .blocks import Equation

PREAMBLE = "#let vb(x) = math.upright(math.bold(x))\n"


@lru_cache(maxsize=64)
def equation_svgs(equations: tuple[Equation, ...]) -> tuple[str, ...]:
    """One SVG per equation, all from one run of the compiler."""
    import typst

    pages = "\n#pagebreak()\n".join(f"$ {e.typst} $" for e in equations)
    head = "#set page(width: auto, height: auto, margin: 2pt, fill: none)\n#set text(size: 12pt)\n"
    result: Any = typst.compile((head + PREAMBLE + pages).encode(), format="svg", ignore_system_fonts=True)
    sheets = result if isinstance(result, list) else [result]
    return tuple(_inline(s.decode(), i, e) for i, (s, e) in enumerate(zip(sheets, equations, strict=True)))


def _inline(svg: str, index: int, equation: Equation) -> str:
    """Make ids unique on the page, take the text's colour, and say the equation in LaTeX."""
    svg = re.sub(r'fill="#000(?:000)?"', 'fill="currentColor"', svg)
    svg = re.sub(r'stroke="#000(?:000)?"', 'stroke="currentColor"', svg)
    svg = re.sub(r'id="([A-Za-z])', rf'id="eq{index}\1', svg)
    svg = re.sub(r'href="#([A-Za-z])', rf'href="#eq{index}\1', svg)
    label = equation.latex.replace("&", "&amp;").replace("<", "&lt;").replace('"', "&quot;")
    return svg.replace("<svg ", f'<svg role="img" aria-label="{label}" ', 1)
