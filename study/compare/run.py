"""Every law of a scenario on the same work, each against the optimum for its own settling time."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, final

import numpy as np

from ...models.simulation import SimulationError
from ...optim.comparison.equal_terms import EqualTerms, on_equal_terms
from ...optim.comparison.measure import LawRun, run_law
from ...reports import parts
from ...reports.record import Record
from ...scenario import Scenario
from ..collections import Arrays, certified_below, collection_record, newtons, task_of

POINTS = 2001
"""Points of a torque history in the record."""


@final
@dataclass(frozen=True, eq=False)
class Row:
    """One law: its run, or why there is none, and the terms of comparison by norm."""

    label: str
    run: LawRun | None
    terms: dict[str, EqualTerms]
    failure: str = ""


@final
@dataclass(frozen=True, eq=False)
class Comparison:
    """All laws of a scenario."""

    scenario: Scenario
    rows: tuple[Row, ...]


def run_comparison(scenario: Scenario) -> Comparison:
    """Simulate each law, then find the optimum and the certified bound for the same work.

    Raises
    ------
    OrderError
        If certified bound <= optimum <= law is broken anywhere.
    """
    return Comparison(scenario, tuple(_row(scenario, choice) for choice in scenario.laws))


def _row(scenario: Scenario, choice: Any) -> Row:
    try:
        run = run_law(choice.label, choice.build(), task_of(scenario))
    except SimulationError as error:
        return Row(choice.label, None, {}, str(error))
    if run.figures.settling is None:
        return Row(choice.label, run, {}, f"does not settle by {float(scenario.horizon):g} s")
    if run.figures.settling <= 0:
        return Row(choice.label, run, {}, "is within the tolerances from the start: nothing to compare")
    terms: dict[str, EqualTerms] = {norm: on_equal_terms(run, norm) for norm in scenario.compare.norms}
    return Row(choice.label, run, terms)


def comparison_record(comparison: Comparison) -> Record:
    """The comparison as a record: one table for each norm, and the torque histories."""
    scenario, arrays = comparison.scenario, Arrays()
    section = {
        "title": "Laws on equal terms",
        "summary": "Peak applied torque of each law over its own settling time, beside the least peak any "
        "controller needs for the same start, windows, time and terminal tolerances.",
        "tables": [_laws_table(comparison)]
        + [_norm_table(comparison, norm) for norm in scenario.compare.norms],
        "figures": [_torque_figure(comparison, norm, arrays) for norm in scenario.compare.norms],
        "notes": [
            f"Settled: |bv| <= {float(scenario.tolerance.attitude):g} and "
            f"|w| <= {float(scenario.tolerance.rate):g} rad/s for good.",
            "certified bound <= optimum <= law was checked in every row; "
            "the optimum is the best of several starts, not proved global: the bound is.",
        ],
    }
    return collection_record(
        scenario,
        title=f"Comparison of {scenario.name}",
        command=f"intermit compare {scenario.path.name}",
        sections={"comparison": section},
        arrays=arrays,
    )


def _laws_table(comparison: Comparison) -> dict[str, Any]:
    columns = [
        parts.column("law", "law"),
        parts.column("settling", "settling", "s"),
        parts.column("component", "peak, component", "N m"),
        parts.column("euclidean", "peak, Euclidean", "N m"),
        parts.column("impulse", "impulse", "N m s"),
        parts.column("floor", "least R", "s"),
    ]
    rows = [_law_cells(row) for row in comparison.rows]
    return parts.table("laws", "What each law did", columns, rows)


def _law_cells(row: Row) -> dict[str, Any]:
    if row.run is None:
        return {"law": row.label, "settling": row.failure}
    run = row.run
    settling: Any = row.failure if run.figures.settling is None else parts.figure_of(
        "settling", run.figures.settling, digits=6, unit="s"
    )  # fmt: skip
    floor = run.figures.filter_minimum
    return {
        "law": row.label,
        "settling": settling,
        "component": newtons("component", run.peak("component")),
        "euclidean": newtons("euclidean", run.peak("euclidean")),
        "impulse": parts.figure_of("impulse", run.figures.torque.impulse, digits=4, unit="N m s"),
        "floor": None if floor is None else parts.figure_of("floor", floor.value, digits=6, unit="s"),
    }


def _norm_table(comparison: Comparison, norm: str) -> dict[str, Any]:
    columns = [
        parts.column("law", "law"),
        parts.column("peak", "law's peak", "N m"),
        parts.column("optimum", "optimum found", "N m"),
        parts.column("bound", "certified bound", "N m"),
        parts.column("name", "bound by"),
        parts.column("ratio", "law/optimum"),
        parts.column("most", "law/bound"),
        parts.column("gap", "gap of the optimum", "%"),
    ]
    rows = [_terms_cells(row.label, row.terms[norm]) for row in comparison.rows if norm in row.terms]
    return parts.table(f"terms_{norm}", f"Against the optimum, {norm} norm", columns, rows)


def _terms_cells(label: str, terms: EqualTerms) -> dict[str, Any]:
    ratio, gap = terms.ratio_to_optimum, terms.gap
    return {
        "law": label,
        "peak": newtons("peak", terms.law_peak),
        "optimum": terms.answer.reason if terms.optimum is None else newtons("optimum", terms.optimum),
        "bound": certified_below("bound", terms.bound),
        "name": terms.certificate.name,
        "ratio": None if ratio is None else parts.figure_of("ratio", ratio, digits=4),
        "most": parts.quantity("most", terms.ratio_to_bound, side="upper"),
        "gap": None if gap is None else parts.quantity("gap", 100 * gap, unit="%", side="upper"),
    }


def _torque_figure(comparison: Comparison, norm: str, arrays: Arrays) -> dict[str, Any]:
    lines = []
    for number, row in enumerate(comparison.rows, start=1):
        if row.run is None:
            continue
        end = row.run.figures.settling if row.run.figures.settling is not None else row.run.trajectory.end
        t = np.linspace(0, end, POINTS)
        torque = row.run.trajectory.signals(t).applied_torque
        size = np.abs(torque).max(axis=0) if norm == "component" else np.linalg.norm(torque, axis=0)
        x = arrays.put(f"{norm}.law{number}.time", t)
        lines.append(parts.series(row.label, x, arrays.put(f"{norm}.law{number}.torque", size), role="law"))
    return parts.figure(
        f"torque_{norm}",
        f"Applied torque, {norm} norm",
        parts.axis("time", "s"),
        parts.axis("torque", "N m"),
        lines,
        alt=f"Size of the applied torque of every law over its settling time, {norm} norm.",
        windows=True,
    )
