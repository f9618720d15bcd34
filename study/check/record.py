"""What a check found, as the sections and arrays of a record."""

from __future__ import annotations

from fractions import Fraction

import numpy as np

from ...models.schedule import Schedule
from ...models.types import Array
from ...reports import parts
from ...reports.provenance import provenance
from ...reports.record import Record
from ...reports.record.base import unit_of
from ...reports.record.claims import QuantityEntry
from ...reports.record.document import Outcome, Provenance, Sections
from ...reports.record.problem import FactEntry, ScenarioEntry, ScheduleArrays, ScheduleEntry, TolerancesEntry
from ...reports.record.runs import (
    BoundArrays,
    BoundRole,
    CaseEntry,
    CertificateEntry,
    EffortEntry,
    EquationEntry,
    HistogramEntry,
    RunEntry,
    SamplesEntry,
)
from ...scenario import LawChoice, Scenario
from ...scenario.laws import law_class
from ...verify.filter.over_time import BoundsOverTime
from ...verify.sampling import SampledDerivative
from ..claims.entries import claim_entries, quantity_entry, witness_entry
from ..histories import output_times
from ..simulated_run import run_entry
from .case import Case
from .result import CheckStudy
from .storage_history import storage_history

SHOWN_WINDOWS = 2000
"""Windows that a record lists; of a longer table the first ones, with a note."""


def check_record(study: CheckStudy, *, date: str = "", author: str = "", command: str = "") -> Record:
    """The record of one check, with its scenario's text and everything that decides a number."""
    sections, arrays = check_sections(study)
    return Record.create(
        title=f"Check of {study.scenario.name}",
        provenance=check_provenance(study, date=date, author=author, command=command),
        sections=sections,
        arrays=arrays,
        outcome=Outcome(exit_code=study.exit_code, sentence=study.sentence),
    )


def check_provenance(study: CheckStudy, *, date: str = "", author: str = "", command: str = "") -> Provenance:
    """Scenario, versions, seeds, options and counted effort."""
    scenario = study.scenario
    effort = [
        EffortEntry(
            label=f"right-hand sides, {case.choice.label}", count=int(case.run.trajectory.evaluations)
        )
        for case in study.cases
        if case.run is not None and case.run.trajectory is not None
    ]
    effort += [
        EffortEntry(
            label=f"gradient evaluations, {case.choice.label}",
            count=case.findings.samples.samples.search_evaluations,
        )
        for case in study.cases
        if case.findings.samples is not None
    ]
    found = provenance(
        scenario_name=scenario.name,
        scenario_text=scenario.text,
        date=date,
        author=author,
        command=command or f"intermit check {scenario.path.name}",
        seeds={"derivative samples": scenario.check.seed},
        options={"samples": scenario.check.samples, "claims": list(scenario.check.claims or ())},
        effort=effort,
    )
    return found.but(input_sha256=scenario.sha256)


def check_sections(study: CheckStudy) -> tuple[Sections, dict[str, Array]]:
    """Sections `scenario`, `schedule`, `cases` and `samples`, and the arrays they name."""
    arrays: dict[str, Array] = {}
    cases: list[CaseEntry] = []
    samples: list[SamplesEntry] = []
    for number, case in enumerate(study.cases, start=1):
        entry, held = case_entry(study.scenario, case, f"law{number}")
        cases.append(entry)
        arrays |= held
        if case.findings.samples is not None:
            sampled, held = samples_entry(case.findings.samples, case.choice.label, f"law{number}")
            samples.append(sampled)
            arrays |= held
    schedule, held = schedule_entry(study)
    sections = Sections(
        scenario=scenario_entry(study.scenario),
        schedule=schedule,
        cases=tuple(cases),
        samples=tuple(samples),
    )
    return sections, arrays | held


