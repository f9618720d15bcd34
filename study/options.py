"""What may be asked of a study beyond its scenario: stated once, for the command line and for calls.

Nothing heavy is imported here: `intermit --help` reads these words.
"""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any, Literal, final

NormKey = Literal["component", "euclidean", "thrusters"]
SolverKey = Literal["auto", "fast", "reference"]


def _says(words: str) -> dict[str, str]:
    """The help of an option, kept beside its default."""
    return {"help": words}


def help_of(options: type[Any], name: str) -> str:
    """Words of one option, as `intermit COMMAND --help` shows them.

    Raises
    ------
    StopIteration
        If there is no such option: a fault of this package.
    """
    return str(next(f.metadata["help"] for f in fields(options) if f.name == name))


@final
@dataclass(frozen=True, kw_only=True)
class CheckOptions:
    """What a check does beyond its claims.

    Attributes
    ----------
    simulate : run every law from the initial state
    margins : look for how far schedule and lambda may change before convergence is no longer certified
    search : look for the worst start by simulation
    workers : processes; the result does not depend on it
    """

    simulate: bool = field(default=True, metadata=_says("Run every law from the initial state too."))
    margins: bool = field(default=True, metadata=_says("Look for how far the schedule may change."))
    search: bool = field(default=True, metadata=_says("Look for the worst start by simulation."))
    workers: int = field(default=1, metadata=_says("Processes; the result is the same."))


@final
@dataclass(frozen=True, kw_only=True)
class OptimumOptions:
    """What to solve beyond what the scenario says.

    Attributes
    ----------
    norms : norms to solve in; empty for both, or the thrusters alone if the scenario names some
    starts, seed : the multi-start search; None for the scenario's own
    solver : "auto" is the fast one with the reference as fallback
    mesh_gap : largest fraction of the peak that finer cells may still gain
    bound : compute the certified lower bound beside each optimum
    least_time, least_impulse : find the least transfer time, the least impulse, within the limit too
    """

    norms: tuple[NormKey, ...] = field(
        default=(),
        metadata=_says("component, euclidean or thrusters; repeat for several (default: both)."),
    )
    starts: int | None = field(default=None, metadata=_says("Starts for each quaternion sign of the target."))
    seed: int | None = field(default=None, metadata=_says("Seed of the first random start."))
    solver: SolverKey = field(
        default="auto", metadata=_says("fast: convex programs; reference: nonlinear program (IPOPT).")
    )
    mesh_gap: float = field(
        default=1e-6, metadata=_says("Largest fraction of the peak that finer cells may still gain.")
    )
    bound: bool = field(default=True, metadata=_says("Certify a lower bound beside each optimum."))
    least_time: bool = field(
        default=False, metadata=_says("Find the least transfer time within the torque limit too.")
    )
    least_impulse: bool = field(
        default=False, metadata=_says("Find the least impulse within the torque limit too.")
    )


@final
@dataclass(frozen=True, kw_only=True)
class CompareOptions:
    """How laws are put beside the optimum.

    Attributes
    ----------
    at_horizon : a law that does not settle is compared too: with the least peak that comes as near to the
        target as it did by the horizon
    """

    at_horizon: bool = field(
        default=False,
        metadata=_says("Compare a law that does not settle by how near it comes at the horizon."),
    )


@final
@dataclass(frozen=True, kw_only=True)
class ReportOptions:
    """What a report holds beside the check.

    Attributes
    ----------
    optimum : the least peak any controller could do with, for the scenario's final time
    comparison : each law against the optimum for its own settling time
    front, audit : False leaves out what the scenario's [report] asks for
    check : what the check does beyond its claims; its `workers` share the points of a front too
    """

    optimum: bool = field(default=True, metadata=_says("Find the optimum."))
    comparison: bool = field(default=True, metadata=_says("Compare each law with its optimum."))
    front: bool = field(default=True, metadata=_says("The front that the scenario's [report] asks for."))
    audit: bool = field(default=True, metadata=_says("The audit that the scenario's [report] asks for."))
    check: CheckOptions = field(default_factory=CheckOptions)


@final
@dataclass(frozen=True, kw_only=True)
class TuneOptions:
    """What a search of a law's parameters is given in place of the scenario's [tune].

    Attributes
    ----------
    norm : of the peak that is made small
    law : label
    seed : of the search
    """

    norm: Literal["component", "euclidean"] | None = field(
        default=None, metadata=_says("Norm of the torque: component or euclidean.")
    )
    law: str | None = field(default=None, metadata=_says("Law to tune (default: the first)."))
    seed: int | None = field(default=None, metadata=_says("Seed of the search."))
