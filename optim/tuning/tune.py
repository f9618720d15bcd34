"""The least peak of a law that settles in time, under certified conditions."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.laws import Law
from ...models.mission import Mission
from ...models.norms import Norm
from ...models.simulation import SimulationError
from ...models.types import Progress
from ..comparison.measure import LawRun, run_law
from .choose import least_passing
from .evaluate import EnsembleRuns
from .search import DifferentialEvolution, SearchHistory, Trial
from .space import SearchSpace, with_parameters

Certify = Callable[[Law], str | None]
"""Certified conditions: None if they hold for a law, else the reason why not."""

ATTEMPTS = 20
"""Candidates that are put to the certified conditions before giving up."""


@final
@dataclass(frozen=True, eq=False)
class Tuned:
    """Outcome of a search: plain data, so that a worker process can send it back.

    Attributes
    ----------
    law : the best candidate that settles and is certified, or None
    history : every candidate tried
    refused : (candidate, reason) of better ones that were turned down, least peak first
    reason : why `law` is None
    """

    label: str
    settle: Fraction
    norm: Norm
    law: Law | None
    history: SearchHistory
    refused: tuple[tuple[Trial, str], ...]
    reason: str = ""

    def run(self, mission: Mission) -> LawRun | None:
        """Accurate run of the answer: the reported numbers come from it, not from the search."""
        return None if self.law is None else run_law(self.label, self.law, mission)


def tune(
    law: Law,
    mission: Mission,
    *,
    settle: Fraction,
    norm: Norm,
    label: str = "",
    ranges: Mapping[str, tuple[Fraction, Fraction]] | None = None,
    method: DifferentialEvolution | None = None,
    certify: Certify | None = None,
    start_from_law: bool = True,
    progress: Progress | None = None,
) -> Tuned:
    """Search a law's parameters for the least peak torque that settles by `settle`.

    Parameters
    ----------
    law : Law
        Its positive parameters are varied.
    mission : Mission
        What it has to do: body, windows, start, tolerances, horizon.
    settle : Fraction
        Latest settling time, s.
    norm : Norm
        Of the peak that is made small.
    label : str
        Name in the result; the law's own without one.
    ranges : mapping, optional
        (low, high) by parameter; a factor of 30 either way of the given value by default.
    method : DifferentialEvolution, optional
        The search and its effort; its defaults without one.
    certify : callable, optional
        Conditions the answer must meet.
    start_from_law : bool
        Whether the law's own parameters are the first candidate.
    progress : Progress, optional
        Is told how many candidates are simulated.

    Returns
    -------
    Tuned
        The reported run is simulated again at full accuracy, and must settle there too. The
        search is global but not exhaustive: an upper bound on what the law can do.
    """
    name = label or law.name
    space = SearchSpace.around(law, ranges)
    method = method if method is not None else DifferentialEvolution()
    evaluate = EnsembleRuns(law, mission, settle=settle, norm=norm)
    start = space.encode(law.parameters) if start_from_law else None
    history = method.run(space, evaluate, start=start, progress=progress)
    candidates = _distinct(history.settled_by_peak)
    reasons: dict[int, str] = {}

    def passes(number: int) -> bool:
        chosen = with_parameters(law, dict(candidates[number].parameters))
        reason = _failure(name, chosen, mission, settle) or (certify(chosen) if certify is not None else None)
        if reason is not None:
            reasons[number] = reason
        return reason is None

    points = np.array([space.encode(dict(trial.parameters)) for trial in candidates])
    best = None
    if candidates:
        hint = int(np.argmin(np.linalg.norm(points - space.encode(law.parameters), axis=1)))
        best = least_passing(points, passes, attempts=ATTEMPTS, hint=hint)
    refused = tuple((candidates[i], reasons[i]) for i in sorted(reasons) if best is None or i < best)
    if best is not None:
        chosen = with_parameters(law, dict(candidates[best].parameters))
        return Tuned(name, settle, norm, chosen, history, refused)
    why = "no candidate settles in time"
    if candidates:
        why = f"of {len(candidates)} that settle {len(refused)} were put to the conditions: none meets them"
    return Tuned(name, settle, norm, None, history, refused, why)


def _failure(name: str, law: Law, mission: Mission, settle: Fraction) -> str | None:
    """Why an accurate run does not confirm what the search saw, or None."""
    try:
        run = run_law(name, law, mission)
    except SimulationError as error:
        return str(error)
    if run.figures.settling is None or run.figures.settling > settle:
        return "settles later than asked when simulated accurately"
    return None


def _distinct(trials: tuple[Trial, ...]) -> list[Trial]:
    seen: dict[tuple[tuple[str, Fraction], ...], Trial] = {}
    for trial in trials:
        seen.setdefault(trial.parameters, trial)
    return list(seen.values())
