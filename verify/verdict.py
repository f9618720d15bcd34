"""Claims, verdicts and the evidence under them.

A *claim* has one verdict, the strongest its evidence allows. Sampling is evidence under a
claim, never a claim of its own, and never makes PROVED.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import Enum
from typing import Literal, final


class Verdict(Enum):
    """Three answers and no fourth.

    PROVED: a theorem's conditions, or a certificate, checked in exact or outward-rounded arithmetic.
    REFUTED: a witness re-evaluated in such arithmetic violates the claim, its violation excluding 0.
    UNDECIDED: neither; the claim carries the reason and the next step.
    """

    PROVED = "PROVED"
    REFUTED = "REFUTED"
    UNDECIDED = "UNDECIDED"

    @property
    def exit_code(self) -> int:
        """Exit code this verdict asks for: 0, 1 or 3."""
        return {"PROVED": 0, "REFUTED": 1, "UNDECIDED": 3}[self.value]


class EvidenceKind(Enum):
    """What kind of support a claim has, strongest first."""

    CERTIFICATE = "certificate"
    THEOREM = "theorem"
    WITNESS = "witness"
    SAMPLES = "samples"


@final
@dataclass(frozen=True)
class Quantity:
    """A number known to lie in [low, high]; low == high only if it is exact.

    Attributes
    ----------
    rigorous : bool
        True if [low, high] is an enclosure (exact or outward rounded), False for an ordinary
        floating-point figure, whose spread is then an estimate.
    side : "both", "lower" or "upper"
        "lower": what is stated is that the true value is >= low (shown rounded down); "upper": that
        it is <= high (shown rounded up).
    """

    name: str
    low: float
    high: float
    unit: str = ""
    label: str = ""
    rigorous: bool = False
    side: Literal["both", "lower", "upper"] = "both"

    def __post_init__(self) -> None:
        if not self.low <= self.high:
            raise ValueError(f"quantity {self.name}: low {self.low} exceeds high {self.high}")

    @classmethod
    def point(cls, name: str, value: float, unit: str = "", *, digits: int = 9, label: str = "") -> Quantity:
        """A floating-point figure believed to `digits` significant digits."""
        spread = abs(value) * 0.5 * 10.0 ** (1 - digits)
        return cls(name, value - spread, value + spread, unit, label)


@final
@dataclass(frozen=True)
class Witness:
    """A state or instant that violates a claim, with the violation enclosed away from zero."""

    description: str
    values: dict[str, float | list[float]]
    violation: Quantity


@final
@dataclass(frozen=True)
class Evidence:
    """One piece of support: what was done, by which method, with how much effort (counted, not timed)."""

    kind: EvidenceKind
    summary: str
    source: str = ""
    details: Mapping[str, object] = field(default_factory=dict)


@final
@dataclass(frozen=True)
class Claim:
    """A statement with its verdict.

    Attributes
    ----------
    key : str
        Stable name used in scenario files and on the command line, e.g. "filter.floor".
    statement : str
        What is claimed, in one sentence, with the numbers put in.
    counted : bool
        Whether it decides the exit code; sufficient conditions are reported but not counted.
    reason, next_step : str
        For UNDECIDED: why, and what the user can do.
    """

    key: str
    title: str
    statement: str
    verdict: Verdict
    evidence: tuple[Evidence, ...] = ()
    quantities: tuple[Quantity, ...] = ()
    margins: tuple[Quantity, ...] = ()
    witness: Witness | None = None
    reason: str = ""
    next_step: str = ""
    source: str = ""
    counted: bool = True

    def __post_init__(self) -> None:
        kinds = {e.kind for e in self.evidence}
        if self.verdict is Verdict.PROVED and not kinds & {EvidenceKind.THEOREM, EvidenceKind.CERTIFICATE}:
            raise ValueError(f"claim {self.key}: PROVED needs a theorem or a certificate")
        if self.verdict is Verdict.REFUTED and self.witness is None:
            raise ValueError(f"claim {self.key}: REFUTED needs a witness")
        if self.verdict is Verdict.REFUTED and self.witness is not None:
            low, high = self.witness.violation.low, self.witness.violation.high
            if not self.witness.violation.rigorous or low <= 0 <= high:
                raise ValueError(f"claim {self.key}: the witness's violation must be rigorous and exclude 0")
        if self.verdict is Verdict.UNDECIDED and not (self.reason and self.next_step):
            raise ValueError(f"claim {self.key}: UNDECIDED needs a reason and a next step")
