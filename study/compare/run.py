"""Every law of a scenario on the same work, each against the optimum for its own settling time."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, final

import numpy as np

from ...errors import InputError
from ...models.apart import apart
from ...models.norms import EUCLIDEAN, LARGEST_COMPONENT, NORMS
from ...models.simulation import SimulationError
from ...models.types import Array, Interrupted, Progress, silent
from ...optim.comparison.equal_terms import EqualTerms, on_equal_terms
from ...optim.comparison.measure import Goal, LawRun, run_law
from ...optim.problem import WindowProfile
from ...reports import parts
from ...reports.content.blocks import Axis, Chart, Line
from ...reports.record import Record
from ...reports.record.document import Sections
from ...reports.record.tables import CellEntry, CollectionEntry, FigureEntry, TableEntry
from ...reports.summary import Shown, Summary
from ...scenario import Scenario
from ..collections import Arrays, certified_below, collection_record, newtons, printed
from ..options import CompareOptions
from ..plots import TIME, draw, level, needed, windows_of

if TYPE_CHECKING:
    from numpy.typing import NDArray

POINTS = 2001
"""Points of a torque history in the record."""


@final
@dataclass(frozen=True, eq=False)
class Row:
    """One law and the terms of comparison.

    Attributes
    ----------
    run : None if it could not be carried to its horizon
    terms : by norm; none where there is nothing to compare
    failure : why its settling is not compared, in words; empty if it is
    is_answered : whether what was asked was found: the comparison, or that there is nothing to compare
    next_step : what the user can do if not
    """

    label: str
    run: LawRun | None
    terms: dict[str, EqualTerms]
    failure: str = ""
    is_answered: bool = True
    next_step: str = ""


@final
@dataclass(frozen=True, eq=False, repr=False)
class Comparison(Shown):
    """All laws of a scenario.

    Attributes
    ----------
    rows : one a law; `.terms[norm]` has `.law_peak`, `.optimum`, `.bound`, N m, and their ratios
    """

    scenario: Scenario
    rows: tuple[Row, ...]

    @property
    def is_complete(self) -> bool:
        """Whether every law was compared, each optimum checked, or had nothing to compare."""
        terms = [t for row in self.rows for t in row.terms.values()]
        return all(row.is_answered for row in self.rows) and all(t.optimum is not None for t in terms)

    @property
    def summary(self) -> Summary:
        """What each law did, and each beside optimum and bound, as `intermit compare` prints them."""
        tables = [_laws_table(self), *(_norm_table(self, norm) for norm in self.scenario.compare.norms)]
        why = [
            f"{row.label}: {row.failure}" + (f"; next: {row.next_step}" if row.next_step else "")
            for row in self.rows
            if row.failure
        ]
        title = f"Laws of {self.scenario.name} on equal terms"
        return Summary(title, why, [printed(table) for table in tables])

    def plot(self, norm: str | None = None) -> NDArray[np.object_]:
        """Draw the size of each law's torque, N m, until it settles, over the certified bound.

        Parameters
        ----------
        norm : str, optional
            Word of the norm of the torque; the scenario's first without one.

        Returns
        -------
        numpy array of matplotlib axes, (number of laws that ran,)

        Raises
        ------
        InputError
            If no law ran to the horizon, or the scenario does not compare in that norm.
        """
        chosen = norm or self.scenario.compare.norms[0]
        if chosen not in self.scenario.compare.norms:
            raise InputError(f"norm: the scenario compares in {', '.join(self.scenario.compare.norms)}")
        charts = [_chart(row, chosen) for row in self.rows if row.run is not None]
        if not charts:
            raise InputError("nothing to draw: no law ran to the horizon")
        return draw(charts)

    def to_dataframe(self) -> Any:
        """One row a law and norm as a pandas DataFrame: settling, s; peak, optimum and bound, N m.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        rows = [
            {
                "law": row.label, "norm": norm, "settling [s]": row.run.figures.settling,
                "peak [N m]": terms.law_peak, "optimum [N m]": terms.optimum, "bound [N m]": terms.bound,
            }
            for row in self.rows
            if row.run is not None
            for norm, terms in row.terms.items()
        ]  # fmt: skip
        return needed("pandas", "to_dataframe()").DataFrame(rows)


def torque_size(row: Row, norm: str) -> tuple[Array, Array]:
    """Instants (n,), s, until the law settles (or its run ends), and the size of its torque (n,), N m."""
    assert row.run is not None
    end = row.run.figures.settling if row.run.figures.settling is not None else row.run.trajectory.end
    t = np.linspace(0, end, POINTS)
    return t, NORMS[norm].peak(row.run.trajectory.signals(t).applied_torque.T)


def _chart(row: Row, norm: str) -> Chart:
    t, size = torque_size(row, norm)
    lines = [Line(row.label, t, size)]
    if norm in row.terms:
        lines.append(level("certified bound", t, row.terms[norm].bound, 1))
    shaded = () if row.run is None else windows_of(row.run.mission.schedule, Fraction(float(t[-1])))
    return Chart(norm, row.label, TIME, Axis(f"|g u|, {norm}", "N m"), tuple(lines), "", shaded)


def run_comparison(
    scenario: Scenario, options: CompareOptions | None = None, progress: Progress | None = None
) -> Comparison:
    """Simulate each law, then find the optimum and the certified bound for the same work.

    Raises
    ------
    OrderError
        If certified bound <= optimum <= law is broken anywhere.
    Interrupted
        With the laws compared so far, where the user interrupts after the first.
    """
    options = options if options is not None else CompareOptions()
    tell = progress if progress is not None else silent
    rows: list[Row] = []
    for i, choice in enumerate(scenario.laws):
        tell(f"{choice.label}: optimum and bound for its time", i / len(scenario.laws))
        try:
            rows.append(_row(scenario, choice, options))
        except KeyboardInterrupt:
            if not rows:
                raise
            missing = ", ".join(c.label for c in scenario.laws[i:])
            raise Interrupted(Comparison(scenario, tuple(rows)), f"not finished: {missing}") from None
    return Comparison(scenario, tuple(rows))


