"""The page: chapters through one template, scripts and styles inside, a policy that forbids the network."""

from __future__ import annotations

import base64
import hashlib
import json
from collections.abc import Mapping
from functools import cache
from importlib.resources import files
from typing import Any

from markupsafe import Markup

from ..content.blocks import Cell, Chapter, Chart, MatrixCell, Replay, charts_of
from ..content.budget import thin
from ..content.heading import Heading
from ..content.typeset import equation_svgs
from ..content.verdicts import claim_numbers, refutation
from ..content.wording import MAX_LABEL, json_text, short, visible
from ..numbers import number, unit_text, write
from ..record.claims import QuantityEntry, WitnessEntry
from ..record.tables import CodeCell, VerdictCell
from .plotly import figure
from .replay import replay_data

POINT_BUDGET = 100_000
"""Values of all figures together; more are thinned, keeping every bucket's least and greatest."""
PLOTLY = "vendor/plotly-basic-4.1.1.min.js"


def html_page(heading: Heading, chapters: tuple[Chapter, ...]) -> str:
    """Render the whole page as one string."""
    charts = thin(charts_of(chapters), POINT_BUDGET)
    figures = {c.key: i for i, c in enumerate(charts)}
    replays = [b for chapter in chapters for b in chapter.blocks if isinstance(b, Replay)]
    scripts = {"plotly": _shipped(PLOTLY), "page": _shipped("templates/page.js")}
    if replays:
        scripts["replay"] = _shipped("templates/replay.js")
    data = {"charts": [figure(c) for c in charts], "replays": [replay_data(r) for r in replays]}
    page: str = (
        _environment()
        .get_template("page.html.j2")
        .render(
            heading=heading,
            chapters=chapters,
            figures=figures,
            policy=_policy(scripts),
            style=Markup(_shipped("templates/page.css")),
            scripts={k: Markup(v) for k, v in scripts.items()},
            data=Markup(script_json(data)),
        )
    )
    return page


def script_json(data: Any) -> str:
    """Write JSON that may stand inside a script element: no "<", no line separators."""
    text = json.dumps(data, ensure_ascii=True, allow_nan=False, separators=(",", ":"), sort_keys=True)
    return text.replace("<", "\\u003c")


def _policy(scripts: Mapping[str, str]) -> str:
    """Content security policy: nothing from anywhere, no form, only the scripts written here."""
    hashes = " ".join(
        f"'sha256-{base64.b64encode(hashlib.sha256(text.encode()).digest()).decode()}'"
        for text in scripts.values()
    )
    return (
        f"default-src 'none'; script-src {hashes}; style-src 'unsafe-inline'; img-src data: blob:; "
        "form-action 'none'; base-uri 'none'"
    )


@cache
def _shipped(path: str) -> str:
    return files("intermit.reports").joinpath(path).read_text(encoding="utf-8")


@cache
def _environment() -> Any:
    from jinja2 import Environment, FunctionLoader, StrictUndefined

    environment = Environment(
        loader=FunctionLoader(lambda name: _shipped(f"templates/{name}")),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
        finalize=lambda value: visible(value) if type(value) is str else value,
    )
    environment.filters.update(
        cell=html_cell,
        cut=cut_names,
        numbers=claim_numbers,
        refutation=refutation,
        number=html_number,
        unit=unit_text,
        short=short,
        kind=lambda block: type(block).__name__,
        svgs=lambda block: [Markup(s) for s in equation_svgs(block.equations)],
        witness=witness_rows,
        detail=json_text,
        badge=verdict_badge,
    )
    return environment


def cut_names(chart: Chart) -> tuple[str, ...]:
    """Names a figure shows only the beginning of."""
    names = [line.label for line in chart.lines] if len(chart.lines) > 1 else []
    return tuple(dict.fromkeys(n for n in (*names, chart.x.label, chart.y.label) if len(n) > MAX_LABEL))


def html_number(quantity: QuantityEntry, *, unit: bool = True) -> Markup:
    """Set a quantity: bounds and enclosures are marked as rigorous."""
    written = write(quantity, unit=unit)
    kind = "rigorous" if written.rigorous and not written.missing else "figure"
    words = ' title="certified: rounded outward"' if kind == "rigorous" else ""
    return Markup('<span class="number {}"{}>{}</span>').format(kind, Markup(words), visible(written.text))


def html_cell(cell: Cell, column_unit: str = "") -> Markup:
    """Set any cell; the unit is left out where the column's head has it."""
    if cell is None:
        return Markup('<span class="missing">–</span>')
    if isinstance(cell, str):
        return Markup("<bdi>{}</bdi>").format(visible(cell))
    if isinstance(cell, VerdictCell):
        return verdict_badge(cell.verdict)
    if isinstance(cell, CodeCell):
        return Markup("<code><bdi>{}</bdi></code>").format(visible(cell.code))
    if isinstance(cell, MatrixCell):
        return _matrix(cell)
    return html_number(cell, unit=not column_unit or column_unit != cell.unit)


def _matrix(cell: MatrixCell) -> Markup:
    rows = Markup("").join(
        Markup("<tr>{}</tr>").format(
            Markup("").join(Markup("<td>{}</td>").format(number(x, 12)) for x in row)
        )
        for row in cell.matrix
    )
    return Markup('<table class="matrix"><tbody>{}</tbody></table> {}').format(
        rows, visible(unit_text(cell.unit))
    )


def verdict_badge(verdict: str) -> Markup:
    """Verdict in words and a sign, so that colour is not needed."""
    sign = {"PROVED": "✓", "REFUTED": "✗", "UNDECIDED": "?"}[verdict]
    return Markup('<span class="verdict {0}"><span aria-hidden="true">{1}</span> {0}</span>').format(
        verdict, sign
    )


def witness_rows(witness: WitnessEntry) -> list[tuple[str, str]]:
    """List a witness's values in full precision."""
    from ..content.studies import values_text

    return [(key, values_text(value)) for key, value in sorted(witness.values.items())]
