"""The optimum job: the least peak torque through a scenario's windows, in each norm asked for."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from fractions import Fraction
from functools import partial
from typing import TYPE_CHECKING

from ...models.norms import NORMS, Norm, thrusters
from ...models.types import Interrupted, Progress, silent
from ...optim.problem import Terminal, TransferProblem, WindowProfile
from ...scenario import Scenario
from ..options import OptimumOptions, SolverKey
from .coasting_start import after_coast
from .result import Optimum, OptimumStudy

if TYPE_CHECKING:
    from ...optim.bounds import LowerBound
    from ...optim.peak import PeakAnswer
    from ...optim.peak.search.options import LocalSolver

INVERSION_ALLOWANCE = 1e-7
"""A checked history misses the end by up to 1e-8 rad, which this much of the peak more than covers."""


class BoundInversionError(RuntimeError):
    """A feasible history below its certified bound: one of the two is wrong, and the run must stop."""


def run_optimum(
    scenario: Scenario, options: OptimumOptions | None = None, progress: Progress | None = None
) -> OptimumStudy:
    """Find the least peak of the scenario's transfer in each norm.

    Raises
    ------
    Interrupted
        With the study so far, where the user interrupts after the first norm.
    """
    options = options if options is not None else OptimumOptions()
    tell = progress if progress is not None else silent
    norms = norms_asked(scenario, options)
    optima: list[Optimum] = []
    _needs_a_limit(scenario, options, norms)
    for i, norm in enumerate(norms):
        done = partial(_share, tell, i, len(norms))
        try:
            optima.append(_solved(scenario, norm, options, done))
        except KeyboardInterrupt:
            if not optima:
                raise
            missing = ", ".join(n.name for n in norms[i:])
            raise Interrupted(
                OptimumStudy(scenario, options, tuple(optima)), f"not finished: {missing}"
            ) from None
    tell("done", 1.0)
    return OptimumStudy(scenario, options, tuple(optima))


def _share(tell: Progress, number: int, count: int, stage: str, share: float) -> None:
    """Tell the progress of one of several like parts."""
    tell(stage, (number + share) / count)


def _solved(scenario: Scenario, norm: Norm, options: OptimumOptions, tell: Progress) -> Optimum:
    """The least peak in one norm, and what is asked beside it."""
    from ...optim.peak import MultiStart, Refinement, minimum_impulse, minimum_peak, minimum_time
    from ...optim.peak.search.explain import explain

    table = scenario.optimum
    search = MultiStart(
        starts=table.starts if options.starts is None else options.starts,
        seed=table.seed if options.seed is None else options.seed,
    )
    refinement, quick = Refinement(mesh_gap=options.mesh_gap), Refinement(mesh_gap=1e-5)
    tell(f"optimum, {norm.key}", 0.0)
    stated = transfer(scenario, norm)
    problem, _ = after_coast(scenario, stated)
    limit = limit_of(scenario, norm)
    hopeless = explain(stated, limit)
    answer = minimum_peak(problem, solver=_solver(options.solver), search=search, refinement=refinement)
    tell(f"certified bound, {norm.key}", 0.4)
    bound = _bound(stated, answer, options)
    least = None
    if options.least_time and limit is not None and hopeless is None:
        tell(f"least time, {norm.key}", 0.5)
        least = minimum_time(problem, limit, search=replace(search, starts=1), refinement=quick)
    spent = None
    if options.least_impulse and limit is not None and hopeless is None:
        tell(f"least impulse, {norm.key}", 0.8)
        few = replace(search, starts=min(2, search.starts))
        spent = minimum_impulse(problem, limit, search=few)
    return Optimum(problem, answer, limit, hopeless, bound, least, spent, stated)


def _needs_a_limit(scenario: Scenario, options: OptimumOptions, norms: Sequence[Norm]) -> None:
    """Refuse a question within a limit where no limit is given for any norm.

    Raises
    ------
    ScenarioError
        Naming the key that is missing.
    """
    from ...scenario import ScenarioError

    asked = [name for name in ("least_time", "least_impulse") if getattr(options, name)]
    if asked and all(limit_of(scenario, norm) is None for norm in norms):
        words = " and ".join(name.replace("_", " ") for name in asked)
        raise ScenarioError(
            f"{scenario.path.name}: optimum.torque_limit",
            f"is needed for the {words} (norm {', '.join(norm.key for norm in norms)})",
        )


def norms_asked(scenario: Scenario, options: OptimumOptions | None = None) -> tuple[Norm, ...]:
    """Norms to solve in, the scenario's own first."""
    if options is not None and options.norms:
        return tuple(norm_of(scenario, key) for key in options.norms)
    if scenario.optimum.thrusters is not None:
        return (norm_of(scenario, "thrusters"),)
    own = NORMS[scenario.optimum.norm]
    return (own, *(norm for norm in NORMS.values() if norm != own))


