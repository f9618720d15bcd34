"""What is known of a law's parameter: its unit, the values it may take, and what it is.

It stands once, beside the field: scenario files, tables, records and reports read it there.
"""

from __future__ import annotations

from dataclasses import dataclass, fields, is_dataclass
from fractions import Fraction
from typing import Literal, final

Bound = Literal["", ">= 0", "> 0"]
_KEY = "intermit.parameter"


@final
@dataclass(frozen=True)
class Parameter:
    """One parameter of a law.

    Attributes
    ----------
    name : as scenario files write it ("lambda", not "lambda_")
    unit : SI; empty for a pure number or where the law does not say
    bound : what its values must satisfy; empty for any number
    says : what it is, in a few words
    default : exact, or None where it must be given
    """

    name: str
    unit: str = ""
    bound: Bound = ""
    says: str = ""
    default: Fraction | None = None

    def require(self, value: Fraction) -> None:
        """Raise ValueError with the bound and the value unless the value satisfies the bound."""
        holds = {"": True, ">= 0": value >= 0, "> 0": value > 0}[self.bound]
        if not holds:
            raise ValueError(f"must be {self.bound}, received {float(value):g}")


def known(unit: str = "", bound: Bound = "", says: str = "") -> dict[str, Parameter]:
    """Metadata of a law's field: `lambda_: Fraction = field(metadata=known("1/s", "> 0", "bandwidth"))`."""
    return {_KEY: Parameter("", unit, bound, says)}


def parameters_of(law: object) -> dict[str, Parameter]:
    """What is known of the parameters of a law or of its class, by name, in the order of its fields."""
    found: dict[str, Parameter] = {}
    if not is_dataclass(law):
        return found
    for field in fields(law):
        stated = field.metadata.get(_KEY, Parameter(""))
        name = field.name.rstrip("_")
        given = field.default
        default = Fraction(given) if isinstance(given, (int, float, Fraction)) else None
        found[name] = Parameter(name, stated.unit, stated.bound, stated.says, default)
    return found
