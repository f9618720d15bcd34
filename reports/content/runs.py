"""The simulated runs: filter state, torque, attitude, rate and Lyapunov function, law beside law."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import final

import numpy as np

from ..record import Array, Record
from ..record.base import unit_of
from ..record.runs import BoundArrays, BoundRole, CaseEntry, RunArrays, RunEntry, RunRole
from .blocks import Axis, Block, Body, Chapter, Chart, Charts, Line, Replay, Table, Text
from .problem import shaded
from .verdicts import floors
from .wording import plural, shared

TIME = Axis("time", "s")
MAX_BESIDE = 5
"""Runs that a table puts side by side."""
WIDE = 100.0
"""Ratio of the greatest to the least value from which a logarithmic axis says more."""


@final
@dataclass(frozen=True)
class Run:
    """One run with its law's label and a key safe in file names."""

    key: str
    label: str
    case: CaseEntry
    data: RunEntry
    record: Record

    def array(self, role: RunRole) -> Array | None:
        """Array in this role, if the run has it."""
        name = self.data.arrays.name_of(role)
        return None if name is None else self.record.array(name)

    def controller(self, state: str) -> Array | None:
        """Values of one controller state, if the law has it."""
        name = (self.data.arrays.controller or {}).get(state)
        return None if name is None else self.record.array(name)

    @property
    def time(self) -> Array:
        """Times, (n,), s."""
        return self.record.array(self.data.arrays.time)


def runs_of(record: Record) -> tuple[Run, ...]:
    """Every run of every case; the run's label is added where a law has several."""
    found = []
    for i, case in enumerate(record.sections.cases):
        runs = case.runs
        for j, run in enumerate(runs):
            label = case.label if len(runs) == 1 else f"{case.label}, {run.label}"
            found.append(Run(f"{i + 1}" if len(runs) == 1 else f"{i + 1}-{j + 1}", label, case, run, record))
    return tuple(found)


def _components(run: Run, role: RunRole, names: tuple[str, ...]) -> tuple[Line, ...]:
    values = run.array(role)
    if values is None:
        return ()
    return tuple(Line(name, run.time, values[:, i], colour=i) for i, name in enumerate(names))


def _reach(charts: list[tuple[Line, ...]]) -> tuple[float, float] | None:
    """A common range of y, so that neighbouring figures compare at a glance."""
    values = [line.y for lines in charts for line in lines]
    if len(charts) < 2 or not values:
        return None
    low, high = min(float(v.min()) for v in values), max(float(v.max()) for v in values)
    pad = 0.04 * (high - low) or 1.0
    return (low - pad, high + pad)


def _beside(
    record: Record, key: str, what: str, y: Axis, lines: list[tuple[Run, tuple[Line, ...]]]
) -> Iterator[Chart]:
    present = [(run, group) for run, group in lines if group]
    reach = _reach([group for _, group in present])
    for run, group in present:
        alt = f"{what} of {run.label} over time, {plural(len(group), 'line')}, thruster windows shaded."
        yield Chart(f"{key}-{run.key}", f"{what}: {run.label}", TIME, y, group, alt, shaded(record), reach)


def metrics_table(runs: tuple[Run, ...]) -> Table | None:
    """Runs beside each other, one row a figure; one row a run if there are many."""
    columns: dict[str, tuple[str, str]] = {}
    for run in runs:
        for q in run.data.metrics:
            columns.setdefault(q.name, (q.words, q.unit))
    if not columns:
        return None
    held = [{q.name: q for q in run.data.metrics} for run in runs]
    if len(runs) <= MAX_BESIDE:
        heads = (("what", "Figure", ""), *((str(i), run.label, "") for i, run in enumerate(runs)))
        lines = tuple(
            {"what": label} | {str(i): metrics.get(name) for i, metrics in enumerate(held)}
            for name, (label, _) in columns.items()
        )
        return Table("runs", "What the runs came to", heads, lines)
    rows = tuple({"run": run.label} | metrics for run, metrics in zip(runs, held, strict=True))
    heads = (("run", "Run", ""), *((name, label, unit) for name, (label, unit) in columns.items()))
    return Table("runs", "What the runs came to", heads, rows)


