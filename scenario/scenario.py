"""The loaded scenario: what was asked, as objects of `models`, exact, with its hash and warnings."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from decimal import Decimal
from fractions import Fraction
from pathlib import Path
from typing import Any, final

from ..models.linear import LinearPlant
from ..models.mission import ANGLE_ALLOWANCE, InitialSet, InitialState, Mission, Tolerance, TorqueLimit
from ..models.norms import NORMS
from ..models.rigid_body import ExactMatrix, RigidBody
from ..models.schedule import Schedule
from ..models.uncertainty import Uncertainty
from . import initial, laws, linear, schedules, spacecraft, uncertain
from .document import Document, read_document
from .errors import ScenarioError, quote
from .fingerprint import fingerprint
from .instants import FileClock, number_text, read_clock
from .laws import LawChoice
from .mapping import NAME, toml_text
from .questions import CheckTable, CompareTable, OptimumTable, ReportTable, StudyTable, TuneTable
from .schedules import ScheduleChoice
from .schema import LimitsTable, ScenarioFile, SimulationTable, ToleranceTable
from .validate import validate

DEFAULT_PERIODS = 7
"""Periods that a run covers unless the scenario gives a horizon."""
DEFAULT_WINDOWS = 100
"""Windows after which a run over a long table ends unless the scenario gives a horizon."""


@final
@dataclass(frozen=True, repr=False)
class Scenario:
    """Everything a study needs to know, checked.

    Attributes
    ----------
    path : the file it was read from; `<dict>` in the folder of the call for a mapping
    text : what that file says, TOML
    name, description : the user's words, any text
    spacecraft_name : the user's word for the body
    body : rigid body with its exact inertia
    inertia_tolerance : largest deviation of each entry, kg m^2, exact, or None
    uncertainty : what the controller does not know
    schedule_choice : the schedule, its shape and source
    initial : state at t = 0, as an error from the target attitude
    initial_set : set of states over which claims are made
    laws : the laws, not yet built, in the file's order
    linear : a linear plant through the same windows, or None
    tolerance, simulation, limits, check, optimum, compare, tune, study, report : the tables of those names
    warnings : one line each; nothing in them stops a run
    sha256 : hash of what the scenario says, files it names included
    clock : what the file's own times count from; all times here count from the start of the run
    """

    path: Path
    text: str
    name: str
    description: str
    spacecraft_name: str
    body: RigidBody
    inertia_tolerance: ExactMatrix | None
    uncertainty: Uncertainty
    schedule_choice: ScheduleChoice
    initial: InitialState
    initial_set: InitialSet
    laws: tuple[LawChoice, ...]
    linear: LinearPlant | None
    tolerance: ToleranceTable
    simulation: SimulationTable
    limits: LimitsTable | None
    check: CheckTable
    optimum: OptimumTable
    compare: CompareTable
    tune: TuneTable
    study: StudyTable
    report: ReportTable
    warnings: tuple[str, ...]
    sha256: str
    clock: FileClock

    def __repr__(self) -> str:
        laws = ", ".join(choice.label for choice in self.laws) or "no law"
        return f"<Scenario {self.name} ({self.path.name}): {laws}; [0, {float(self.horizon):g}] s>"

    @property
    def schedule(self) -> Schedule:
        """The exact thruster schedule."""
        return self.schedule_choice.schedule

    @property
    def horizon(self) -> Fraction:
        """End of a run, s: as given, else seven periods, or the table's end (its 100th window at most)."""
        if self.simulation.horizon is not None:
            return self.simulation.horizon
        schedule = self.schedule
        if len(schedule.windows) > DEFAULT_WINDOWS:
            return schedule.windows[DEFAULT_WINDOWS - 1].off
        if schedule.period is None:
            return schedule.end
        return schedule.period * (DEFAULT_PERIODS if len(schedule.windows) == 1 else 1)

    @property
    def mission(self) -> Mission:
        """What proofs, optima and simulations are asked about, whatever the law."""
        limits = self.limits
        return Mission(
            body=self.body,
            schedule=self.schedule,
            start=self.initial,
            starts=self.initial_set,
            horizon=self.horizon,
            tolerance=Tolerance(self.tolerance.attitude, self.tolerance.rate),
            limit=None if limits is None else TorqueLimit(limits.torque, NORMS[limits.norm]),
            inertia_tolerance=self.inertia_tolerance,
            uncertainty=self.uncertainty,
        )

    def law(self, label: str) -> LawChoice:
        """Return the law of that label.

        Raises
        ------
        ScenarioError
            If there is none.
        """
        for choice in self.laws:
            if choice.label == label:
                return choice
        known = ", ".join(quote(choice.label) for choice in self.laws) or "none"
        raise ScenarioError(self.path.name, f"has no law labelled {quote(label)} (it has {known})")


