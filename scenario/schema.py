"""What a scenario file may say: every table, key, unit and default. Unknown keys are refused.

Numbers are exact (`exact.py`): what the user wrote as a decimal is kept as that fraction. Units
are SI; angles are in degrees where the key says `_deg`.
"""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

from pydantic import ConfigDict, Field, StrictBool, field_validator

from ..models.norms import NormWord
from .errors import quote
from .exact import Count, Exact, Matrix, NotNegative, Positive, PositiveSine, Text, Vector, exact
from .questions import CheckTable, CompareTable, OptimumTable, ReportTable, StudyTable, TuneTable
from .table import Table

ShapeName = Literal["hermite", "hermite-as-printed", "ramps"]


class ProductsTable(Table):
    """[spacecraft.inertia_products]: the integrals of x y, x z and y z over the mass, kg m^2."""

    xy: Exact
    xz: Exact
    yz: Exact


class SpacecraftTable(Table):
    """[spacecraft]: the inertia, kg m^2, body frame; `inertia_tolerance`: every entry known to +- this.

    `inertia` is the matrix J, J12 = -integral of x y. Or: `inertia_moments` (its diagonal) with
    `inertia_products`, integrals of the other sign, as many programs print them.
    """

    name: Text = ""
    inertia: Matrix | None = None
    inertia_moments: Vector | None = None
    inertia_products: ProductsTable | None = None
    inertia_tolerance: Any = None

    @field_validator("inertia", mode="before")
    @classmethod
    def _rows(cls, value: Any) -> Any:
        shaped = isinstance(value, list) and all(isinstance(row, list) and len(row) == 3 for row in value)
        if not shaped or len(value) != 3:
            raise ValueError(
                "expected three rows of three numbers, [[3, 0, 0], [0, 2.5, 0], [0, 0, 2]] for instance "
                f"(or inertia_moments with inertia_products), received {quote(value)}"
            )
        return value

    @field_validator("inertia_tolerance")
    @classmethod
    def _exact_tolerance(cls, value: Any) -> Any:
        return [cls._exact_tolerance(x) for x in value] if isinstance(value, list) else exact(value)


class ThrustTable(Table):
    """[schedule.thrust]: measured samples, time (s) and thrust (any unit, the same throughout).

    g = thrust / full_thrust (by default the largest sample), and 0 where that is below `zero_below`.
    """

    csv: Text
    full_thrust: Positive | None = None
    zero_below: NotNegative


class ScheduleTable(Table):
    """[schedule]: exactly one of `windows`, `csv`, `on` with `on_time`, `thrust`; times in s.

    `epoch` is the date that counts as 0 s where times are ISO 8601 dates.

    `period` repeats the table for ever; without it a table or CSV is finite. `on`, `on_time` and
    `period` describe one window a period, endless unless `count` ends it.
    """

    epoch: Text | None = None
    windows: tuple[tuple[Exact, Exact], ...] | None = None
    csv: Text | None = None
    on: Exact | None = None
    on_time: Positive | None = None
    count: Count | None = None
    thrust: ThrustTable | None = None
    period: Positive | None = None
    shape: ShapeName | None = None
    ramp_up: Positive | None = None
    ramp_down: Positive | None = None
    thruster_rise: NotNegative = Fraction(0)
    thruster_fall: NotNegative = Fraction(0)


class UncertaintyTable(Table):
    """[uncertainty]: what the controller does not know; it uses [spacecraft]'s inertia and the g given.

    `inertia_tolerance`: every entry of the body's inertia is known to +- this, kg m^2. `inertia_relative`:
    (1 - rho) J0 <= J <= (1 + rho) J0 as quadratic forms. `inertia_scale`, `thrust_error`: common factors
    1 + e of the inertia and 1 + d of the torque, each [low, high], or a number for both sides.
    `thrust_error_varies`: "never", or "per-firing". `misalignment_deg`: a fixed turn of the torque, at most.
    `disturbance`: a torque of any course, N m, Euclidean, at most.
    """

    inertia_tolerance: Any = None
    inertia_relative: NotNegative = Fraction(0)
    inertia_scale: Any = Fraction(0)
    thrust_error: Any = Fraction(0)
    thrust_error_varies: Literal["never", "per-firing"] = "per-firing"
    misalignment_deg: NotNegative = Fraction(0)
    disturbance: NotNegative = Fraction(0)

    @field_validator("inertia_tolerance", "inertia_scale", "thrust_error")
    @classmethod
    def _exact_numbers(cls, value: Any) -> Any:
        return [cls._exact_numbers(x) for x in value] if isinstance(value, list) else exact(value)