def torque_chapter(record: Record) -> Chapter | None:
    """Applied torque, law beside law on one scale, and the numbers."""
    runs = runs_of(record)
    table = metrics_table(runs)
    axes = ("x", "y", "z")
    applied = list(
        _beside(
            record,
            "torque",
            "Applied torque g u",
            Axis("g u", unit_of(RunArrays, "torque")),
            [(r, _components(r, "torque", axes)) for r in runs],
        )
    )
    applied += _envelopes(record, "torque_bound")
    commanded = list(
        _beside(
            record,
            "command",
            "Commanded torque u",
            Axis("u", unit_of(RunArrays, "command")),
            [(r, _components(r, "command", axes)) for r in runs],
        )
    )
    blocks: list[Block] = [table] if table else []
    blocks += [Charts(tuple(c)) for c in (applied, commanded) if c]
    notes = ((run.label, note) for run in runs for note in run.data.notes)
    blocks.extend(Text(note, "note") for note in shared(notes))
    return Chapter("torque", "Torque", tuple(blocks)) if blocks else None


def filter_chapter(record: Record) -> Chapter | None:
    """R of each run beside its certified floor, on one logarithmic scale; k of all runs; other states."""
    runs = runs_of(record)
    floors_by_case = _by_case(record, "filter_floor", "certified floor")
    charts: list[Chart] = []
    for run in runs:
        values = run.controller("R")
        if values is not None:
            lines = [Line("R", run.time, values), *floors_by_case.get(run.case.key, ())]
            words = f"Filter state R{' and its certified floor' if len(lines) > 1 else ''}"
            log = bool(np.all(values > 0))
            alt = f"{words} of {run.label} over time, thruster windows shaded."
            title = f"{words}: {run.label}"
            charts.append(
                Chart(
                    f"state-r-{run.key}", title, TIME, Axis("R", "s", log), tuple(lines), alt, shaded(record)
                )
            )
    scaling = [(run, run.controller("k")) for run in runs]
    lines = [Line(run.label, run.time, k, colour=i) for i, (run, k) in enumerate(scaling) if k is not None]
    if lines:
        alt = f"Adaptive scaling k over time, {plural(len(lines), 'line')}."
        charts.append(
            Chart("state-k", "Adaptive scaling k", TIME, Axis("k", "1/s"), tuple(lines), alt, shaded(record))
        )
    charts += _other_states(record, runs)
    return Chapter("filter", "Filter and scaling", (Charts(tuple(charts)),)) if charts else None


def _by_case(record: Record, role: BoundRole, label: str) -> dict[str, list[Line]]:
    """Certified curves of each law, or the level its certificate or claim states."""
    found: dict[str, list[Line]] = {}
    for case in record.sections.cases:
        lines = [Line(label, t, values, colour=1, dashed=True) for t, values in _bounds(record, case, role)]
        known = [q.low for q in floors(case) if q.low is not None]
        if not lines and known and case.runs:
            t = record.array(case.runs[0].arrays.time)[[0, -1]]
            lines = [Line(label, t, np.full(2, float(known[0])), colour=1, dashed=True)]
        found[case.key] = lines
    return found


def _certified(record: Record, role: BoundRole) -> list[Line]:
    """Collect the certified curves of one role, one per law that has it, in the law's colour, dashed."""
    lines = []
    for i, case in enumerate(record.sections.cases):
        lines += [
            Line(case.label, t, values, colour=i, dashed=True) for t, values in _bounds(record, case, role)
        ]
    return lines


def _bounds(record: Record, case: CaseEntry, role: BoundRole) -> Iterator[tuple[Array, Array]]:
    """Times and values of a case's certified bounds of one role."""
    for certificate in case.certificates:
        arrays = certificate.arrays
        if arrays is not None and (name := arrays.name_of(role)) is not None:
            yield record.array(arrays.time), record.array(name)


def _other_states(record: Record, runs: tuple[Run, ...]) -> Iterator[Chart]:
    for run in runs:
        for i, (state, name) in enumerate(sorted((run.data.arrays.controller or {}).items())):
            if state in {"R", "k"}:
                continue
            values = record.array(name).reshape(len(run.time), -1)
            lines = tuple(
                Line(f"{state} {j + 1}", run.time, values[:, j], colour=j) for j in range(values.shape[1])
            )
            title = f"Controller state {state}: {run.label}"
            yield Chart(
                f"other-{run.key}-{i}", title, TIME, Axis(state), lines, f"{title} over time.", shaded(record)
            )


