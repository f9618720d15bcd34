"""The paper's own comparisons, from its example: g, torques, states, R and k; and what its text says."""

from __future__ import annotations

from dataclasses import dataclass, replace
from fractions import Fraction
from itertools import product
from typing import final

import numpy as np

from ...models.laws import AdaptiveScaling, PersistenceFilter
from ...models.norms import LARGEST_COMPONENT
from ...optim.comparison.measure import LawRun, run_law
from ...reports import parts
from ...reports.record import Record
from ...reports.record.document import Sections
from ...reports.record.tables import CellEntry, CollectionEntry, FigureEntry, TableEntry
from ...scenario import Scenario
from ..collections import Arrays, collection_record
from .statements import StartData, Statement, Survey, statements, survey

POINTS = 2801
GAMMAS = (Fraction(1, 10), Fraction(1, 2))
"""The two learning rates of the paper's figures."""
SURVEYED = {
    "angle_deg": (30.0, 75.0, 120.0, 170.0),
    "rate": (0.0, 0.1),
    "decay": (0.525, 1.0),
    "R0": (0.15, 1.0, 2.0),
    "k0": (0.0, 0.2, 1.0),
}
"""Choices of the data that the paper leaves open, all combinations."""


@final
@dataclass(frozen=True, eq=False)
class BodyRuns:
    """The three runs on one inertia: adaptive with both gammas, and the persistence filter."""

    name: str
    slow: LawRun
    fast: LawRun
    reference: LawRun

    @property
    def runs(self) -> tuple[LawRun, ...]:
        """All three."""
        return (self.slow, self.fast, self.reference)


@final
@dataclass(frozen=True, eq=False)
class PaperStudy:
    """Everything the paper shows, on the bodies of the given scenarios."""

    scenarios: tuple[Scenario, ...]
    bodies: tuple[BodyRuns, ...]
    statements: tuple[tuple[Statement, ...], ...]
    surveys: tuple[Survey, ...]


def run_paper(scenarios: tuple[Scenario, ...], *, with_survey: bool = True) -> PaperStudy:
    """Run the paper's comparisons; the laws' data come from each scenario's first adaptive law.

    Raises
    ------
    ValueError
        If a scenario has no adaptive-scaling law.
    """
    bodies = tuple(_on_body(scenario) for scenario in scenarios)
    said = tuple(statements(b.slow, b.fast, b.reference) for b in bodies)
    return PaperStudy(scenarios, bodies, said, _survey(scenarios[0]) if with_survey else ())


def _on_body(scenario: Scenario) -> BodyRuns:
    laws = (choice.build() for choice in scenario.laws)
    law = next((law for law in laws if isinstance(law, AdaptiveScaling)), None)
    if law is None:
        raise ValueError(f"{scenario.path.name} has no {AdaptiveScaling.name} law")
    mission = scenario.mission
    slow, fast = (run_law(f"adaptive, gamma {float(g):g}", replace(law, gamma=g), mission) for g in GAMMAS)
    reference = run_law("persistence filter", PersistenceFilter(law.lambda_, law.R0), mission)
    return BodyRuns(scenario.spacecraft_name or scenario.name, slow, fast, reference)


def _survey(scenario: Scenario) -> tuple[Survey, ...]:
    choices = [StartData(*values) for values in product(*SURVEYED.values())]
    pairs, references = [], []
    for choice in choices:
        decay, R0, k0 = (Fraction(str(x)) for x in (choice.decay, choice.R0, choice.k0))
        slow, fast = (AdaptiveScaling(lambda_=decay, gamma=g, R0=R0, k0=k0) for g in GAMMAS)
        pairs.append((slow, fast))
        references.append(PersistenceFilter(lambda_=decay, R0=R0))
    return survey(scenario.mission, choices, pairs, references)


