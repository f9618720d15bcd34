"""CSV files of windows and thrust samples: columns by name, units converted exactly, every row with its line.

Python's own reader does the quoting; what a separator, a decimal comma, a header or a unit means is decided
here, and what could mean two things is refused.
"""

from __future__ import annotations

import csv
import re
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from difflib import get_close_matches
from fractions import Fraction
from itertools import pairwise
from pathlib import Path
from typing import final

from .errors import ScenarioError, quote
from .exact import exact_from_text
from .files import read_text
from .instants import FileClock, moment
from .units import SPOKEN, TIME, Heading, core, heading

_DECIMAL_COMMA = re.compile(r"[+-]?\d*,\d+(?:[eE][+-]?\d+)?")
_THOUSANDS = re.compile(r"[+-]?[1-9]\d{0,2},\d{3}")
_SEPARATOR_LINE = re.compile(r'\ufeff?[ \t]*"?sep=(?P<separator>[;,\t])"?[ \t]*(?=[\r\n])', re.IGNORECASE)
_SEPARATORS = {",": "commas", ";": "semicolons", "\t": "tabs"}
_NUMBER_WORDS = frozenset({"nan", "inf", "infinity"})


@final
@dataclass(frozen=True)
class Column:
    """A column that is looked for.

    Attributes
    ----------
    names : what a header may call it, as `core` leaves it
    units : factor of each unit that it may state; without one its numbers are taken as they are
    dated : whether it holds instants, which may be ISO 8601 times
    doubtful : whether its name may also mean a duration; the rows must then tell
    """

    names: tuple[str, ...]
    units: Mapping[str, Fraction]
    dated: bool = False
    doubtful: bool = False


@final
@dataclass(frozen=True)
class Row:
    """Two numbers and the line of the file that holds them."""

    line: int
    first: Fraction
    second: Fraction


@final
@dataclass(frozen=True)
class Table:
    """Rows of a file, and which of the forms asked for its header is (0 without a header).

    `unzoned`: whether it holds dates without a zone. `doubtful`: whether its names may mean durations and its
    rows told that they are instants.
    """

    rows: list[Row]
    form: int
    unzoned: bool = False
    doubtful: bool = False


@final
@dataclass(frozen=True)
class _Line:
    number: int
    cells: list[str]


def read_rows(
    path: Path, key: str, forms: Sequence[tuple[Column, Column]], clock: FileClock | None = None
) -> Table:
    """Read two columns of numbers, or of ISO 8601 times, from a CSV file.

    Parameters
    ----------
    path : Path
        The file: separated by commas, semicolons or tabs; `#` begins a comment; a decimal comma is read
        where the separator is not a comma.
    key : str
        The scenario key that names it, for messages.
    forms : sequence of pairs of `Column`
        The pairs that a header may name, among other columns and in any order. A file without a header
        has two columns, those of the first form, in base units.
    clock : FileClock, optional
        What dates count from; without one they are refused.

    Raises
    ------
    ScenarioError
        Naming the line: not numbers, a header without these columns, a unit that is not known; or the
        file: unreadable, empty, header only.
    """
    where = f"{key}: {path.name}"
    text, stated = _without_separator_line(read_text(path, where, wide=True))
    lines, separator = _lines(text, where, stated)
    _refuse_units_in_comments(text, lines, forms, where)
    first = forms[0][0].names[0], forms[0][1].names[0]
    if not lines:
        raise ScenarioError(where, f"is empty: expected rows '{first[0]},{first[1]}'")
    form, places, factors = 0, (0, 1), (Fraction(1), Fraction(1))
    header = _is_header(lines[0].cells)
    width = len(lines[0].cells) if header else 2
    if header:
        form, places, factors = _places(lines[0], forms, where, below=lines[1].cells if lines[1:] else [])
        lines = lines[1:]
    if not lines:
        raise ScenarioError(where, f"has a header and no rows: expected rows '{first[0]},{first[1]}'")
    dates = _Dates(clock if clock is not None else FileClock(), forms[form], factors)
    rows = [
        _row(line, places, dates, width, f"{where} line {line.number}", first, separator) for line in lines
    ]
    doubtful = any(column.doubtful for column in forms[form])
    if doubtful:
        _require_instants(rows, where, forms)
    return Table(rows, form, dates.unzoned, doubtful)


def _require_instants(rows: list[Row], where: str, forms: Sequence[tuple[Column, Column]]) -> None:
    """Refuse numbers under names that may mean durations unless only instants can stand in such an order."""
    in_order = all(a.second <= b.first for a, b in pairwise(rows)) and all(r.first < r.second for r in rows)
    if len(rows) < 2 or not in_order:
        raise ScenarioError(
            f"{where} line {rows[0].line}",
            "'on_time,off_time' may be instants or durations, and the rows do not tell: name the columns "
            f"{_expected(forms)}",
        )


