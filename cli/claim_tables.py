"""Claims in tables: one row a claim or number, one column a law (or a scenario)."""

from __future__ import annotations

from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, final

from ..reports.numbers import write
from ..study.claims.entries import quantity_entry
from ..verify.claim_table import order_of
from ..verify.verdict import Claim, Quantity, Verdict, Witness

if TYPE_CHECKING:
    from rich.table import Table
    from rich.text import Text

STYLES = {Verdict.PROVED: "bold green", Verdict.REFUTED: "bold red", Verdict.UNDECIDED: "bold yellow"}


@final
@dataclass(frozen=True)
class Column:
    """A heading and the claims that stand under it."""

    heading: str
    claims: tuple[Claim, ...]

    def find(self, key: str) -> Claim | None:
        """The claim of that key, if there is one."""
        return next((claim for claim in self.claims if claim.key == key), None)


def plain_table(*headers: str) -> Table:
    """A table with a rule under its head and nothing else."""
    from rich.box import SIMPLE_HEAD
    from rich.table import Table

    table = Table(box=SIMPLE_HEAD, pad_edge=False, show_edge=False)
    for header in headers:
        table.add_column(header, overflow="fold")
    return table


def verdict_table(name: str, columns: Sequence[Column]) -> Table:
    """One row a claim, its verdict under each heading."""
    table = plain_table(name, *(column.heading for column in columns))
    for key, title in _titles(columns).items():
        table.add_row(title, *(_verdict(column.find(key)) for column in columns))
    return table


def number_table(name: str, columns: Sequence[Column]) -> Table | None:
    """One row a number of a claim, margins after the claim's own numbers; None if there are none."""
    table = plain_table(name, *(column.heading for column in columns))
    for key, title in _titles(columns).items():
        found = [column.find(key) for column in columns]
        quantities = _rows(claim.quantities if claim else () for claim in found)
        margins = _rows(claim.margins if claim else () for claim in found)
        if quantities or margins:
            table.add_row(f"{title}", style="bold")
        for label, cells in quantities.items():
            table.add_row(f"  {label}", *cells)
        for label, cells in margins.items():
            table.add_row(f"  margin: {label}", *cells)
    return table if table.row_count else None


def quantity_text(quantity: Quantity) -> str:
    """A quantity in one phrase, with the digits that are known."""
    return f"{_label(quantity)} {write(quantity_entry(quantity)).ascii}"


def witness_text(witness: Witness) -> str:
    """A witness in one phrase."""
    values = ", ".join(f"{name} = {_value(value)}" for name, value in witness.values.items())
    return f"{values} ({quantity_text(witness.violation)})"


def _titles(columns: Sequence[Column]) -> dict[str, str]:
    titles = {claim.key: claim.title for column in columns for claim in column.claims}
    return {key: titles[key] for key in sorted(titles, key=order_of)}


def _verdict(claim: Claim | None) -> Text:
    from rich.text import Text

    if claim is None:
        return Text("-")
    text = Text()
    text.append(claim.verdict.value, style=STYLES[claim.verdict] if claim.counted else "dim")
    return text if claim.counted else text.append(" *", style="dim")


def _rows(quantities: Iterable[Sequence[Quantity]]) -> dict[str, list[str]]:
    """Cells by label, one a column."""
    columns = [{_label(q): write(quantity_entry(q)).ascii for q in column} for column in quantities]
    labels = list(dict.fromkeys(label for column in columns for label in column))
    return {label: [column.get(label, "-") for column in columns] for label in labels}


def _label(quantity: Quantity) -> str:
    return quantity.label or quantity.name.replace("_", " ")


def _value(value: float | list[float]) -> str:
    if isinstance(value, list):
        return "(" + ", ".join(f"{x:.6g}" for x in value) + ")"
    return f"{value:.8g}"
