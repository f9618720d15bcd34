"""The base of every table in a scenario file."""

from __future__ import annotations

from pydantic import BaseModel, ConfigDict


class Table(BaseModel):
    """A table of the file: frozen, unknown keys refused, defaults stated in the class."""

    model_config = ConfigDict(frozen=True, extra="forbid", arbitrary_types_allowed=True)