def _without_separator_line(text: str) -> tuple[str, str | None]:
    """The text with the line "sep=;" that spreadsheets put first left empty, and the separator it states."""
    found = _SEPARATOR_LINE.match(text)
    return (text, None) if found is None else (text[found.end() :], found["separator"])


def _lines(text: str, where: str, stated: str | None) -> tuple[list[_Line], str]:
    """Cells of every line that is neither empty nor a comment, and what separates them."""
    kept = [(n, line.split("#", 1)[0]) for n, line in enumerate(text.lstrip("\ufeff").splitlines(), start=1)]
    kept = [(n, line) for n, line in kept if line.strip()]
    separator = stated or next((s for s in (";", "\t") if kept and s in kept[0][1]), ",")
    lines = []
    for number, line in kept:
        try:
            (cells,) = csv.reader([line], delimiter=separator, skipinitialspace=True, strict=True)
        except (csv.Error, ValueError) as error:
            raise ScenarioError(f"{where} line {number}", f"cannot be split into cells: {error}") from None
        lines.append(_Line(number, [cell.strip() for cell in cells]))
    if separator != ",":
        lines = _with_points(lines, where)
    for one in lines:
        while len(one.cells) > 2 and not one.cells[-1]:  # a separator at the end of each line
            one.cells.pop()
    return lines, separator


def _with_points(lines: list[_Line], where: str) -> list[_Line]:
    """Return the lines with points for decimal commas; refuse commas that may separate thousands."""
    with_comma = [(line, c) for line in lines for c in line.cells if _DECIMAL_COMMA.fullmatch(c)]
    if with_comma and all(_THOUSANDS.fullmatch(cell) for _, cell in with_comma):
        line, cell = with_comma[0]
        raise ScenarioError(
            f"{where} line {line.number}",
            f"{quote(cell)} may be decimal or thousands: write a decimal point",
        )
    return [
        _Line(line.number, [c.replace(",", ".") if _DECIMAL_COMMA.fullmatch(c) else c for c in line.cells])
        for line in lines
    ]


def _refuse_units_in_comments(
    text: str, lines: list[_Line], forms: Sequence[tuple[Column, Column]], where: str
) -> None:
    """Refuse a unit that only a comment above the rows states: comments are not read."""
    units = {u for form in forms for column in form for u, x in column.units.items() if x != 1}
    words = "|".join(re.escape(u) for u in sorted(units, key=len, reverse=True))
    stated = re.compile(rf"(?:_|\bin\s+|[\[(]\s*)(?P<unit>{words})(?=[\s,;\])]|$)") if units else None
    first = lines[0].number if lines else 0
    for number, line in enumerate(text.splitlines()[: max(first - 1, 0)], start=1):
        found = stated.search(line) if stated is not None else None
        if found is not None:
            raise ScenarioError(
                f"{where} line {number}",
                f"a comment speaks of {quote(found['unit'])}, and comments are not read: name the columns "
                "with their units in a header without #",
            )


def _is_header(cells: list[str]) -> bool:
    """Whether a line names columns: some cell begins with a letter and none is a number."""
    words = [cell for cell in cells if cell]
    return any(c[0].isalpha() and c.lower() not in _NUMBER_WORDS for c in words) and not any(
        _is_number(c) for c in words
    )


def _is_number(cell: str) -> bool:
    try:
        exact_from_text(cell)
    except ValueError:
        return False
    return True


def _is_date(cell: str) -> bool:
    try:
        return moment(cell) is not None
    except ValueError:
        return True


def _places(
    line: _Line, forms: Sequence[tuple[Column, Column]], where: str, *, below: list[str]
) -> tuple[int, tuple[int, int], tuple[Fraction, Fraction]]:
    """Return which form a header has, where its two columns stand, and their factors.

    Dates have no unit: a column that begins with one in the row `below` needs none beside another's.
    """
    at = f"{where} line {line.number}"
    units = frozenset(unit for form in forms for column in form for unit in column.units)
    headings = [heading(cell, units) for cell in line.cells]
    complete = []
    for number, form in enumerate(forms):
        found = [[i for i, h in enumerate(headings) if core(h.name) in column.names] for column in form]
        for several in found:
            if len(several) > 1:
                names = " and ".join(quote(line.cells[i]) for i in several)
                raise ScenarioError(at, f"can be read in more than one way ({names}): keep one")
        if all(found):
            complete.append((number, (found[0][0], found[1][0])))
    if len(complete) > 1:
        pairs = " and ".join(" with ".join(quote(line.cells[i]) for i in p) for _, p in complete)
        raise ScenarioError(at, f"can be read in more than one way ({pairs}): keep two columns")
    if not complete:
        raise ScenarioError(at, _no_columns(line, headings, forms))
    ((number, places),) = complete
    pair = forms[number]
    dated = any(_is_date(cell) for i, cell in enumerate(below) if i in places)
    if not dated and pair[0].units is pair[1].units and len({headings[i].unit is None for i in places}) > 1:
        names = " and ".join(quote(line.cells[i]) for i in places)
        raise ScenarioError(at, f"only one of {names} states its unit: state both, or neither for seconds")
    factors = [_factor(headings[i], column, at) for i, column in zip(places, pair, strict=True)]
    return number, places, (factors[0], factors[1])