def paper_record(study: PaperStudy) -> Record:
    """The paper's figures and its statements as one record."""
    arrays, first = Arrays(), study.bodies[0]
    figures = [_gain_figure(first, arrays)]
    for number, body in enumerate(study.bodies, start=1):
        key = f"body{number}"
        figures.append(_figure(body, arrays, key, "torque", "applied torque, largest component", "N m"))
    figures += [
        _figure(first, arrays, "states", name, title, unit)
        for name, title, unit in (
            ("b0", "quaternion scalar b0", ""),
            ("angle", "|bv|", ""),
            ("speed", "|omega|", "rad/s"),
            ("R", "filter state R", "s"),
            ("k", "gain k", "1/s"),
        )
    ]
    section = CollectionEntry(
        title="The paper's own comparisons",
        summary="What the paper's text says of its figures, checked on the runs of this example and over "
        "choices of the data it leaves open (initial attitude and rate, lambda, R(0), k(0)).",
        tables=(_statement_table(study), *((_survey_table(study),) if study.surveys else ())),
        figures=tuple(figures),
        notes=("Observations on simulated runs, not theorems.",),
    )
    return collection_record(
        study.scenarios[0],
        title="The paper's own comparisons",
        command="intermit paper",
        sections=Sections(paper_claims=section),
        arrays=arrays,
    )


def _statement_table(study: PaperStudy) -> TableEntry:
    columns = [parts.column("says", "the paper says")]
    for number, body in enumerate(study.bodies, start=1):
        columns += [parts.column(f"holds{number}", body.name), parts.column(f"detail{number}", "figures")]
    rows = []
    for i, statement in enumerate(study.statements[0]):
        row: dict[str, CellEntry] = {"says": statement.says}
        for number, said in enumerate(study.statements, start=1):
            row[f"holds{number}"] = "holds" if said[i].holds else "fails"
            row[f"detail{number}"] = said[i].detail
        rows.append(row)
    return parts.table("statements", "On this example", columns, rows)


def _survey_table(study: PaperStudy) -> TableEntry:
    says = {s.key: s.says for s in study.statements[0]}
    columns = [
        parts.column("says", "the paper says"),
        parts.column("holds", "holds in"),
        parts.column("fails", "fails for, among others"),
    ]
    rows = [
        {
            "says": says[found.key],
            "holds": f"{found.holds} of {found.total} choices",
            "fails": "; ".join(_words(c) for c in found.failures[:3]) or "none",
        }
        for found in study.surveys
    ]
    return parts.table("survey", f"Over choices of the unstated data, {study.bodies[0].name}", columns, rows)


def _words(choice: StartData) -> str:
    return (
        f"{choice.angle_deg:g} deg, |w| {choice.rate:g} rad/s, lambda {choice.decay:g}, "
        f"R(0) {choice.R0:g}, k(0) {choice.k0:g}"
    )


def _gain_figure(body: BodyRuns, arrays: Arrays) -> FigureEntry:
    schedule = body.slow.mission.schedule
    t = np.linspace(0, float(schedule.period or schedule.end), 801)
    line = parts.series("g", arrays.put("g.time", t), arrays.put("g.value", schedule.gain(t)))
    return parts.figure(
        "gain", "Gain g over one period", parts.axis("time", "s"), parts.axis("g"), [line],
        alt="The gain g rises from 0 to 1 and falls to 0 in the thruster window of one period.",
    )  # fmt: skip


def _figure(body: BodyRuns, arrays: Arrays, group: str, name: str, title: str, unit: str) -> FigureEntry:
    t = np.linspace(0, body.slow.trajectory.end, POINTS)
    x, lines = arrays.put(f"{group}.{name}.time", t), []
    for number, run in enumerate(body.runs, start=1):
        values = _values(run, name, t)
        if values is not None:
            lines.append(
                parts.series(run.label, x, arrays.put(f"{group}.{name}.{number}", values), role="law")
            )
    return parts.figure(
        f"{group}_{name}", f"{title}, {body.name}", parts.axis("time", "s"), parts.axis(title, unit), lines,
        alt=f"{title} against time under both laws on {body.name}.", windows=True,
    )  # fmt: skip


def _values(run: LawRun, name: str, t: np.ndarray) -> np.ndarray | None:
    state = run.trajectory.state(t)
    if name == "torque":
        return LARGEST_COMPONENT.peak(run.trajectory.signals(t).applied_torque.T)
    if name == "b0":
        return np.asarray(state[0])
    if name == "angle":
        return np.asarray(np.linalg.norm(state[1:4], axis=0))
    if name == "speed":
        return np.asarray(np.linalg.norm(state[4:7], axis=0))
    names = run.trajectory.loop.state_names
    return np.asarray(state[names.index(name)]) if name in names else None
