"""What an optimum study found, as the sections and arrays of a record."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from ...models.types import Array
from ...reports import parts
from ...reports.provenance import provenance
from ...reports.record import Record
from ...reports.record.claims import QuantityEntry
from ...reports.record.document import Outcome, Sections
from ...reports.record.optimum import LocalOptima, OptimumArrays, OptimumEntry
from ...reports.record.runs import EffortEntry
from ..check.record import scenario_entry
from .result import Optimum, OptimumStudy
from .run import final_time, idle_words

if TYPE_CHECKING:
    from ...optim.peak import LeastImpulseFound, LeastTime, Switching, TorqueHistory


def optimum_record(study: OptimumStudy, *, date: str = "", author: str = "", command: str = "") -> Record:
    """The record of one optimum study."""
    scenario = study.scenario
    entries, arrays = optimum_sections(study)
    effort = [e for entry in entries for e in entry.effort]
    found = provenance(
        scenario_name=scenario.name,
        scenario_text=scenario.text,
        date=date,
        author=author,
        command=command or f"intermit optimum {scenario.path.name}",
        seeds={"starts": scenario.optimum.seed if study.options.seed is None else study.options.seed},
        options={"solver": study.options.solver, "mesh_gap": study.options.mesh_gap},
        effort=effort,
    )
    return Record.create(
        title=f"Least peak torque of {scenario.name}",
        provenance=found.but(input_sha256=scenario.sha256),
        sections=Sections(scenario=scenario_entry(scenario), optimum=tuple(entries)),
        arrays=arrays,
        outcome=Outcome(exit_code=study.exit_code, sentence=study.sentence),
    )


def optimum_sections(study: OptimumStudy) -> tuple[list[OptimumEntry], dict[str, Array]]:
    """Section `optimum` and the arrays it names."""
    entries: list[OptimumEntry] = []
    arrays: dict[str, Array] = {}
    for optimum in study.optima:
        entry, held = optimum_entry(study, optimum)
        entries.append(entry)
        arrays |= held
    return entries, arrays


def optimum_entry(study: OptimumStudy, optimum: Optimum) -> tuple[OptimumEntry, dict[str, Array]]:
    """One least peak with its checks, and its history on a grid."""
    answer, problem = optimum.answer, optimum.problem
    key, unit = f"optimum.{optimum.key}", problem.norm.unit
    held = history_arrays(optimum, key)
    bound, search = optimum.bound, answer.search

    def array(role: str) -> str | None:
        return f"{key}.{role}" if f"{key}.{role}" in held else None

    arrays = OptimumArrays(
        time=f"{key}.time",
        quaternion=array("quaternion"),
        rate=array("rate"),
        torque=array("torque"),
        switching=array("switching"),
        profile=array("profile"),
        momentum=array("momentum"),
    )
    entry = OptimumEntry(
        key=key,
        label=f"least peak, {problem.norm.name}",
        norm=optimum.key,
        profile=study.scenario.optimum.profile,
        terminal="; ".join(filter(None, (terminal_words(optimum), idle_words(study.scenario, problem)))),
        final_time=parts.quantity("final_time", float(final_time(study.scenario)), unit="s"),
        value=parts.figure_of("least_peak", answer.peak if held else None, digits=6, unit=unit),
        bound=None if bound is None else _lower("certified_bound", bound.value, unit),
        bound_name=None if bound is None else bound.name,
        other_bounds=None
        if bound is None
        else tuple(_lower(b.name, b.value, unit) for b in bound.all if b is not bound.best),
        gap=None
        if optimum.gap is None
        else parts.quantity("gap", 0.0, 100 * max(0.0, optimum.gap), unit="%", side="upper"),
        arrays=arrays if held else None,
        switch_times=None
        if answer.switching is None
        else tuple(time for time, _ in answer.switching.switch_times),
        residuals=tuple(residuals(optimum)),
        local_optima=LocalOptima(
            starts=len(search.starts),
            values=tuple(search.local_optima),
            unit=unit,
            spread=parts.figure_of("spread", search.spread, digits=3),
        ),
        effort=(
            EffortEntry(label=f"convex or Newton programs, {optimum.key}", count=answer.iterations),
            EffortEntry(label=f"starts, {optimum.key}", count=len(search.starts)),
        ),
        notes=tuple(notes(study.scenario.path.name, optimum)),
    )
    return entry, held


def least_time_words(least: LeastTime) -> str:
    """The least time found and the latest at which none was, in words."""
    limit = f"{least.limit:g} {least.answer.problem.norm.unit}"
    if least.time is None:
        return f"no transfer within {limit} was found by {float(least.earlier):g} s"
    return (
        f"least time within {limit}: {float(least.time):.6g} s "
        f"(none found {float(least.time - least.earlier):.1g} s sooner; {least.solves} least peaks solved)"
    )


def least_impulse_words(least: LeastImpulseFound) -> str:
    """The least impulse found and what was checked of it, in words."""
    answer, unit = least.answer, least.answer.problem.norm.unit
    if not least.found:
        return f"no transfer within {least.limit:g} {unit} was found, so none of least impulse"
    said = (
        f"least impulse within {least.limit:g} {unit}: {least.impulse:.6g} {unit} s "
        f"({answer.standing.value}; end missed by {answer.flown.terminal_excess:.1g} rad, "
        f"optimality gap {answer.optimality_gap:.2g}, finer cells gain {answer.mesh_gap:.2g})"
        if answer.flown is not None
        else ""
    )
    return f"{said}: {answer.reason}" if answer.reason else said


def _lower(name: str, value: float, unit: str) -> QuantityEntry:
    return parts.quantity(name, value, unit=unit, rigorous=True, side="lower")


def start_words(optimum: Optimum) -> str:
    """The start in words: angle to the target, and how it turns."""
    problem = optimum.problem
    rate = float(np.linalg.norm(problem.start_rate))
    turning = f"turning at {rate:.4g} rad/s" if rate > 0 else "at rest"
    return f"{np.degrees(problem.angle):.6g} deg from the target, {turning}"


def impulse_words(optimum: Optimum) -> str:
    """The impulse of the least-peak history, and what it is the integral of."""
    norm = optimum.problem.norm
    added = any(not block.is_round for block in norm.blocks)
    kind = f" ({'forces' if norm.is_one_sided else 'axes'} added up)" if added else ""
    return f"{optimum.answer.impulse:.6g} {norm.unit} s{kind}"


def switch_words(optimum: Optimum, time: float, component: int) -> str:
    """A switch: when, and which axis or thruster."""
    if component < 0:
        return f"{time:.4f} s"
    of_torque = optimum.problem.norm.limits_torque
    which = "xyz"[component] if of_torque else f"thruster {component + 1}"
    return f"{time:.4f} s ({which})"


def terminal_words(optimum: Optimum) -> str:
    """The terminal condition in words."""
    terminal = optimum.problem.terminal
    if terminal.is_exact:
        return "exactly at rest at the target"
    return f"|bv| <= {float(terminal.attitude):g}, |w| <= {float(terminal.rate):g} rad/s"


def residuals(optimum: Optimum) -> list[QuantityEntry]:
    """Checks of the answer, recomputed outside the solver."""
    answer = optimum.answer
    if answer.flown is None or answer.switching is None:
        return []
    end = answer.flown.terminal_excess
    upper = (
        (
            "terminal_excess",
            "terminal condition missed by (integrated again)",
            end,
            "rad",
        ),
        ("defect", "states against the independent integration", answer.defect, ""),
        ("optimality_gap", "optimality gap (stationarity and complementarity)", answer.optimality_gap, ""),
        ("mesh_gap", "estimated gain of finer cells", answer.mesh_gap, ""),
        ("pontryagin", "residual of Pontryagin's condition", answer.switching.residual, ""),
    )
    return [
        parts.quantity(name, 0.0, max(0.0, value), unit=unit, label=label, side="upper")
        for name, label, value, unit in upper
    ]


def recheck_words(name: str, optimum: Optimum) -> str:
    """How the bound can be proved anew, in words."""
    assert optimum.bound is not None
    return (
        f"To prove the bound anew: intermit optimum {name} --norm {optimum.key} --certificate FILE, then "
        "intermit recheck FILE, or the stand-alone checker: python -I -S checker.pyz FILE."
    )


def notes(name: str, optimum: Optimum) -> list[str]:
    """Standing, reasons and limits in words."""
    answer = optimum.answer
    said = [f"{answer.standing.value}: solved by the {answer.solver} on {answer.cells} cells."]
    if answer.reason:
        said.append(f"Reason: {answer.reason}. Next step: {answer.next_step}.")
    if optimum.hopeless is not None:
        said.append(f"Limit: {optimum.hopeless.reason}. Next step: {optimum.hopeless.next_step}.")
    if optimum.least_time is not None:
        said.append(least_time_words(optimum.least_time).capitalize() + ".")
    if optimum.least_impulse is not None:
        words = least_impulse_words(optimum.least_impulse)
        said.append(words[0].upper() + words[1:] + ".")
    if optimum.bound is not None:
        said.append(recheck_words(name, optimum))
    if answer.history is not None:
        said.append("The best of the starts: an upper bound on the least peak, local optimality checked.")
    return said


def history_arrays(optimum: Optimum, key: str) -> dict[str, Array]:
    """The history, its states and the switching function on one grid of instants."""
    from ...optim.peak.check.verify_answer import sample_flight

    answer = optimum.answer
    if answer.history is None or answer.switching is None:
        return {}
    history = answer.history
    times, states = sample_flight(optimum.problem, history)
    rate = states[:, 4:]
    return {
        f"{key}.time": times,
        f"{key}.torque": history.torque(times),
        f"{key}.profile": history.window(times),
        f"{key}.quaternion": states[:, :4],
        f"{key}.rate": rate,
        f"{key}.switching": _switching(answer.switching, history, times),
        f"{key}.momentum": np.linalg.norm(rate @ optimum.problem.body.inertia, axis=1),
    }


def _switching(switching: Switching, history: TorqueHistory, times: Array) -> Array:
    """Switching function on the grid, zero outside the windows."""
    flat = switching.sigma.reshape(-1, switching.sigma.shape[-1])
    value = np.stack([np.interp(times, switching.times.ravel(), column) for column in flat.T], axis=1)
    return np.asarray(np.where(history.window(times)[:, None] > 0.0, value, 0.0))
