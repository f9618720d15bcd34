"""The least peak any controller could do with: value, certified bound, checks and history."""

from __future__ import annotations

from typing import Annotated, Literal

from pydantic import Field

from .base import ArrayOf, Integer, Number, Part, Unit
from .claims import QuantityEntry
from .runs import EffortEntry

OptimumRole = Literal["quaternion", "rate", "torque", "switching", "profile", "momentum"]
"""Histories that an optimum may have."""


class OptimumArrays(Part):
    """Names of the histories of one optimum."""

    time: Annotated[str, ArrayOf("s")]
    quaternion: Annotated[str | None, ArrayOf("", "(n, 4)")] = None
    rate: Annotated[str | None, ArrayOf("rad/s", "(n, 3)")] = None
    torque: Annotated[str | None, ArrayOf("N m", "(n, 3)")] = None
    switching: Annotated[str | None, ArrayOf("", "(n,) or (n, m)")] = None
    profile: Annotated[str | None, ArrayOf()] = None
    momentum: Annotated[str | None, ArrayOf("N m s")] = None

    def name_of(self, role: OptimumRole) -> str | None:
        """Name of the array in a role, if the optimum has it."""
        name: str | None = getattr(self, role)
        return name


class LocalOptima(Part):
    """Distinct local optima of all starts."""

    starts: Integer
    values: tuple[Number, ...]
    unit: str = ""
    spread: QuantityEntry | None = None


class OptimumEntry(Part):
    """One least peak."""

    key: str
    label: str
    norm: Annotated[str, Field(description="its key: component, euclidean or thrusters")]
    value: QuantityEntry
    profile: str = ""
    terminal: str = ""
    final_time: QuantityEntry | None = None
    bound: QuantityEntry | None = None
    bound_name: str | None = None
    other_bounds: tuple[QuantityEntry, ...] | None = None
    gap: QuantityEntry | None = None
    arrays: OptimumArrays | None = None
    switch_times: Annotated[tuple[Number, ...] | None, Unit("s")] = None
    residuals: tuple[QuantityEntry, ...] = ()
    local_optima: LocalOptima | None = None
    effort: tuple[EffortEntry, ...] = ()
    notes: tuple[str, ...] = ()
