"""Two-column CSV files: on/off times and thrust samples, exact, with the line of every row."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from pathlib import Path
from typing import final

from .errors import ScenarioError, quote
from .exact import exact_from_text
from .files import read_text


@final
@dataclass(frozen=True)
class Row:
    """Two numbers and the line of the file that holds them."""

    line: int
    first: Fraction
    second: Fraction


def read_rows(path: Path, key: str, columns: tuple[str, str]) -> list[Row]:
    """Read a CSV of two numeric columns, with or without a header, `#` comments allowed.

    Parameters
    ----------
    path : Path
        The CSV file.
    key : str
        The scenario key that names it, for messages.
    columns : tuple of two str
        What a header must call the columns (its names may go on, e.g. "on_s" or "on [s]").

    Raises
    ------
    ScenarioError
        Naming the line: not two numbers, a wrong header; or the file: unreadable, empty, header only.
    """
    where = f"{key}: {path.name}"
    text = read_text(path, where)
    rows: list[Row] = []
    header = False
    for number, line in enumerate(text.splitlines(), start=1):
        content = line.split("#", 1)[0].strip()
        if not content:
            continue
        cells = [cell.strip() for cell in content.split(",")]
        at = f"{where} line {number}"
        if not rows and not header and _is_header(cells):
            _check_header(cells, columns, at)
            header = True
            continue
        if len(cells) != 2:
            raise ScenarioError(
                at, f"expected two numbers, '{columns[0]},{columns[1]}', received {quote(content)}"
            )
        try:
            rows.append(Row(number, exact_from_text(cells[0]), exact_from_text(cells[1])))
        except ValueError as error:
            raise ScenarioError(at, str(error)) from None
    if not rows:
        what = "has a header and no rows" if header else "is empty"
        raise ScenarioError(where, f"{what}: expected rows '{columns[0]},{columns[1]}'")
    return rows


def _is_header(cells: list[str]) -> bool:
    words = {"nan", "inf", "infinity"}
    return all(c[:1].isalpha() and c.lower() not in words for c in cells if c) and any(cells)


def _check_header(cells: list[str], columns: tuple[str, str], at: str) -> None:
    named = len(cells) == 2 and all(
        cell.lower().startswith(column) for cell, column in zip(cells, columns, strict=True)
    )
    if not named:
        raise ScenarioError(
            at, f"expected the header '{columns[0]},{columns[1]}', received {quote(','.join(cells))}"
        )
