"""One simulated run of a scenario's law and the figures read off it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace
from fractions import Fraction
from typing import final

import numpy as np

from ..models.laws import Law
from ..models.mission import TorqueLimit
from ..models.norms import LARGEST_COMPONENT
from ..models.schedule.variants import starting_at
from ..models.simulation import (
    Figures,
    Invariants,
    SimulationError,
    Trajectory,
    invariants,
    read_mission_figures,
    simulate_mission,
)
from ..models.simulation.idle import idle_lead
from ..models.types import Array
from ..reports import parts
from ..reports.record.claims import QuantityEntry
from ..reports.record.runs import EffortEntry, RunArrays, RunEntry
from ..scenario import Scenario
from .histories import output_times


@final
@dataclass(frozen=True)
class Run:
    """A run to the scenario's horizon.

    Attributes
    ----------
    trajectory : None if the run stopped before the horizon; then `failure` says where and why
    figures : over the whole run
    drift : how well the run kept what must be conserved
    origin : the instant from which the times of trajectory and figures count, s (see `idle_lead`)
    """

    trajectory: Trajectory | None
    figures: Figures | None = None
    drift: Invariants | None = None
    failure: str = ""
    origin: Fraction = Fraction(0)


@final
@dataclass(frozen=True)
class RunFigures:
    """What a run showed.

    Attributes
    ----------
    floor : its least R, s
    peak : its largest applied torque in the limit's norm, N m
    excess_at : an instant at which that torque is well above the limit, s; None if it never is
    """

    floor: float | None = None
    peak: float | None = None
    excess_at: float | None = None


def seen_in(scenario: Scenario, run: Run | None) -> RunFigures:
    """Figures of a run that stand beside what is proved."""
    if run is None or run.figures is None or run.trajectory is None:
        return RunFigures()
    torque, floor = run.figures.torque, run.figures.filter_minimum
    limit = scenario.mission.limit
    norm = LARGEST_COMPONENT if limit is None else limit.norm
    peak = torque.peak[norm]
    over = None
    if limit is not None and not run.trajectory.is_saturated_model:
        over = _excess_instant(run.trajectory, limit, peak.value)
        over = None if over is None else over + float(run.origin)
    return RunFigures(floor.value if floor is not None else None, peak.value, over)


def _excess_instant(trajectory: Trajectory, asked: TorqueLimit, peak: float) -> float | None:
    """First instant at which the torque has gone a tenth of the way from the limit to its peak, s."""
    limit = float(asked.torque)
    if not peak > limit * (1 + 1e-6):
        return None
    times = trajectory.grid()
    size = asked.norm.peak(trajectory.signals(times).applied_torque.T)
    above = np.flatnonzero(size > limit + 0.1 * (peak - limit))
    return float(times[above[0]]) if above.size else None


def run_law(scenario: Scenario, law: Law) -> Run:
    """Simulate a law from the scenario's initial state to its horizon."""
    mission = scenario.mission
    lead, controller = idle_lead(law, mission.schedule, mission.start.rate)
    if lead >= mission.horizon:
        lead, controller = Fraction(0), None
    if lead:
        later = starting_at(mission.schedule, lead)
        mission = replace(mission, schedule=later, horizon=mission.horizon - lead)
    try:
        trajectory = simulate_mission(
            law, mission, controller=controller, saturate=scenario.simulation.saturate
        )
    except SimulationError as error:
        return Run(None, failure=str(error))
    figures = read_mission_figures(trajectory, mission)
    return Run(trajectory, figures, invariants(trajectory), origin=lead)


