"""Seeded global search for the least peak of a law that settles in time."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass
from fractions import Fraction
from typing import final

import numpy as np

from ...models.types import Array, Interrupted, Progress, silent
from .space import SearchSpace

Evaluate = Callable[[list[dict[str, Fraction]]], "Outcomes"]
"""From candidates to outcomes, many at once."""


@final
@dataclass(frozen=True, eq=False)
class Outcomes:
    """What candidates did, arrays of one length.

    Attributes
    ----------
    peak : peak applied torque, N m (inf for a run that failed)
    excess : log10 of the largest ratio of |bv| or |w| to its tolerance at or after the settling
        time asked for; <= 0 means settled in time (inf for a run that failed)
    """

    peak: Array
    excess: Array


@final
@dataclass(frozen=True)
class Trial:
    """One simulated candidate."""

    parameters: tuple[tuple[str, Fraction], ...]
    peak: float
    excess: float

    @property
    def settles(self) -> bool:
        """Whether it settled in time."""
        return self.excess <= 0


@final
@dataclass(frozen=True)
class SearchHistory:
    """All candidates in the order tried, and the seed they follow from."""

    trials: tuple[Trial, ...]
    seed: int

    @property
    def settled_by_peak(self) -> tuple[Trial, ...]:
        """Candidates that settle in time, least peak first."""
        return tuple(sorted((t for t in self.trials if t.settles), key=lambda t: t.peak))

    @property
    def best_so_far(self) -> tuple[float, ...]:
        """Least peak of a settling candidate after each trial; inf until there is one."""
        return tuple(np.minimum.accumulate([t.peak if t.settles else np.inf for t in self.trials]).tolist())


@final
@dataclass(frozen=True, kw_only=True)
class DifferentialEvolution:
    """scipy's differential evolution on whole generations, twice: everywhere, then near the best.

    A candidate that does not settle is worse than every one that does, and among themselves
    those are ordered by how far outside they end. Generations are large because an ensemble
    costs little more than one run.

    Attributes
    ----------
    evaluations : simulated candidates in the global stage
    population : candidates per generation
    seed : of every random draw
    polish : simulated candidates in the local stage, in a box of +-`reach` of the unit cube
    reach : half-width of that box
    """

    evaluations: int = 2000
    population: int = 100
    seed: int = 1
    polish: int = 1000
    reach: float = 0.05

    def __post_init__(self) -> None:
        if self.evaluations < self.population or self.population < 5 or self.polish < 0:
            raise ValueError(
                f"expected evaluations >= population >= 5 and polish >= 0, received "
                f"{self.evaluations}, {self.population}, {self.polish}"
            )

    def run(
        self,
        space: SearchSpace,
        evaluate: Evaluate,
        *,
        start: Array | None = None,
        progress: Progress | None = None,
    ) -> SearchHistory:
        """Search the space; `start` (n,) in the unit cube joins the first generation.

        Raises
        ------
        Interrupted
            With the history so far, where the user interrupts.
        """
        trials: list[Trial] = []
        dimension = len(space.ranges)
        tell, work = progress if progress is not None else silent, self.evaluations + self.polish

        def score(points: Array) -> Array:
            tell(f"{len(trials)} of {work} candidates", min(len(trials) / work, 1.0))
            candidates = [space.decode(p) for p in points.reshape(dimension, -1).T]
            outcomes = evaluate(candidates)
            trials.extend(
                Trial(tuple(c.items()), float(p), float(e))
                for c, p, e in zip(candidates, outcomes.peak, outcomes.excess, strict=True)
            )
            return np.where(outcomes.excess <= 0, outcomes.peak, _UNSETTLED * (1 + _finite(outcomes.excess)))

        whole = np.tile([0.0, 1.0], (dimension, 1))
        try:
            best = self._evolve(score, whole, self.evaluations, start)
            if self.polish >= self.population:
                near = np.clip(np.stack([best - self.reach, best + self.reach], axis=1), 0, 1)
                self._evolve(score, near, self.polish, best)
        except KeyboardInterrupt:
            left = f"{len(trials)} of {work} candidates were simulated"
            raise Interrupted(SearchHistory(tuple(trials), self.seed), left) from None
        return SearchHistory(tuple(trials), self.seed)

    def _evolve(
        self, score: Callable[[Array], Array], box: Array, evaluations: int, start: Array | None
    ) -> Array:
        """Best point of one stage, (n,)."""
        from scipy.optimize import differential_evolution

        found = differential_evolution(
            score, box, maxiter=max(evaluations // self.population - 1, 1), init=self._first(box, start),
            rng=self.seed, polish=False, vectorized=True, updating="deferred", tol=0, atol=1e-6,
        )  # fmt: skip
        return np.asarray(found.x, dtype=float)

    def _first(self, box: Array, start: Array | None) -> Array:
        """Scrambled Sobol points in the box, seeded, the start among them."""
        from scipy.stats import qmc

        count = 1 << (self.population - 1).bit_length()
        unit = qmc.Sobol(len(box), rng=self.seed).random(count)[: self.population]
        points = box[:, 0] + unit * (box[:, 1] - box[:, 0])
        if start is not None:
            points[0] = start
        return np.asarray(points)


_UNSETTLED = 1e9


def _finite(excess: Array) -> Array:
    return np.where(np.isfinite(excess), np.maximum(excess, 0), 1e6)
