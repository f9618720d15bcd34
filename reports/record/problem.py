"""What was asked: the scenario and its schedule."""

from __future__ import annotations

from typing import Annotated, Literal

from .base import ArrayOf, Number, Part, Unit
from .claims import ClaimEntry, QuantityEntry

Row = tuple[Number, Number, Number]


class FactEntry(Part):
    """A fact of the scenario: a text, a quantity, or a matrix with its unit."""

    label: str
    text: str | None = None
    quantity: QuantityEntry | None = None
    matrix: tuple[tuple[Number, ...], ...] | None = None
    unit: str | None = None


class TolerancesEntry(Part):
    """What counts as settled."""

    attitude: Annotated[Number, Unit("")]
    rate: Annotated[Number, Unit("rad/s")]


class ScenarioEntry(Part):
    """The scenario in facts."""

    name: str
    description: str = ""
    facts: tuple[FactEntry, ...] = ()
    inertia: Annotated[tuple[Row, Row, Row] | None, Unit("kg m^2")] = None
    horizon: Annotated[Number | None, Unit("s")] = None
    tolerances: TolerancesEntry | None = None
    notes: tuple[str, ...] = ()


class ScheduleArrays(Part):
    """Names of the schedule's arrays."""

    time: Annotated[str, ArrayOf("s")]
    gain: Annotated[str, ArrayOf()]
    gain_rate: Annotated[str | None, ArrayOf("1/s")] = None


class ScheduleEntry(Part):
    """Windows over the horizon, g on a fine grid of it, and the claims about the schedule."""

    windows: Annotated[tuple[tuple[Number, Number], ...], Unit("s")]
    arrays: ScheduleArrays
    extends: Literal["periodic", "finite"] | None = None
    claims: tuple[ClaimEntry, ...] = ()
    notes: tuple[str, ...] = ()