def metrics(run: Run) -> list[QuantityEntry]:
    """Figures of a run as quantities of the record; the simulation is good to 8 digits, 6 are shown."""
    if run.figures is None or run.drift is None:
        return []
    settling, torque, floor = run.figures.settling, run.figures.torque, run.figures.filter_minimum
    out = []
    if settling is None:
        out.append(parts.quantity("settling_time", None, unit="s", note="not settled within the horizon"))
    else:
        at = float(run.origin) + settling
        digits = 6 if at <= 0 or settling <= 0 else 6 + max(0, math.floor(math.log10(at / settling)))
        label = "settling time"
        out.append(parts.figure_of("settling_time", at, digits=min(digits, 15), unit="s", label=label))
    out += [
        *(
            _figure(f"peak_torque_{norm.key}", peak.value, norm.unit, f"peak |g u|, {norm.name}")
            for norm, peak in torque.peak.items()
        ),
        *(
            _figure(f"peak_command_{norm.key}", peak.value, norm.unit, f"peak |u|, {norm.name}")
            for norm, peak in torque.peak_commanded.items()
        ),
        _figure("impulse", torque.impulse, "N m s", "impulse, integral of |g u|"),
    ]
    if floor is not None:
        out.append(_figure("least_filter_state", floor.value, "s", "least R along the run"))
    for name, label, value in (
        ("quaternion_norm_drift", "check: |beta| leaves 1 by", run.drift.quaternion_norm),
        ("free_momentum_drift", "check: |J w| drifts while g = 0 by", run.drift.free_momentum),
    ):
        out.append(parts.quantity(name, 0.0, value, label=label, side="upper"))
    return out


def _figure(name: str, value: float, unit: str, label: str) -> QuantityEntry:
    return parts.figure_of(name, value, digits=6, unit=unit, label=label)


def controller_decays(run: Run) -> bool:
    """Whether the law has states of its own that changed before the run's origin."""
    return run.trajectory is not None and bool(run.trajectory.loop.law.controller_states)


def run_entry(
    scenario: Scenario, run: Run, key: str, label: str, further: Mapping[str, Array] | None = None
) -> tuple[RunEntry, dict[str, Array]]:
    """A run as the record has it and its arrays, on the scenario's output grid (`output_times`).

    `further` holds more histories on that grid, by their role in the record.
    """
    assert run.trajectory is not None
    trajectory = run.trajectory
    times, local = output_times(scenario, run.origin, absolute=True), output_times(scenario, run.origin)
    states, signals = trajectory.state(local), trajectory.signals(local)
    arrays = {
        f"{key}.time": times,
        f"{key}.quaternion": states[:4].T,
        f"{key}.rate": states[4:7].T,
        f"{key}.command": signals.commanded_torque.T,
        f"{key}.torque": signals.applied_torque.T,
        f"{key}.gain": signals.gain,
        f"{key}.error_rate": signals.augmented_rate.T,
    }
    arrays |= {f"{key}.{role}": value for role, value in (further or {}).items()}
    names = trajectory.loop.state_names[7:]
    controller = {name: f"{key}.controller.{name}" for name in names}
    arrays |= {array: states[7 + i] for i, array in enumerate(controller.values())}

    def held(role: str) -> str | None:
        return f"{key}.{role}" if f"{key}.{role}" in arrays else None

    roles = RunArrays(
        time=f"{key}.time",
        quaternion=held("quaternion"),
        rate=held("rate"),
        controller=controller or None,
        command=held("command"),
        torque=held("torque"),
        gain=held("gain"),
        error_rate=held("error_rate"),
        storage=held("storage"),
        storage_bound=held("storage_bound"),
        storage_rate=held("storage_rate"),
        storage_rate_bound=held("storage_rate_bound"),
    )
    notes = [f"The run covers [0, {float(scenario.horizon):g}] s."]
    if run.origin:
        known = " (what the law's own states do is known exactly)" if controller_decays(run) else ""
        notes.append(
            f"From rest and without torque nothing happens before t = {float(run.origin):.10g} s{known}: "
            "the run was integrated from there on, in time counted from there; its histories begin there."
        )
    if trajectory.is_saturated_model:
        notes.append("The torque was limited in this run: no claim covers a saturated run.")
    entry = RunEntry(
        key=key,
        label=label,
        metrics=tuple(metrics(run)),
        arrays=roles,
        saturated=trajectory.is_saturated_model,
        effort=(EffortEntry(label="right-hand sides", count=int(trajectory.evaluations)),),
        notes=tuple(notes),
    )
    return entry, arrays
