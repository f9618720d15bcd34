"""The laws: parameters, claims, simulated runs, certified bounds over time, samples of V'."""

from __future__ import annotations

from typing import Annotated, Literal

from .base import ArrayOf, Flag, Integer, Part
from .claims import ClaimEntry, QuantityEntry, WitnessEntry

RunRole = Literal[
    "quaternion", "rate", "command", "torque", "gain", "error_rate",
    "storage", "storage_bound", "storage_rate", "storage_rate_bound",
]  # fmt: skip
"""Histories that a run may have."""
BoundRole = Literal["filter_floor", "angle_bound", "rate_bound", "speed_bound", "torque_bound"]
"""Bounds over time that a certificate may have."""


class EffortEntry(Part):
    """Work, counted and never timed."""

    label: str
    count: Integer


class RunArrays(Part):
    """Names of a run's histories; `controller` maps each controller state to its array."""

    time: Annotated[str, ArrayOf("s")]
    quaternion: Annotated[str | None, ArrayOf("", "(n, 4)")] = None
    rate: Annotated[str | None, ArrayOf("rad/s", "(n, 3)")] = None
    controller: Annotated[dict[str, str] | None, ArrayOf("the law's own")] = None
    command: Annotated[str | None, ArrayOf("N m", "(n, 3)")] = None
    torque: Annotated[str | None, ArrayOf("N m", "(n, 3)")] = None
    gain: Annotated[str | None, ArrayOf()] = None
    error_rate: Annotated[str | None, ArrayOf("rad/s", "(n, 3)")] = None
    storage: Annotated[str | None, ArrayOf("kg m^2/s")] = None
    storage_bound: Annotated[str | None, ArrayOf("kg m^2/s")] = None
    storage_rate: Annotated[str | None, ArrayOf("kg m^2/s^2")] = None
    storage_rate_bound: Annotated[str | None, ArrayOf("kg m^2/s^2")] = None

    def name_of(self, role: RunRole) -> str | None:
        """Name of the array in a role, if the run has it."""
        name: str | None = getattr(self, role)
        return name


class RunEntry(Part):
    """One simulated run."""

    key: str
    label: str
    metrics: tuple[QuantityEntry, ...]
    arrays: RunArrays
    saturated: Flag = False
    effort: tuple[EffortEntry, ...] = ()
    notes: tuple[str, ...] = ()


class BoundArrays(Part):
    """Names of certified bounds over time; each value holds from its time to the next."""

    time: Annotated[str, ArrayOf("s")]
    filter_floor: Annotated[str | None, ArrayOf("s")] = None
    angle_bound: Annotated[str | None, ArrayOf("rad")] = None
    rate_bound: Annotated[str | None, ArrayOf("kg^1/2 m rad/s")] = None
    speed_bound: Annotated[str | None, ArrayOf("rad/s")] = None
    torque_bound: Annotated[str | None, ArrayOf("N m")] = None

    def name_of(self, role: BoundRole) -> str | None:
        """Name of the array of a bound, if the certificate has it."""
        name: str | None = getattr(self, role)
        return name


class CertificateEntry(Part):
    """Certified bounds over the horizon."""

    key: str
    label: str
    quantities: tuple[QuantityEntry, ...]
    claim: str = ""
    arrays: BoundArrays | None = None
    recheck: str = ""
    notes: tuple[str, ...] = ()


class EquationEntry(Part):
    """An equation that a law states of itself, in Typst's and in LaTeX's notation."""

    title: str
    typst: str
    latex: str


class CaseEntry(Part):
    """One law of the scenario."""

    key: str
    label: str
    law: str
    parameters: tuple[QuantityEntry, ...] = ()
    equations: tuple[EquationEntry, ...] = ()
    claims: tuple[ClaimEntry, ...] = ()
    runs: tuple[RunEntry, ...] = ()
    certificates: tuple[CertificateEntry, ...] = ()
    notes: tuple[str, ...] = ()


class HistogramEntry(Part):
    """How sampled margins spread: (m + 1,) edges and (m,) counts."""

    edges: Annotated[str, ArrayOf("", "(m + 1,)")]
    counts: Annotated[str, ArrayOf("", "(m,)")]
    label: str = "margin"
    unit: str = ""


class SamplesEntry(Part):
    """Sampled margins of one law: evidence, never a proof."""

    key: str
    label: str
    count: Integer
    case: str = ""
    seed: Integer | None = None
    coverage: str | None = None
    statement: str | None = None
    histogram: HistogramEntry | None = None
    worst: WitnessEntry | None = None
    margins: tuple[QuantityEntry, ...] = ()