class AttitudeTable(Table):
    """[target]: an attitude, as `quaternion` (scalar first) or as `axis` and `angle_deg`."""

    quaternion: tuple[Exact, Exact, Exact, Exact] | None = None
    axis: Vector | None = None
    angle_deg: Exact | None = None


class InitialTable(AttitudeTable):
    """[initial]: when the run starts, s; an attitude and the body rate then, rad/s, body frame."""

    time: Exact | None = None
    rate: Vector = (Fraction(0), Fraction(0), Fraction(0))


class InitialSetTable(Table):
    """[initial_set]: largest error angle 2 acos b0, deg, and largest rate.

    `max_rate` bounds |w|, rad/s; `max_weighted_rate` bounds sqrt(Omega' J Omega), sqrt(kg m^2)/s.
    """

    max_angle_deg: NotNegative
    max_rate: NotNegative | None = None
    max_weighted_rate: NotNegative | None = None

    @field_validator("max_angle_deg")
    @classmethod
    def _below_full_turn(cls, value: Fraction) -> Fraction:
        if value >= 360:
            raise ValueError(f"must be < 360 (the error angle is 2 acos b0), received {float(value):g}")
        return value


class LawTable(Table):
    """[[law]]: a law's `type`, its parameters, and the `label` that tables and figures show.

    Which parameters there are, and what they may be, the law itself says (`Law.described`).
    """

    model_config = ConfigDict(frozen=True, extra="allow", arbitrary_types_allowed=True)
    __pydantic_extra__: dict[str, Exact] = Field(init=False)

    type: Text
    label: Text | None = None
    file: Text | None = None
    class_: Text | None = Field(default=None, alias="class")
    parameters: dict[str, Exact] | None = None


class LawDefaultsTable(Table):
    """[law_defaults]: parameters that every law which has them takes unless it states its own."""

    model_config = ConfigDict(frozen=True, extra="allow", arbitrary_types_allowed=True)
    __pydantic_extra__: dict[str, Exact] = Field(init=False)


class LinearTable(Table):
    """[linear]: a linear plant x' = (A - g(t) B K) x through the windows; A (n, n), B (n, m), K (m, n)."""

    A: tuple[tuple[Exact, ...], ...]
    B: tuple[tuple[Exact, ...], ...]
    K: tuple[tuple[Exact, ...], ...]


class ToleranceTable(Table):
    """[tolerance]: settled means |bv| <= `attitude` and |w| <= `rate` (rad/s), Euclidean, for good."""

    attitude: PositiveSine = Fraction(1, 100)
    rate: Positive = Fraction(1, 100)


class SimulationTable(Table):
    """[simulation]: `horizon` and `output_step` of the histories, s; `saturate` at the torque limit."""

    horizon: Exact | None = None
    output_step: Positive | None = None
    saturate: StrictBool = False


class LimitsTable(Table):
    """[limits]: `torque`, N m, that the applied torque must not exceed in the given `norm`."""

    torque: Positive
    norm: NormWord = "component"


class ScenarioFile(Table):
    """The whole file."""

    name: Text = ""
    description: Text = ""
    spacecraft: SpacecraftTable
    schedule: ScheduleTable
    initial: InitialTable | None = None
    initial_set: InitialSetTable | None = None
    target: AttitudeTable = AttitudeTable(quaternion=(Fraction(1), Fraction(0), Fraction(0), Fraction(0)))
    law: tuple[LawTable, ...] = ()
    law_defaults: LawDefaultsTable = LawDefaultsTable()
    linear: LinearTable | None = None
    tolerance: ToleranceTable = ToleranceTable()
    simulation: SimulationTable = SimulationTable()
    limits: LimitsTable | None = None
    uncertainty: UncertaintyTable = UncertaintyTable()
    check: CheckTable = CheckTable()
    optimum: OptimumTable = OptimumTable()
    compare: CompareTable = CompareTable()
    tune: TuneTable = TuneTable()
    study: StudyTable = StudyTable()
    report: ReportTable = ReportTable()

    @field_validator("law", mode="before")
    @classmethod
    def _one_law_or_many(cls, value: Any) -> Any:
        return [value] if isinstance(value, dict) else value