def attitude_chapter(record: Record) -> Chapter | None:
    """The replay, then quaternion, rate and certified envelopes."""
    runs = runs_of(record)
    quaternion = [(r, _components(r, "quaternion", ("β₀", "β₁", "β₂", "β₃"))) for r in runs]
    rate = [(r, _components(r, "rate", ("ω₁", "ω₂", "ω₃"))) for r in runs]
    attitude = [
        *_beside(record, "quaternion", "Attitude", Axis("β"), quaternion),
        *_envelopes(record, "angle_bound"),
    ]
    rates = [
        *_beside(record, "rate", "Rate", Axis("ω", unit_of(RunArrays, "rate")), rate),
        *_envelopes(record, "speed_bound"),
        *_envelopes(record, "rate_bound"),
    ]
    blocks: list[Block] = []
    bodies = _bodies(record, runs)
    if bodies:
        inertia = record.sections.scenario.inertia if record.sections.scenario is not None else None
        blocks.append(Replay(bodies, shaded(record), inertia))
    blocks += [Charts(tuple(group)) for group in (attitude, rates) if group]
    return Chapter("attitude", "Attitude and rate", tuple(blocks)) if blocks else None


ENVELOPES: tuple[tuple[BoundRole, str], ...] = (
    ("torque_bound", "Certified bound on the applied torque |g u|"),
    ("angle_bound", "Certified bound on the error angle"),
    ("speed_bound", "Certified bound on the rate |ω|"),
    ("rate_bound", "Certified bound on sqrt(Ω' J Ω)"),
)
"""Bounds over time that have a figure of their own, and its title."""


def _envelopes(record: Record, role: BoundRole) -> Iterator[Chart]:
    lines, words = _certified(record, role), dict(ENVELOPES)[role]
    if lines:
        axis = Axis("bound", unit_of(BoundArrays, role))
        key = f"bound-{role.removesuffix('_bound')}"
        yield Chart(key, words, TIME, axis, tuple(lines), f"{words} over time.", shaded(record))


def _bodies(record: Record, runs: tuple[Run, ...]) -> tuple[Body, ...]:
    found = []
    for run in runs:
        attitude = run.array("quaternion")
        if attitude is not None:
            found.append(Body(run.label, run.time, attitude, run.array("torque")))
    for optimum in record.sections.optimum:
        names = optimum.arrays
        if names is not None and names.quaternion is not None:
            torque = record.array(names.torque) if names.torque is not None else None
            time, attitude = record.array(names.time), record.array(names.quaternion)
            found.append(Body(optimum.label, time, attitude, torque))
    return tuple(found)


STORED: tuple[tuple[RunRole, RunRole, str], ...] = (
    ("storage", "storage_bound", "Lyapunov function V"),
    ("storage_rate", "storage_rate_bound", "Derivative V'"),
)
"""Histories of the storage function, the bound of each, and its name."""


def storage_chapter(record: Record) -> Chapter | None:
    """V and V' with their bounds along each run."""
    charts = []
    for run in runs_of(record):
        for role, limit, words in STORED:
            values, bound = run.array(role), run.array(limit)
            if values is None:
                continue
            lines = [Line(words, run.time, values)]
            if bound is not None:
                lines.append(Line("its bound", run.time, bound, colour=1, dashed=True))
            log = role == "storage" and float(values.max()) > WIDE * float(values.min()) > 0
            alt = f"{words} of {run.label} along the run{' with its bound' if bound is not None else ''}."
            title = f"{words}: {run.label}"
            axis = Axis("V" if role == "storage" else "V'", unit_of(RunArrays, role), log)
            charts.append(
                Chart(
                    f"{role.replace('_', '-')}-{run.key}",
                    title,
                    TIME,
                    axis,
                    tuple(lines),
                    alt,
                    shaded(record),
                )
            )
    return Chapter("storage", "Lyapunov function", (Charts(tuple(charts)),)) if charts else None