def load_scenario(source: str | Path | Mapping[str, Any]) -> Scenario:
    """Read, check and build a scenario: a TOML file, or a mapping with the same tables and keys.

    Files that a mapping names lie relative to the current folder.

    Raises
    ------
    ScenarioError
        One line that names the file and the key or CSV line, for anything wrong with the input.
    """
    if isinstance(source, Mapping):
        document = read_document(Path.cwd() / NAME, toml_text(source))
    else:
        document = read_document(Path(source))
    document, clock, warnings = read_clock(document)
    return build_scenario(validate(document), document, clock, warnings)


def build_scenario(
    file: ScenarioFile, document: Document, clock: FileClock | None = None, told: tuple[str, ...] = ()
) -> Scenario:
    """Build a scenario from its typed file and its clock; by default it runs from 0 s on."""
    said, clock = file, clock if clock is not None else FileClock()
    file = _from_start(file, document, clock)
    body, tolerance, warnings = spacecraft.build(file.spacecraft, document)
    schedule_choice = schedules.build(file.schedule, document, clock)
    _require_reach(file, schedule_choice.schedule, document)
    at_once = schedule_choice.schedule.profile.shapes[0]
    starts_in_window = bool(at_once and at_once[0])
    state, bounds = initial.build(file, document, body, starts_in_window=starts_in_window)
    choices = laws.build(file, document)
    warnings += told + schedule_choice.warnings + initial.doubtful_readings(file, document)
    if bounds.max_angle_deg > 180 + ANGLE_ALLOWANCE:
        warnings += (
            f"{document.where('initial' if bounds.from_state else 'initial_set')}: error angle up to "
            f"{float(bounds.max_angle_deg):.6g} deg (2 acos b0): the laws unwind it the long way; "
            "the other sign of the quaternion is the same attitude and turns the short way",
        )
    scenario = Scenario(
        path=document.path,
        text=document.text,
        name=file.name or document.path.stem,
        description=file.description,
        spacecraft_name=file.spacecraft.name,
        body=body,
        inertia_tolerance=tolerance,
        uncertainty=uncertain.build(file, document, body),
        schedule_choice=schedule_choice,
        initial=state,
        initial_set=bounds,
        laws=choices,
        linear=linear.build(file.linear, schedule_choice.schedule, document),
        tolerance=file.tolerance,
        simulation=file.simulation,
        limits=file.limits,
        check=file.check,
        optimum=file.optimum,
        compare=file.compare,
        tune=file.tune,
        study=file.study,
        report=_report(file.report, document, choices),
        warnings=warnings,
        sha256=fingerprint(said, _attachments(file, document, choices)),
        clock=clock,
    )
    _require_turns(scenario, document)
    return scenario


def _from_start(file: ScenarioFile, document: Document, clock: FileClock) -> ScenarioFile:
    """Return the file with the ends of its run and of its transfer counted from the start of the run.

    Raises
    ------
    ScenarioError
        Naming an end that does not come after the start.
    """

    def counted(key: str, end: Fraction | None) -> Fraction | None:
        if end is not None and end <= clock.start:
            late = "0"
            if clock.start_is_given:
                late = f"{number_text(clock.start)} s, when the run starts (initial.time)"
            raise ScenarioError(document.where(key), f"must be > {late}, received {number_text(end)}")
        return None if end is None else end - clock.start

    horizon = counted("simulation.horizon", file.simulation.horizon)
    final = counted("optimum.final_time", file.optimum.final_time)
    changes: dict[str, Any] = {}
    if horizon is not None:
        changes["simulation"] = file.simulation.model_copy(update={"horizon": horizon})
    if final is not None:
        changes["optimum"] = file.optimum.model_copy(update={"final_time": final})
    return file.model_copy(update=changes)