def _no_columns(line: _Line, headings: list[Heading], forms: Sequence[tuple[Column, Column]]) -> str:
    received = quote(",".join(line.cells))
    return f"expected the header {_expected(forms)}, received {received}{_hint(line, headings, forms)}"


def _expected(forms: Sequence[tuple[Column, Column]]) -> str:
    plain = [(a, b) for a, b in forms if not (a.doubtful or b.doubtful)]
    return " or ".join(f"'{a.names[0]},{b.names[0]}'" for a, b in plain)


def _hint(line: _Line, headings: list[Heading], forms: Sequence[tuple[Column, Column]]) -> str:
    """What to do about the first name that is not known, if that can be told."""
    known = [name for form in forms for column in form for name in column.names]
    if any("duration" in h.name and core(h.name) not in known for h in headings):
        return " (a duration needs the instant at which it begins: on,duration)"
    for cell, found in zip(line.cells, headings, strict=True):
        name = core(found.name)
        if name in known:
            continue
        first, _, rest = name.partition("_")
        if first in known and rest:
            return f" ({quote(cell)} does not end in a unit that is known: {SPOKEN})"
        whole = [k for k in known if len(k) > 1 and "_" not in k and k not in {"from", "to"}]
        near = get_close_matches(name, whole, n=1, cutoff=0.7)
        if near:
            return f" (did you mean {quote(near[0])} for {quote(cell)}?)"
    return ""


def _factor(found: Heading, column: Column, at: str) -> Fraction:
    if found.unit is None:
        return Fraction(1)
    if found.unit not in column.units:
        known = SPOKEN if column.dated or column.units is TIME else ", ".join(dict.fromkeys(column.units))
        raise ScenarioError(at, f"the unit {quote(found.unit)} of {quote(found.name)} is none of {known}")
    return column.units[found.unit]


@final
@dataclass
class _Dates:
    """How cells become seconds, and what was seen of dates so far."""

    clock: FileClock
    columns: tuple[Column, Column]
    factors: tuple[Fraction, Fraction]
    known: list[bool] | None = None
    unzoned: bool = False

    def numbers(self, cells: tuple[str, str]) -> tuple[Fraction, Fraction]:
        """Seconds, or numbers, of two cells.

        Raises
        ------
        ValueError
            For what is neither a number nor a date, a date where none belongs, and mixed columns.
        """
        found = [moment(cell) for cell in cells]
        known = [at is not None for at in found]
        for at, column, factor in zip(found, self.columns, self.factors, strict=True):
            if at is not None and not column.dated:
                raise ValueError(f"expected a number under {quote(column.names[0])}, received {at}")
            if at is not None and factor != 1:
                raise ValueError(f"{at} is a date, and the header gives its column a unit: remove the unit")
        both = all(column.dated for column in self.columns)
        if (both and known[0] != known[1]) or known != (self.known or known):
            raise ValueError("mixes dates and seconds: write all instants as dates, or all in seconds")
        self.known = known
        self.unzoned |= any(at is not None and not at.zoned for at in found)
        one, other = (
            exact_from_text(cell) * factor if at is None else self.clock.seconds(at)
            for cell, at, factor in zip(cells, found, self.factors, strict=True)
        )
        return one, other


def _row(
    line: _Line, places: tuple[int, int], dates: _Dates, width: int, at: str, names: tuple[str, str],
    separator: str,
) -> Row:  # fmt: skip
    if not max(places) < len(line.cells) <= width:  # more cells than the header has: a decimal comma, say
        received, few = quote(separator.join(line.cells)), len(line.cells) <= max(places)
        hint = f" (cells are separated by {_SEPARATORS[separator]} here)" if few else ""
        raise ScenarioError(at, f"expected two numbers, '{names[0]},{names[1]}', received {received}{hint}")
    try:
        numbers = dates.numbers((line.cells[places[0]], line.cells[places[1]]))
    except ValueError as error:
        raise ScenarioError(at, str(error)) from None
    return Row(line.number, *numbers)
