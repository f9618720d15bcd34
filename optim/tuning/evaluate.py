"""From candidate parameters to peak and settling: a whole generation simulated at once."""

from __future__ import annotations

from concurrent.futures import Executor
from fractions import Fraction

import numpy as np

from ...models.ensemble import EnsembleResult, MetricOptions, Tolerances, simulate_ensemble
from ...models.laws import Law
from ...models.mission import Mission
from ...models.norms import Norm
from ...models.types import Array
from .search import Outcomes
from .space import with_parameters

SEARCHING = Tolerances(rtol=1e-7, atol=1e-9, phase_evaluations=3000)
"""Accuracy while searching; what is reported is simulated again. A candidate too stiff for this fails."""
LATE_POINTS = 65
"""Instants after the settling time asked for at which a run is looked at."""


class EnsembleRuns:
    """Evaluates candidates as an ensemble.

    Parameters
    ----------
    law : the law whose parameters are varied
    mission : its work
    settle : settling time asked for, s
    norm : of the peak
    executor : workers that share the runs of a generation, optional
    """

    def __init__(
        self, law: Law, mission: Mission, *, settle: Fraction, norm: Norm, executor: Executor | None = None
    ) -> None:
        # one period more than asked for: what leaves the tolerances again has not settled
        self._horizon = min(settle + (mission.schedule.period or Fraction(0)), max(mission.horizon, settle))
        self._law, self._mission, self._norm, self._settle = law, mission, norm, settle
        self._executor = executor
        late = np.linspace(float(settle), float(self._horizon), LATE_POINTS)
        self._late = np.unique(late)

    def __call__(self, candidates: list[dict[str, Fraction]]) -> Outcomes:
        """Simulate all candidates."""
        mission = self._mission
        result = simulate_ensemble(
            [with_parameters(self._law, c) for c in candidates],
            mission.body,
            mission.schedule,
            np.concatenate([mission.start.quaternion, mission.start.rate]),
            horizon=self._horizon,
            times=self._late,
            tolerances=SEARCHING,
            metrics=MetricOptions.within(mission.tolerance, (self._norm,)),
            executor=self._executor,
        )
        assert result.metrics is not None
        peak = result.metrics.peak[self._norm]
        excess = self._excess(result)
        failed = ~result.completed | ~np.isfinite(peak)
        return Outcomes(np.where(failed, np.inf, peak), np.where(failed, np.inf, excess))

    def _excess(self, result: EnsembleResult) -> Array:
        """log10 of the largest ratio to a tolerance from the settling time on."""
        attitude = np.linalg.norm(result.states[:, :, 1:4], axis=2) / float(self._mission.tolerance.attitude)
        rate = np.linalg.norm(result.states[:, :, 4:7], axis=2) / float(self._mission.tolerance.rate)
        worst = np.log10(np.maximum(np.maximum(attitude, rate).max(axis=1), 1e-300))
        assert result.metrics is not None
        settling = result.metrics.settling_time
        # a crossing between the late instants shows in the settling time, not on the grid
        late = np.where(np.isnan(settling), np.inf, settling) > float(self._settle)
        return np.asarray(np.where(late, np.maximum(worst, 1e-3), np.minimum(worst, 0.0)))