MAX_IDLE = Fraction(10**8)
"""Seconds (three years) that a run may go on after a table's end, where nothing acts any more."""
MAX_OUTPUTS = 10**7
"""Instants at which a run's histories are written, at most."""


MAX_TURNS = 8000
"""Turns of a run at its start rate: each costs some 200 right-hand sides, about 2 ms."""


def _require_turns(scenario: Scenario, document: Document) -> None:
    """Refuse a spin whose turns within the horizon no run can follow.

    Raises
    ------
    ScenarioError
        Naming the start rate.
    """
    rate = max(abs(x) for x in scenario.initial.exact_rate)
    turns = rate * scenario.horizon / Fraction(44, 7)
    if turns > MAX_TURNS:
        raise ScenarioError(
            document.where("initial.rate"),
            f"{float(rate):g} rad/s for {float(scenario.horizon):g} s (simulation.horizon) is "
            f"{Decimal(int(turns)):.3g} turns: at most {MAX_TURNS} can be followed; give a smaller rate "
            "(rad/s) or a shorter horizon",
        )


def _require_reach(file: ScenarioFile, schedule: Schedule, document: Document) -> None:
    """Refuse a run whose size no machine has, with the number that is too large.

    Raises
    ------
    ScenarioError
        Naming the horizon or the output step.
    """
    horizon, step = file.simulation.horizon, file.simulation.output_step
    if horizon is None:
        return
    where = document.where("simulation.horizon")
    windows = schedule.windows_before(horizon)
    if windows > schedules.MAX_COUNT:
        raise ScenarioError(
            where,
            f"{float(horizon):g} s holds {Decimal(windows):.3g} windows: at most {schedules.MAX_COUNT} fit",
        )
    if schedule.period is None and horizon - schedule.end > MAX_IDLE:
        raise ScenarioError(
            where,
            f"{float(horizon):g} s goes on for more than {float(MAX_IDLE):g} s after the table's end "
            f"({float(schedule.end):g} s), where nothing acts: give an earlier end",
        )
    shown = horizon - schedule.idle_lead
    if step is not None and shown / step > MAX_OUTPUTS:
        raise ScenarioError(
            document.where("simulation.output_step"),
            f"{float(step):g} s asks for {Decimal(int(shown / step)):.3g} instants: at most {MAX_OUTPUTS}",
        )


def _report(report: ReportTable, document: Document, choices: tuple[LawChoice, ...]) -> ReportTable:
    """Hold the front's laws against the laws; a file that gives other laws than the [report] it inherits
    keeps those of the front that it still has.

    Raises
    ------
    ScenarioError
        If the file that holds [report] names a law that it does not have.
    """
    labels = [choice.label for choice in choices]
    kept = tuple(label for label in report.front_laws if label in labels)
    if kept == report.front_laws:
        return report
    if document.origin("report") in (document.path, document.origin("law")):
        missing = next(label for label in report.front_laws if label not in labels)
        known = ", ".join(map(quote, labels)) or "none"
        raise ScenarioError(
            document.where("report.front_laws"), f"has no law labelled {quote(missing)} (it has {known})"
        )
    return report.model_copy(update={"front_laws": kept, "front": report.front if kept else ()})


def _attachments(file: ScenarioFile, document: Document, choices: tuple[LawChoice, ...]) -> dict[str, Path]:
    """Files whose content is part of what the scenario says."""
    folder = document.origin("schedule").parent
    names = [file.schedule.csv, file.schedule.thrust.csv if file.schedule.thrust else None]
    found = {f"schedule: {Path(name).name}": folder / name for name in names if name is not None}
    for choice in choices:
        if choice.file is not None and choice.file.is_file():
            found[f"law {choice.label}: {choice.file.name}"] = choice.file
    return found