def norm_of(scenario: Scenario, key: str) -> Norm:
    """The norm a key names.

    Raises
    ------
    ScenarioError
        If thrusters are asked for and the scenario names none, or none that gives a torque.
    """
    from ...scenario import ScenarioError

    if key in NORMS:
        return NORMS[key]
    where = f"{scenario.path.name}: optimum.thrusters"
    if scenario.optimum.thrusters is None:
        raise ScenarioError(where, "is needed for the peak thruster force: give one axis a thruster")
    try:
        return thrusters(scenario.optimum.thrusters)
    except ValueError as error:
        raise ScenarioError(where, str(error)) from None


MAX_TRANSFER_WINDOWS = 2000
"""Windows of a transfer that is solved: the search takes several cells, and their derivatives, for each."""


def require_few_windows(scenario: Scenario, windows: int, horizon: Fraction) -> None:
    """Refuse a transfer through more windows than can be solved.

    Raises
    ------
    ScenarioError
        With their number.
    """
    from ...scenario import ScenarioError

    if windows > MAX_TRANSFER_WINDOWS:
        raise ScenarioError(
            f"{scenario.path.name}: optimum.final_time",
            f"{windows} windows open before {float(horizon):g} s, and each is resolved: give a final time "
            f"with at most {MAX_TRANSFER_WINDOWS}",
        )


def transfer(scenario: Scenario, norm: Norm) -> TransferProblem:
    """State the scenario's transfer: start, windows, final time, tolerances; long idle ends left out."""
    return transfer_and_origin(scenario, norm)[0]


def transfer_and_origin(scenario: Scenario, norm: Norm) -> tuple[TransferProblem, Fraction]:
    """State the scenario's transfer, and the instant from which its time counts, s.

    Raises
    ------
    ScenarioError
        If there are more windows before the final time than can be solved.
    """
    table, horizon = scenario.optimum, final_time(scenario)
    require_few_windows(scenario, scenario.schedule.windows_before(horizon), horizon)
    problem = TransferProblem.of(
        scenario.mission,
        norm,
        horizon=horizon,
        terminal=Terminal(attitude=table.attitude_tolerance, rate=table.rate_tolerance),
        profile=WindowProfile.GAIN if table.profile == "gain" else WindowProfile.FULL,
    )
    return problem.without_idle()


def idle_words(scenario: Scenario, problem: TransferProblem) -> str:
    """Say which idle ends were left out, or nothing."""
    stated, origin = transfer_and_origin(scenario, problem.norm)
    _, coasted = after_coast(scenario, stated)
    end = origin + coasted + problem.horizon
    words = []
    if origin > 0:
        words.append(
            f"a body at rest stays so until the first window: times count from t = {float(origin):.10g} s"
        )
    if coasted > 0:
        words.append(
            f"without torque the body turns freely until the first window, integrated once: start and times "
            f"are those of t = {float(coasted):.10g} s (the certified bound is that of the whole transfer)"
        )
    if end < final_time(scenario):
        words.append(f"a body at rest after the last window stays so: solved until t = {float(end):.10g} s")
    return "; ".join(words)


def final_time(scenario: Scenario) -> Fraction:
    """Final time asked for, else the settling time asked of the laws, else the horizon, s."""
    if scenario.optimum.final_time is not None:
        return scenario.optimum.final_time
    return scenario.horizon if scenario.tune.settle is None else scenario.tune.settle


def limit_of(scenario: Scenario, norm: Norm) -> float | None:
    """Limit given for a norm: the optimum's own for the norm it names, else the scenario's."""
    table, key = scenario.optimum, norm.key
    own = "thrusters" if table.thrusters is not None else table.norm
    if table.torque_limit is not None and key == own:
        return float(table.torque_limit)
    limit = scenario.mission.limit
    return float(limit.torque) if limit is not None and limit.norm == norm else None


def _bound(problem: TransferProblem, answer: PeakAnswer, options: OptimumOptions) -> LowerBound | None:
    """Certified lower bound, never computed from the answer; their order is enforced.

    Raises
    ------
    BoundInversionError
        If a checked history has a peak below the bound.
    """
    from ...optim.bounds import certified_lower_bound
    from ...optim.peak import Standing

    if not options.bound or answer.history is None:
        return None
    bound = certified_lower_bound(problem)
    if answer.standing is Standing.CHECKED and bound.value > answer.peak * (1.0 + INVERSION_ALLOWANCE):
        raise BoundInversionError(
            f"the optimum found, {answer.peak:.9g} {bound.unit}, lies below its certified bound "
            f"{bound.value:.9g} {bound.unit} ({bound.name})"
        )
    return bound


def _solver(key: SolverKey) -> LocalSolver | None:
    from ...optim.peak import NonlinearProgram, SequentialConvex

    if key == "auto":
        return None
    return SequentialConvex() if key == "fast" else NonlinearProgram()