def _row(scenario: Scenario, choice: Any, options: CompareOptions) -> Row:
    label = choice.label
    try:
        run = run_law(label, choice.build(), scenario.mission)
    except SimulationError as error:
        return Row(label, None, {}, str(error), False, "mend the law or its parameters: `check` says more")
    if run.figures.settling is not None:
        if run.goal is None:
            return Row(label, run, {}, "is within the tolerances from the start: nothing to compare")
        return Row(label, run, _terms(scenario, run, run.goal))
    failure = _unsettled(run)
    if not options.at_horizon:
        step = (
            "raise simulation.horizon, change the law's parameters, loosen [tolerance], or compare how near "
            "it comes with --at-horizon"
        )
        return Row(label, run, {}, failure, False, step)
    if run.end_goal is None:
        return Row(label, run, {}, f"{failure}, which is no nearer than it started: nothing to compare")
    return Row(label, run, _terms(scenario, run, run.end_goal), f"{failure}: compared with coming as near")


def _terms(scenario: Scenario, run: LawRun, goal: Goal) -> dict[str, EqualTerms]:
    profile = WindowProfile.GAIN if scenario.compare.profile == "gain" else WindowProfile.FULL
    return {
        word: on_equal_terms(run, NORMS[word], goal=goal, profile=profile) for word in scenario.compare.norms
    }


def _unsettled(run: LawRun) -> str:
    """How far a law is from settled at its horizon."""
    settled = run.mission.tolerance
    attitude, rate = (
        apart(value, most, digits=3)[0]
        for value, most in zip(run.end, (settled.attitude, settled.rate), strict=True)
    )
    there = f"|bv| = {attitude}, |w| = {rate} rad/s there"
    return f"does not settle by {float(run.mission.horizon):g} s: {there}"


def comparison_record(comparison: Comparison) -> Record:
    """The comparison as a record: one table for each norm, and the torque histories."""
    scenario, arrays = comparison.scenario, Arrays()
    compared = [norm for norm in scenario.compare.norms if any(norm in row.terms for row in comparison.rows)]
    section = CollectionEntry(
        title="Laws on equal terms",
        summary=_summary(scenario),
        tables=(_laws_table(comparison), *(_norm_table(comparison, norm) for norm in compared)),
        figures=tuple(_torque_figure(comparison, norm, arrays) for norm in scenario.compare.norms),
        notes=tuple(_notes(comparison)),
    )
    return collection_record(
        scenario,
        title=f"Comparison of {scenario.name}",
        command=f"intermit compare {scenario.path.name}",
        sections=Sections(comparison=section),
        arrays=arrays,
    )


def _summary(scenario: Scenario) -> str:
    what = "Peak command u" if scenario.compare.profile == "gain" else "Peak applied torque"
    windows = "windows, of which a share g is passed on" if scenario.compare.profile == "gain" else "windows"
    return (
        f"{what} of each law over its own settling time, beside the least peak any controller needs for the "
        f"same start, {windows}, time and terminal tolerances."
    )


def _notes(comparison: Comparison) -> Iterator[str]:
    tolerance = comparison.scenario.tolerance
    attitude, rate = float(tolerance.attitude), float(tolerance.rate)
    yield f"Settled: |bv| <= {attitude:g} and |w| <= {rate:g} rad/s for good."
    for row in comparison.rows:
        if row.failure:
            step = f"; next: {row.next_step}" if row.next_step else ""
            yield f"{row.label} {row.failure}{step}."
    if any(row.terms for row in comparison.rows):
        yield (
            "certified bound <= optimum <= law was checked in every row against the optimum; "
            "the optimum is the best of several starts, not proved global: the bound is."
        )


def _laws_table(comparison: Comparison) -> TableEntry:
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


def _law_cells(row: Row) -> dict[str, CellEntry]:
    if row.run is None:
        return {"law": row.label, "settling": "stopped"}
    run = row.run
    settling: CellEntry = "not by the horizon"
    if run.figures.settling is not None:
        settling = parts.figure_of("settling", run.figures.settling, digits=6, unit="s")
    floor = run.figures.filter_minimum
    return {
        "law": row.label,
        "settling": settling,
        "component": newtons("component", run.peak(LARGEST_COMPONENT)),
        "euclidean": newtons("euclidean", run.peak(EUCLIDEAN)),
        "impulse": parts.figure_of("impulse", run.figures.torque.impulse, digits=4, unit="N m s"),
        "floor": None if floor is None else parts.figure_of("floor", floor.value, digits=6, unit="s"),
    }


def _norm_table(comparison: Comparison, norm: str) -> TableEntry:
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


def _terms_cells(label: str, terms: EqualTerms) -> dict[str, CellEntry]:
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


def _torque_figure(comparison: Comparison, norm: str, arrays: Arrays) -> FigureEntry:
    lines = []
    for number, row in enumerate(comparison.rows, start=1):
        if row.run is None:
            continue
        t, size = torque_size(row, norm)
        x = arrays.put(f"{norm}.law{number}.time", t)
        lines.append(parts.series(row.label, x, arrays.put(f"{norm}.law{number}.torque", size), role="law"))
    return parts.figure(
        f"torque_{norm}",
        f"Applied torque, {norm} norm",
        parts.axis("time", "s"),
        parts.axis("torque", "N m"),
        lines,
        alt=f"Size of the applied torque of every law over its settling time, or its whole run, {norm} norm.",
        windows=True,
    )
