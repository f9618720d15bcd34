"""How a result shows itself where it is printed: a few lines of text, or the same as HTML in a notebook."""

from __future__ import annotations

from abc import ABC, abstractmethod
from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from typing import final

Row = tuple[str, ...]


@final
@dataclass(frozen=True)
class Summary:
    """A title, sentences and tables.

    Attributes
    ----------
    title : what it is the result of, in one line
    lines : sentences, the answer first
    tables : (head, rows), each row as long as its head
    """

    title: str
    lines: Sequence[str] = ()
    tables: Sequence[tuple[Row, Sequence[Row]]] = ()

    @property
    def text(self) -> str:
        """Plain text, columns aligned, no line ending after the last."""
        parts = ["\n".join((self.title, *self.lines))]
        parts += [_aligned((head, *rows)) for head, rows in self.tables if rows]
        return "\n\n".join(parts)

    @property
    def html(self) -> str:
        """The same as HTML; every word escaped."""
        out = [f"<strong>{escape(self.title)}</strong>"]
        out += [f"<p>{escape(line.strip())}</p>" for line in self.lines]
        for head, rows in self.tables:
            body = "".join(f"<tr>{_cells('td', row)}</tr>" for row in rows)
            out.append(f"<table><thead><tr>{_cells('th', head)}</tr></thead><tbody>{body}</tbody></table>")
        return "<div>" + "".join(out) + "</div>"


def _aligned(rows: Sequence[Row]) -> str:
    widths = [max(map(len, column)) for column in zip(*rows, strict=True)]
    cells = (zip(row, widths, strict=True) for row in rows)
    return "\n".join("  ".join(cell.ljust(width) for cell, width in row).rstrip() for row in cells)


def _cells(tag: str, row: Row) -> str:
    return "".join(f"<{tag}>{escape(cell)}</{tag}>" for cell in row)


class Shown(ABC):
    """A result that prints what it found: `str()` some lines, `repr()` one, a notebook a table."""

    @property
    @abstractmethod
    def summary(self) -> Summary:
        """What is shown."""

    def __str__(self) -> str:
        return self.summary.text

    def __repr__(self) -> str:
        found = self.summary
        return f"<{type(self).__name__} {': '.join((found.title, *found.lines[:1]))}>"

    def _repr_html_(self) -> str:
        return self.summary.html
