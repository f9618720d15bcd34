"""The kit: tables, figures and the article that shows them all."""

from __future__ import annotations

from collections.abc import Mapping

from ..content.blocks import (
    Card,
    Cards,
    Cell,
    Chapter,
    Equations,
    Facts,
    Group,
    MatrixCell,
    Table,
    Verdicts,
    charts_of,
    code,
    law_row,
    tables_of,
)
from ..content.cells import cell_text
from ..content.figures import LEGEND_LONGEST
from ..content.heading import Heading
from ..content.names import FullNames
from ..content.verdicts import claim_numbers
from ..content.wording import shares
from ..record.claims import QuantityEntry
from ..record.tables import CodeCell, VerdictCell
from .latex import cell, text, unit
from .pgfplots import plots

PREAMBLE = r"""\documentclass{article}
\usepackage[T1]{fontenc}
\usepackage{textcomp}
\IfFileExists{lmodern.sty}{\usepackage{lmodern}}{}
\usepackage[margin=25mm]{geometry}
\usepackage{amsmath}
\usepackage{bm}
\usepackage{booktabs}
\usepackage{graphicx}
\usepackage{pgfplots}
\pgfplotsset{compat=1.9}
\setlength{\emergencystretch}{3em}
"""


NARROW = 200
"""Characters of a name in a table that cannot break over pages."""


def paper_files(
    heading: Heading, chapters: tuple[Chapter, ...], drawings: Mapping[str, bytes]
) -> dict[str, bytes]:
    """Every file of the kit by path inside it; `drawings` holds "<key>.svg" and "<key>.pdf"."""
    names = FullNames()
    tables = {"verdicts": verdict_table(chapters, names)} | _laws(chapters, names)
    tables |= {t.key: booktabs(t, names) for t in tables_of(chapters)}
    tables |= _scenario(chapters, names)
    files = {f"tables/{name}.tex": body for name, body in tables.items() if body}
    for chart in charts_of(chapters):
        files |= {f"figures/{name}": body for name, body in plots(chart, "figures").items()}
    equations = _equations(chapters)
    if equations:
        files["equations.tex"] = equations
    body = _body(chapters, tuple(n for n, body in tables.items() if body), names)
    files["kit.tex"] = _article(heading, body, names, equations=bool(equations))
    if names.entries:
        files["names.tex"] = "".join(
            rf"\paragraph{{{text(number)}}} {text(whole)}" + "\n\n" for number, whole in names.entries
        )
    out = {name: body.encode("ascii") for name, body in files.items()}
    return out | {f"figures/{name}": data for name, data in drawings.items()}


def booktabs(table: Table, names: FullNames) -> str:
    """One table as a booktabs tabular, to be put into the paper's own float."""
    heads = [
        text(names.brief(label, NARROW)) + (f" (${unit(u)}$)" if u else "") for _, label, u in table.columns
    ]
    rows = [[cell(_cut(row.get(key), names), u) for key, _, u in table.columns] for row in table.rows]
    room = 0.94 - 0.018 * len(heads)
    lengths = [
        [len(label), *(_length(row.get(key)) for row in table.rows)] for key, label, _ in table.columns
    ]
    columns = "".join(rf"p{{{room * share:.3f}\linewidth}}" for share in shares(lengths))
    return tabular(columns, heads, rows, tuple(text(names.brief(n)) for n in table.notes))


def _length(value: Cell) -> int:
    """Characters a cell would like to have side by side; a number has about ten."""
    if isinstance(value, (QuantityEntry, MatrixCell)):
        return 10
    return len(cell_text(value) if value is not None else "")


def _cut(value: Cell, names: FullNames) -> Cell:
    """Mark a long text: a tabular cannot break over pages."""
    if isinstance(value, str):
        return names.brief(value, NARROW)
    return code(names.brief(value.code, NARROW)) if isinstance(value, CodeCell) else value


def tabular(columns: str, heads: list[str], rows: list[list[str]], notes: tuple[str, ...] = ()) -> str:
    """Rules, heads and rows; every cell ragged right and begun with a group, so that [ and * stay text."""
    lines = [rf"\begin{{tabular}}{{@{{}}{columns}@{{}}}}", r"\toprule", _row(heads, bold=True), r"\midrule"]
    lines += [_row(row) for row in rows]
    lines += [r"\bottomrule", r"\end{tabular}"]
    return "\n".join([*lines, *(rf"\par\smallskip{{\footnotesize {n}}}" for n in notes)]) + "\n"