def scenario_entry(scenario: Scenario) -> ScenarioEntry:
    """What was asked, in facts."""
    state, bounds = scenario.initial, scenario.initial_set
    tolerance = scenario.tolerance
    facts = [
        FactEntry(
            label="inertia", matrix=scenario.body.inertia.tolist(), unit=unit_of(ScenarioEntry, "inertia")
        ),
        _fact("initial error angle", parts.quantity("angle", float(f"{state.angle_deg:.10g}"), unit="deg")),
        _fact("initial rate", text=f"({', '.join(f'{float(x):g}' for x in state.exact_rate)}) rad/s"),
        _fact("largest error angle of the set", _exact("max_angle", bounds.max_angle_deg, "deg")),
    ]
    if bounds.max_rate is not None:
        facts.append(_fact("largest rate of the set", _exact("max_rate", bounds.max_rate, "rad/s")))
    if bounds.max_weighted_rate is not None:
        quantity = _exact("max_weighted_rate", bounds.max_weighted_rate, unit_of(BoundArrays, "rate_bound"))
        facts.append(_fact("largest sqrt(Omega' J Omega) of the set", quantity))
    settled = f"|bv| <= {float(tolerance.attitude):g} and |w| <= {float(tolerance.rate):g} rad/s, for good"
    facts.append(_fact("settled means", text=settled))
    if scenario.clock.words:
        facts.append(_fact("clock", text=scenario.clock.words))
    facts.append(_fact("runs end at", _exact("horizon", scenario.horizon, "s")))
    if scenario.limits is not None:
        quantity = _exact("torque_limit", scenario.limits.torque, "N m")
        facts.append(_fact(f"torque limit ({scenario.limits.norm})", quantity))
    if scenario.spacecraft_name:
        facts.insert(0, _fact("spacecraft", text=scenario.spacecraft_name))
    return ScenarioEntry(
        name=scenario.name,
        description=scenario.description,
        facts=tuple(facts),
        inertia=scenario.body.inertia.tolist(),
        horizon=float(scenario.horizon),
        tolerances=TolerancesEntry(attitude=float(tolerance.attitude), rate=float(tolerance.rate)),
        notes=tuple(scenario.warnings),
    )


def schedule_entry(study: CheckStudy) -> tuple[ScheduleEntry, dict[str, Array]]:
    """Windows over the horizon, g on a fine grid of it, and the claims about the schedule."""
    scenario, schedule = study.scenario, study.scenario.schedule
    windows = list(schedule.windows_between(Fraction(0), scenario.horizon))
    times = gain_times(schedule, scenario.horizon)
    arrays = {
        "schedule.time": times,
        "schedule.gain": schedule.gain(times),
        "schedule.gain_rate": schedule.gain_rate(times),
    }
    notes = [f"Source: {scenario.schedule_choice.source}."]
    if len(windows) > SHOWN_WINDOWS:
        notes.append(f"The first {SHOWN_WINDOWS} of {len(windows)} windows are listed.")
    entry = ScheduleEntry(
        extends="periodic" if schedule.is_periodic else "finite",
        windows=tuple((float(w.on), float(w.off)) for w in windows[:SHOWN_WINDOWS]),
        arrays=ScheduleArrays(time="schedule.time", gain="schedule.gain", gain_rate="schedule.gain_rate"),
        claims=claim_entries(study.claims, recheck=f"intermit check {scenario.path.name}"),
        notes=tuple(notes),
    )
    return entry, arrays


def gain_times(schedule: Schedule, horizon: Fraction, per_piece: int = 24) -> Array:
    """Knots up to the horizon, and points between them where g is not constant, s."""
    times: list[float] = [0.0]
    for count, piece in enumerate(schedule.pieces_between(Fraction(0), horizon)):
        if count > 20 * SHOWN_WINDOWS:
            break
        start, end = float(piece.start), min(float(piece.end), float(horizon))
        points = per_piece if len(piece.shape) > 1 else 1
        times.extend((start + (end - start) * np.arange(1, points + 1) / points).tolist())
    return np.unique(np.clip(times, 0.0, float(horizon)))


