"""The tables that say what is asked of a scenario: check, optimum, compare, tune, study, report."""

from __future__ import annotations

from fractions import Fraction
from typing import Any, Literal

from pydantic import StrictBool, field_validator

from ..models.norms import NormWord
from .exact import Count, Exact, NotNegative, Positive, Seed, Sine, Text
from .table import Table

Profile = Literal["window", "gain"]
Interval = tuple[Exact, Exact]

MAX_SAMPLES = 2**30
"""Distinct points of the Sobol sequence that is drawn from."""

MAX_STARTS = 1000
"""Starts of the search for an optimum, each of them a whole search of a second or so."""


class CheckTable(Table):
    """[check]: which claims count, and how hard to look for counterexamples.

    `claims`: keys whose verdicts decide the exit code (default: schedule facts, R_min > 0,
    convergence, and the torque limit if one is given). `samples`: states drawn for the derivative
    bound. `rate`, rad/s, and `gain`, 1/s: half-width and largest gain of the sampled domain.
    `pe_window`: length T of the excitation window, s (default: longest zero run plus longest run of thrust).
    """

    claims: tuple[Text, ...] | None = None
    samples: Count = 2**20
    seed: Seed = 1
    rate: Positive = Fraction(2)
    gain: Positive = Fraction(10)
    pe_window: Positive | None = None

    @field_validator("samples")
    @classmethod
    def _distinct(cls, value: int) -> int:
        if value > MAX_SAMPLES:
            raise ValueError(f"expected at most {MAX_SAMPLES} (distinct points), received {value}")
        return value


class OptimumTable(Table):
    """[optimum]: the minimum-peak problem through the windows.

    `final_time`, s (default: the horizon). `norm` of the torque.
    `profile`: the thrust available is "window" (full inside each window) or "gain" (g).
    `attitude_tolerance`, `rate_tolerance`: largest |bv| and |w| (rad/s) at the end; both 0 is exact rest.
    `thrusters`: columns of torque per unit force, m, of one-sided thrusters (replaces the norm).
    `torque_limit`, N m: for minimum impulse and time, and for explaining why a problem is hopeless.
    """

    final_time: Exact | None = None
    norm: NormWord = "component"
    profile: Profile = "window"
    attitude_tolerance: Sine = Fraction(0)
    rate_tolerance: NotNegative = Fraction(0)
    thrusters: tuple[tuple[Exact, Exact, Exact], ...] | None = None
    torque_limit: Positive | None = None
    starts: Count = 4
    seed: Seed = 1

    @field_validator("starts")
    @classmethod
    def _affordable(cls, value: int) -> int:
        if value > MAX_STARTS:
            raise ValueError(
                f"expected at most {MAX_STARTS} (each start is a whole search), received {value}"
            )
        return value


class CompareTable(Table):
    """[compare]: torque norms in which every law is put beside the optimum."""

    norms: tuple[NormWord, ...] = ("component", "euclidean")
    profile: Profile = "window"


class TuneTable(Table):
    """[tune]: the least peak of a law that settles in time.

    `law`: label of the law (default: the first). `settle`: latest settling time, s. `bounds`: interval
    searched for each parameter, e.g. lambda = [0.05, 2.0]. `evaluations`: simulated candidates.
    """

    law: Text | None = None
    settle: Positive | None = None
    norm: NormWord = "component"
    bounds: dict[str, Interval] | None = None
    evaluations: Count = 2000
    seed: Seed = 1

    @field_validator("bounds")
    @classmethod
    def _ordered(cls, value: Any) -> Any:
        for name, (low, high) in (value or {}).items():
            if not 0 <= low <= high:
                raise ValueError(
                    f"{name}: expected [low, high] with 0 <= low <= high, "
                    f"received [{float(low):g}, {float(high):g}]"
                )
        return value


class StudyTable(Table):
    """[study]: a schedule study over `periods`, s, and `duty_cycles`, on-time per period in (0, 1)."""

    periods: tuple[Positive, ...] = ()
    duty_cycles: tuple[Positive, ...] = ()
    torque_limit: Positive | None = None

    @field_validator("duty_cycles")
    @classmethod
    def _below_one(cls, value: tuple[Fraction, ...]) -> tuple[Fraction, ...]:
        for duty in value:
            if duty >= 1:
                raise ValueError(f"a duty cycle must be < 1, received {float(duty):g}")
        return value


class ReportTable(Table):
    """[report]: what a report holds beside check, optimum and comparison.

    `audit`: the audit of the paper's printed equations. `front`: settling times, s, of a front of peak
    torque against settling time (default: no front), in the norm `front_norm`, each law of `front_laws`
    (default: all) searched with `front_evaluations` simulated candidates at each time.
    """

    audit: StrictBool = False
    front: tuple[Positive, ...] = ()
    front_laws: tuple[Text, ...] = ()
    front_norm: NormWord = "euclidean"
    front_evaluations: Count = 300
