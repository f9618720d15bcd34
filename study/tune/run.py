"""The least peak a law of the scenario can reach, and the trade of peak against settling time."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from concurrent.futures import Executor
from fractions import Fraction

import numpy as np

from ...models.apart import apart
from ...models.laws import Law
from ...models.norms import EUCLIDEAN, LARGEST_COMPONENT, NORMS, Norm
from ...models.types import Progress
from ...optim.tuning.conditions import CertifiedConvergence
from ...optim.tuning.front import Front, pareto_front
from ...optim.tuning.search import DifferentialEvolution
from ...optim.tuning.space import SearchSpace
from ...optim.tuning.tune import Tuned, tune
from ...reports import parts
from ...reports.record import Record
from ...reports.record.document import Sections
from ...reports.record.tables import CellEntry, CodeCell, CollectionEntry, SeriesEntry
from ...scenario import LawChoice, Scenario, ScenarioError
from ...verify.filter.comparison import BodyBounds
from ...verify.filter.known_proofs import has_comparison
from ..collections import Arrays, certified_below, collection_record, newtons


def run_tuning(
    scenario: Scenario,
    *,
    settle: Fraction | None = None,
    norm: Norm | None = None,
    law: str | None = None,
    seed: int | None = None,
    progress: Progress | None = None,
) -> Tuned:
    """Search one law's parameters; what is not given comes from the scenario's [tune].

    Raises
    ------
    ScenarioError
        If there is no law, no such law, or no settling time.
    """
    if not scenario.laws:
        raise ScenarioError(scenario.path.name, "has no [[law]] to tune")
    label = law or scenario.tune.law or scenario.laws[0].label
    time = settle if settle is not None else scenario.tune.settle
    if time is None:
        raise ScenarioError(f"{scenario.path.name}: tune.settle", "required (or --settle), but missing")
    _require_time(scenario, time)
    built = scenario.law(label).build()
    require_search_space(scenario, built)
    return tune(
        built,
        scenario.mission,
        settle=time,
        norm=norm or NORMS[scenario.tune.norm],
        label=label,
        ranges=scenario.tune.bounds,
        method=_method(scenario, seed),
        certify=conditions_on(scenario, scenario.law(label)),
        progress=progress,
    )


def _require_time(scenario: Scenario, settle: Fraction) -> None:
    """Refuse a settling time that the run does not reach."""
    if settle > scenario.horizon:
        late, end = apart(settle, scenario.horizon)
        raise ScenarioError(
            f"{scenario.path.name}: tune.settle",
            f"{late} s lie beyond the run, which ends at {end} s: give a "
            "longer simulation.horizon or an earlier settling time",
        )


def require_search_space(scenario: Scenario, law: Law) -> None:
    """Refuse a search without a parameter that may move."""
    try:
        SearchSpace.around(law, scenario.tune.bounds)
    except ValueError as error:
        hint = "give at least one parameter of [tune] bounds a low end below its high end"
        raise ScenarioError(f"{scenario.path.name}: tune.bounds", f"{error}: {hint}") from None


def run_front(
    scenario: Scenario, settles: Sequence[Fraction], *, norm: Norm | None = None,
    labels: Sequence[str] = (), evaluations: int | None = None, executor: Executor | None = None,
) -> Front:  # fmt: skip
    """Tune the laws of these labels (all without any) for every settling time, beside what is possible.

    `norm` and `evaluations` come from the scenario's [tune] where they are not given.

    Raises
    ------
    ScenarioError
        If no law has such a label.
    """
    for settle in settles:
        _require_time(scenario, settle)
    choices = [scenario.law(label) for label in labels] or list(scenario.laws)
    laws = {choice.label: choice.build() for choice in choices}
    for law in laws.values():
        require_search_space(scenario, law)
    return pareto_front(
        laws,
        scenario.mission,
        settles,
        norm=norm or NORMS[scenario.tune.norm],
        method=_method(scenario, None, evaluations),
        certify={
            c.label: found for c in choices if (found := conditions_on(scenario, c)) is not None
        },
        executor=executor,
    )  # fmt: skip


def conditions_on(scenario: Scenario, choice: LawChoice) -> CertifiedConvergence | None:
    """R_min > 0 and convergence proved over the scenario's initial set; None where no proof can apply.

    A law without a comparison system is tuned without certified conditions, and the record says so.
    """
    if not has_comparison(choice.build(), BodyBounds.of(scenario.body)):
        return None
    return CertifiedConvergence(scenario.mission)


def _method(scenario: Scenario, seed: int | None, evaluations: int | None = None) -> DifferentialEvolution:
    evaluations = max(evaluations or scenario.tune.evaluations, 10)
    population = min(100, max(evaluations // 10, 5))
    return DifferentialEvolution(
        evaluations=evaluations,
        population=population,
        polish=evaluations // 2,
        seed=scenario.tune.seed if seed is None else seed,
    )


def tuning_record(scenario: Scenario, tuned: Tuned) -> Record:
    """One search: the answer, its figures from an accurate run, and the history of the search."""
    arrays = Arrays()
    run = tuned.run(scenario.mission)
    tables = []
    if run is not None:
        rows: list[dict[str, CellEntry]] = [
            {"name": name, "value": CodeCell(code=str(float(value)))}
            for name, value in run.law.parameters.items()
        ]
        columns = [parts.column("name", "parameter"), parts.column("value", "value, exact")]
        tables.append(parts.table("parameters", f"Parameters of {tuned.label}", columns, rows))
        assert run.figures.settling is not None
        figures: list[dict[str, CellEntry]] = [
            {
                "name": "settling time",
                "value": parts.figure_of("settling", run.figures.settling, digits=6, unit="s"),
            },
            {"name": "peak, component", "value": newtons("component", run.peak(LARGEST_COMPONENT))},
            {"name": "peak, Euclidean", "value": newtons("euclidean", run.peak(EUCLIDEAN))},
        ]
        head = [parts.column("name", "figure"), parts.column("value", "value")]
        tables.append(parts.table("figures", "Simulated again at full accuracy", head, figures))
    best = np.array(tuned.history.best_so_far)
    first = int(np.argmax(np.isfinite(best))) if np.isfinite(best).any() else len(best)
    figures_out = []
    if first < len(best):
        x = arrays.put("search.trial", np.arange(first, len(best)) + 1.0)
        line = parts.series("least peak so far", x, arrays.put("search.best", best[first:]), role="law")
        figures_out.append(
            parts.figure(
                "search", "History of the search", parts.axis("simulated candidates"),
                parts.axis("least peak", "N m", log=True), [line],
                alt="Least peak of a candidate that settles in time, against candidates simulated.",
            )
        )  # fmt: skip
    return collection_record(
        scenario,
        title=f"Tuning of {tuned.label}",
        command=f"intermit tune {scenario.path.name}",
        sections=Sections(
            tuning=CollectionEntry(
                title=f"Least peak of {tuned.label} settled by {float(tuned.settle):g} s",
                summary=_summary(tuned),
                tables=tuple(tables),
                figures=tuple(figures_out),
                notes=(
                    *_refusals(tuned),
                    *_uncertified(scenario, [tuned.label]),
                    "A seeded global search: an upper bound on the least peak this law can reach.",
                ),
            )
        ),
        arrays=arrays,
        seeds={"search": tuned.history.seed},
        options={"settle": float(tuned.settle), "norm": tuned.norm.key, "trials": len(tuned.history.trials)},
    )


SHOWN = 3
"""Candidates turned down that are listed one by one."""


def _refusals(tuned: Tuned) -> Iterator[str]:
    """Candidates with a lower peak that were turned down, and what to do if none was left."""
    for trial, reason in tuned.refused[:SHOWN]:
        values = ", ".join(f"{name} = {float(value):g}" for name, value in trial.parameters)
        yield f"turned down: {values} (peak {trial.peak:.4g} N m, settles in its run): {reason}"
    if len(tuned.refused) > SHOWN:
        yield f"turned down for such reasons: {len(tuned.refused) - SHOWN} more"
    if tuned.law is None and tuned.refused:
        yield (
            "What is turned down may well converge: the certified bounds are wider than the runs. A smaller "
            "[initial_set], other [tune] bounds or a later settling time may leave some to be certified."
        )


def _uncertified(scenario: Scenario, labels: Sequence[str]) -> list[str]:
    """One line for each law that was tuned without certified conditions."""
    return [
        f"{label}: no certified condition exists for this law; it is simulated, nothing is proved of it."
        for label in labels
        if not has_comparison(scenario.law(label).build(), BodyBounds.of(scenario.body))
    ]


def _summary(tuned: Tuned) -> str:
    settled = len(tuned.history.settled_by_peak)
    text = f"{len(tuned.history.trials)} candidates simulated, {settled} of them settle in time."
    return text if tuned.law is not None else f"{text} No answer: {tuned.reason}."


def front_record(scenario: Scenario, front: Front) -> Record:
    """The Pareto front as a table and a figure with the certified band."""
    arrays = Arrays()
    settles = [float(s) for s in front.settles]
    columns = [
        parts.column("settle", "settled by", "s"),
        parts.column("bound", "certified bound", "N m"),
        parts.column("optimum", "optimum found", "N m"),
        *(parts.column(f"law{i}", f"{label}, tuned", "N m") for i, label in enumerate(front.runs, start=1)),
        *(parts.column(f"par{i}", f"parameters of {label}") for i, label in enumerate(front.runs, start=1)),
    ]
    rows = [_front_row(front, i) for i in range(len(settles))]
    band = [i for i, b in enumerate(front.best) if b.optimum is not None]
    lines: list[SeriesEntry] = []
    if band:
        x = arrays.put("front.band.settle", [settles[i] for i in band])
        low = arrays.put("front.band.bound", [front.best[i].bound for i in band])
        high = arrays.put("front.band.optimum", [front.best[i].optimum or 0.0 for i in band])
        lines.append(parts.series("certified band", x, low, style="band", upper=high, role="bound"))
        lines.append(parts.series("optimum found", x, high, style="line+points", role="optimum"))
    for number, (label, runs) in enumerate(front.runs.items(), start=1):
        found = [(settles[i], run.peak(front.norm)) for i, run in enumerate(runs) if run is not None]
        if found:
            x = arrays.put(f"front.law{number}.settle", [s for s, _ in found])
            y = arrays.put(f"front.law{number}.peak", [p for _, p in found])
            lines.append(parts.series(f"{label}, tuned", x, y, style="line+points", role="law"))
    section = CollectionEntry(
        title="Peak torque against settling time",
        summary="The optimum with its certified band, and the best each law reaches over its parameters.",
        tables=(parts.table("front", f"Pareto front, {front.norm.key} norm", columns, rows),),
        figures=(
            parts.figure(
                "front", "Pareto front", parts.axis("settled by", "s"),
                parts.axis("peak torque", "N m", log=True), lines,
                alt="Peak torque against settling time for each law and for the optimum with its bound.",
            ),
        ),
        notes=(
            "No controller whatever lies below the certified bound.",
            "A law's points come from a seeded global search: upper bounds on its least peak.",
            *_uncertified(scenario, list(front.runs)),
        ),
    )  # fmt: skip
    return collection_record(
        scenario,
        title=f"Pareto front of {scenario.name}",
        command=f"intermit tune {scenario.path.name} --front",
        sections=Sections(front=section),
        arrays=arrays,
        seeds={"search": scenario.tune.seed},
        options={"settle": settles, "norm": front.norm.key},
    )


def _front_row(front: Front, index: int) -> dict[str, CellEntry]:
    best = front.best[index]
    row: dict[str, CellEntry] = {
        "settle": parts.quantity("settle", float(best.settle), unit="s"),
        "bound": certified_below("bound", best.bound),
        "optimum": best.answer.reason if best.optimum is None else newtons("optimum", best.optimum),
    }
    for number, (label, runs) in enumerate(front.runs.items(), start=1):
        run = runs[index]
        row[f"law{number}"] = (
            front.laws[label][index].reason if run is None else newtons("peak", run.peak(front.norm))
        )
        values = {} if run is None else run.law.parameters
        row[f"par{number}"] = ", ".join(f"{name} = {float(value):g}" for name, value in values.items())
    return row