def case_entry(scenario: Scenario, case: Case, key: str) -> tuple[CaseEntry, dict[str, Array]]:
    """One law: parameters, claims and its run."""
    runs: list[RunEntry] = []
    arrays: dict[str, Array] = {}
    notes = list(case.findings.notes)
    if case.run is not None and case.run.trajectory is not None:
        derivative = next((claim for claim in case.claims if claim.key == "lyapunov.derivative"), None)
        history = storage_history(
            case.run.trajectory,
            output_times(scenario, case.run.origin),
            case.findings.reference_floor,
            derivative,
        )
        entry, arrays = run_entry(scenario, case.run, f"{key}.run", case.choice.label, history)
        runs.append(entry)
    elif case.run is not None:
        notes.append(case.run.failure)
    certificates: list[CertificateEntry] = []
    curves = case.findings.curves
    if curves is not None:
        name = f"{key}.certified"
        found, bounds = certificate_entry(scenario, case, curves, name)
        certificates.append(found)
        arrays |= bounds
    return CaseEntry(
        key=key,
        label=case.choice.label,
        law=case.choice.type,
        parameters=parameter_entries(case.choice),
        equations=equation_entries(case.choice),
        claims=claim_entries(case.claims, recheck=f"intermit check {scenario.path.name}"),
        runs=tuple(runs),
        certificates=tuple(certificates),
        notes=tuple(notes),
    ), arrays


def certificate_entry(
    scenario: Scenario, case: Case, curves: BoundsOverTime, key: str
) -> tuple[CertificateEntry, dict[str, Array]]:
    """Certified bounds over time; one that is not finite everywhere is left out."""
    arrays = {f"{key}.{role}": v for role, v in vars(curves).items() if np.all(np.isfinite(v))}

    def held(role: BoundRole) -> str | None:
        return f"{key}.{role}" if f"{key}.{role}" in arrays else None

    claims = {claim.key: claim for claim in case.claims}
    proved = claims.get("filter.floor", claims["convergence"])
    entry = CertificateEntry(
        key=key,
        label=f"certified bounds, {case.choice.label}",
        claim=proved.statement,
        quantities=tuple(quantity_entry(q) for q in proved.quantities),
        arrays=BoundArrays(
            time=f"{key}.time",
            filter_floor=held("filter_floor"),
            angle_bound=held("angle_bound"),
            rate_bound=held("rate_bound"),
            speed_bound=held("speed_bound"),
            torque_bound=held("torque_bound"),
        ),
        recheck=f"intermit check {scenario.path.name}",
        notes=("Each value holds from its time to the next.",),
    )
    return entry, arrays


def parameter_entries(choice: LawChoice) -> tuple[QuantityEntry, ...]:
    """Parameters of a law as exact quantities, with the units that the law states."""
    known = choice.described()
    units = {name: known[name].unit for name, _ in choice.parameters if name in known}
    return tuple(_exact(name, value, units.get(name, "")) for name, value in choice.parameters)


def equation_entries(choice: LawChoice) -> tuple[EquationEntry, ...]:
    """Equations that the law states of itself, for the report to set."""
    stated = law_class(choice).equations
    return tuple(EquationEntry(title=e.title, typst=e.typst, latex=e.latex) for e in stated)


def samples_entry(sampled: SampledDerivative, label: str, case: str) -> tuple[SamplesEntry, dict[str, Array]]:
    """The sampled derivative of V: its count, domain, worst state and histogram."""
    samples = sampled.samples
    key = f"{case}.samples"
    arrays = {f"{key}.edges": samples.edges, f"{key}.counts": samples.counts}
    least = parts.figure_of(
        "least_sampled", samples.sampled_worst, digits=4, unit="1/s", label="least -V'/W sampled"
    )
    entry = SamplesEntry(
        key=key,
        label=f"-V'/W, {label}",
        case=case,
        count=samples.sampling.count,
        seed=samples.sampling.seed,
        coverage=samples.domain.describe(),
        statement=sampled.sign.summary,
        histogram=HistogramEntry(
            edges=f"{key}.edges",
            counts=f"{key}.counts",
            label="-V'/W (the end bins hold what lies beyond)",
            unit="1/s",
        ),
        worst=None if sampled.sign_witness is None else witness_entry(sampled.sign_witness),
        margins=(least,),
    )
    return entry, arrays


def _exact(name: str, value: Fraction, unit: str) -> QuantityEntry:
    return parts.quantity(name, float(value), unit=unit)


def _fact(label: str, quantity: QuantityEntry | None = None, *, text: str | None = None) -> FactEntry:
    return FactEntry(label=label, quantity=quantity, text=text)
