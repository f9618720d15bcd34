"""An equation as reports set it: the law states it, the report typesets it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import final


@final
@dataclass(frozen=True)
class Equation:
    r"""One displayed equation.

    Attributes
    ----------
    title : what it is, in words
    typst : Typst's math notation; `vb(x)` is upright bold; no `#`, no `$`
    latex : LaTeX's, of the same formula; `\bm{x}` is bold; no commands beyond those of formulas
    """

    title: str
    typst: str
    latex: str
