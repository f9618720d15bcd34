"""Peak torque against settling time: what a law can reach, and what anyone could."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from concurrent.futures import Executor, Future
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING, Any, final

from ...models.laws import Law
from ...models.mission import Mission
from ...models.norms import Norm
from ..comparison.equal_terms import check_order
from ..comparison.measure import LawRun
from ..problem import TransferProblem
from .search import DifferentialEvolution
from .tune import Certify, Tuned, tune

if TYPE_CHECKING:
    from ..bounds.bound import LowerBound
    from ..peak import PeakAnswer


@final
@dataclass(frozen=True, eq=False)
class BestPossible:
    """Optimum and certified bound for one transfer time.

    Attributes
    ----------
    settle : transfer time, s
    optimum : least peak found, N m, or None if no answer passed its checks
    bound : certified lower bound, N m
    """

    settle: Fraction
    optimum: float | None
    bound: float
    answer: PeakAnswer
    certificate: LowerBound


@final
@dataclass(frozen=True, eq=False)
class Front:
    """The trade-off over a grid of settling times.

    Attributes
    ----------
    settles : settling times, s
    best : optimum and bound at each
    laws : by label, the law tuned for each settling time
    runs : by label, the accurate run of each (None where nothing was found)
    """

    norm: Norm
    settles: tuple[Fraction, ...]
    best: tuple[BestPossible, ...]
    laws: Mapping[str, tuple[Tuned, ...]]
    runs: Mapping[str, tuple[LawRun | None, ...]]


def best_possible(mission: Mission, settle: Fraction, norm: Norm) -> BestPossible:
    """Optimum and certified bound for the mission's terminal balls at a given time."""
    from ..bounds.bound import certified_lower_bound
    from ..peak import minimum_peak
    from ..peak.search.result import Standing

    problem = TransferProblem.of(mission, norm, horizon=settle)
    answer = minimum_peak(problem)
    certificate = certified_lower_bound(problem)
    optimum = answer.peak if answer.standing is Standing.CHECKED else None
    check_order(certificate.value, optimum, None, what=f"{float(settle):g} s, {norm.key}")
    return BestPossible(settle, optimum, certificate.value, answer, certificate)


def pareto_front(
    laws: Mapping[str, Law],
    mission: Mission,
    settles: Sequence[Fraction],
    *,
    norm: Norm,
    method: DifferentialEvolution | None = None,
    certify: Mapping[str, Certify] | None = None,
    executor: Executor | None = None,
) -> Front:
    """Tune each law for each settling time, and put the optimum and its bound beside it.

    The points are independent and go to the executor's workers where one is given; the result
    does not depend on it. `certify` has one entry per label, of functions that can be pickled.
    """
    conditions = dict(certify or {})
    jobs = {
        label: [
            _submit(
                executor, tune, law, mission, settle=settle, norm=norm, label=label, method=method,
                certify=conditions.get(label),
            )
            for settle in settles
        ]
        for label, law in laws.items()
    }  # fmt: skip
    best = [_submit(executor, best_possible, mission, settle, norm) for settle in settles]
    tuned = {label: tuple(t.result() for t in row) for label, row in jobs.items()}
    runs = {label: tuple(t.run(mission) for t in row) for label, row in tuned.items()}
    front = Front(norm, tuple(settles), tuple(b.result() for b in best), tuned, runs)
    for label, row in runs.items():
        for found, run in zip(front.best, row, strict=True):
            law_peak = run.peak(norm) if run is not None else None
            check_order(found.bound, found.optimum, law_peak, what=f"{label}, {float(found.settle):g} s")
    return front


def _submit(executor: Executor | None, work: Any, *args: Any, **keywords: Any) -> Future[Any]:
    """Hand work to the executor, or do it now."""
    if executor is not None:
        return executor.submit(work, *args, **keywords)
    done: Future[Any] = Future()
    done.set_result(work(*args, **keywords))
    return done