def _row(cells: list[str], *, bold: bool = False) -> str:
    weight = r"\bfseries " if bold else ""
    return " & ".join(rf"\raggedright {weight}{{}}{c}" for c in cells) + r" \tabularnewline"


def verdict_table(chapters: tuple[Chapter, ...], names: FullNames) -> str:
    """Claims, verdicts and margins."""
    groups: tuple[Group, ...] = ()
    for chapter in chapters:
        for block in chapter.blocks:
            groups = block.groups if isinstance(block, Verdicts) else groups
    rows = []
    for group in groups:
        for _, claim in (*group.entries(counted=True), *group.entries(counted=False)):
            margins = "; ".join(cell(q) for q in claim_numbers(claim)) or "--"
            verdict = cell(VerdictCell(verdict=claim.verdict))
            of, title = (text(names.brief(x, NARROW)) for x in (group.label, claim.title))
            rows.append([of, title, verdict, margins])
    widths = ("0.24", "0.33", "0.16", "0.19")
    columns = "".join(rf"p{{{w}\linewidth}}" for w in widths)
    return tabular(columns, ["Of", "Claim", "Verdict", "Margin"], rows) if rows else ""


def _laws(chapters: tuple[Chapter, ...], full: FullNames) -> dict[str, str]:
    cards: tuple[Card, ...] = ()
    for chapter in chapters:
        for block in chapter.blocks:
            cards = block.cards if isinstance(block, Cards) else cards
    names = {q.name: (q.words, q.unit) for card in cards for q in card.numbers}
    if not names:
        return {}
    columns = (("law", "Law", ""), *((name, label, u) for name, (label, u) in names.items()))
    rows = tuple(law_row(card.label, card.numbers) for card in cards)
    return {"laws": booktabs(Table("laws", "Laws", columns, rows), full)}


def _scenario(chapters: tuple[Chapter, ...], names: FullNames) -> dict[str, str]:
    given = (c.blocks for c in chapters if c.key == "problem")
    rows = [r for blocks in given for b in blocks if isinstance(b, Facts) for r in b.rows]
    if not rows:
        return {}
    body = [[text(names.brief(label, NARROW)), cell(_cut(value, names))] for label, value in rows]
    return {"scenario": tabular(r"p{0.36\linewidth}p{0.56\linewidth}", ["Given", "Value"], body)}


def _equations(chapters: tuple[Chapter, ...]) -> str:
    held = [e for c in chapters for b in c.blocks if isinstance(b, Equations) for e in b.equations]
    return "".join(f"% {e.title}\n\\begin{{equation}}\n{e.latex}\n\\end{{equation}}\n" for e in held)


def _body(chapters: tuple[Chapter, ...], tables: tuple[str, ...], names: FullNames) -> list[str]:
    """Every table, then every figure twice: as drawn, and as pgfplots."""
    body = [rf"\begin{{center}}\small\input{{tables/{name}}}\end{{center}}" for name in tables]
    for chart in charts_of(chapters):
        said = " ".join([names.brief(chart.title), *names.of_chart(chart, LEGEND_LONGEST)])
        caption = rf"\par\smallskip{{\small {text(said)}}}\par\bigskip"
        drawn = rf"\includegraphics[width=0.48\linewidth]{{figures/{chart.key}.pdf}}"
        plotted = rf"\begin{{minipage}}[b]{{0.48\linewidth}}\input{{figures/{chart.key}.tex}}\end{{minipage}}"
        body.append(rf"\par\noindent {drawn}\hfill {plotted}{caption}")
    return body


def _article(heading: Heading, body: list[str], names: FullNames, *, equations: bool) -> str:
    title, author, sentence = (
        text(names.brief(x)) for x in (heading.title, heading.author, heading.sentence)
    )
    head = [
        PREAMBLE,
        rf"\title{{{title}}}",
        rf"\author{{{author}}}",
        rf"\date{{{text(heading.date)}}}",
        r"\begin{document}",
        r"\maketitle",
        rf"\noindent {sentence} Record \texttt{{{text(heading.digest)}}}.",
        r"\input{equations}" if equations else "",
    ]
    tail = [r"\section*{Names in full}", r"\input{names}"] if names.entries else []
    return "\n".join([*head, *body, *tail, r"\end{document}", ""])
