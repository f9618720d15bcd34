"""Long names: cut where space is short, with a mark, and whole in a list of their own."""

from __future__ import annotations

from .blocks import Chart
from .escape import printable
from .wording import short

LONGEST = 300
"""Characters of a name that a table, a heading or a caption on paper holds."""
CUT = 40
"""Characters kept of a long name inside another text."""


class FullNames:
    """The names that were cut in one document, numbered in the order they appear."""

    def __init__(self) -> None:
        self._held: dict[str, int] = {}

    def brief(self, text: str, most: int = LONGEST) -> str:
        """The text on one line, or its beginning and the number under which all of it stands."""
        if text not in self._held:
            text = self.within(text)
        if len(text) <= most:
            return text
        mark = f" [name {self._number(text)}]"
        return short(text, max(most - len(mark), 8)) + mark

    def within(self, text: str) -> str:
        """The text with every long name in it that was met before cut and marked."""
        for name, number in self._held.items():
            if len(name) < len(text) and name in text:
                text = text.replace(name, f"{short(name, CUT)} [name {number}]")
        return text

    def of_chart(self, chart: Chart, most: int) -> tuple[str, ...]:
        """Say where the names stand whole that a figure has no room for."""
        names = [line.label for line in chart.lines] if len(chart.lines) > 1 else []
        cut = dict.fromkeys(n for n in (*names, chart.x.label, chart.y.label) if len(printable(n)) > most)
        return tuple(f"“{short(n, CUT)}” is name {self._number(n)}." for n in cut)

    @property
    def entries(self) -> tuple[tuple[str, str], ...]:
        """Number and whole text of each."""
        return tuple((f"name {number}", text) for text, number in self._held.items())

    def _number(self, text: str) -> int:
        return self._held.setdefault(text, len(self._held) + 1)
