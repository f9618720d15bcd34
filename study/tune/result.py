"""What a search of a law's parameters found, as `intermit.tune` returns it."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import TYPE_CHECKING, Any, final

import numpy as np

from ...errors import InputError
from ...models.laws import Law
from ...models.types import Array
from ...optim.comparison.measure import LawRun
from ...optim.tuning.search import SearchHistory
from ...optim.tuning.tune import Tuned
from ...reports.content.blocks import Axis, Chart, Line
from ...reports.summary import Shown, Summary
from ...scenario import Scenario
from ..plots import draw, needed

if TYPE_CHECKING:
    from numpy.typing import NDArray


@final
@dataclass(frozen=True, eq=False, repr=False)
class TuningStudy(Shown):
    """One law's search in a scenario.

    Attributes
    ----------
    scenario : what was searched in
    tuned : the outcome, with every candidate
    """

    scenario: Scenario
    tuned: Tuned

    @property
    def law(self) -> Law | None:
        """The best law that settles in time and is certified; None where none was found."""
        return self.tuned.law

    @property
    def parameters(self) -> Mapping[str, Fraction]:
        """Its parameters by name, exact; empty where no law was found."""
        return {} if self.law is None else self.law.parameters

    @property
    def history(self) -> SearchHistory:
        """Every candidate in the order tried, `.trials`, and the seed."""
        return self.tuned.history

    @cached_property
    def run(self) -> LawRun | None:
        """Its accurate run; None where no law was found."""
        return self.tuned.run(self.scenario.mission)

    @property
    def peak(self) -> float | None:
        """Peak torque of the accurate run in the norm of the search, N m."""
        return None if self.run is None else self.run.peak(self.tuned.norm)

    @property
    def settling(self) -> float | None:
        """Settling time of the accurate run, s."""
        return None if self.run is None else self.run.figures.settling

    @property
    def summary(self) -> Summary:
        """The answer and its parameters, or why there is none."""
        tuned = self.tuned
        title = f"{tuned.label} in {self.scenario.name}, settled by {float(tuned.settle):g} s"
        settled = len(self.history.settled_by_peak)
        tried = f"{len(self.history.trials)} candidates simulated, {settled} of them settle in time."
        if self.peak is None or self.settling is None:
            return Summary(title, (f"No answer: {tuned.reason}.", tried))
        found = f"Peak {self.peak:.6g} N m ({tuned.norm.key}), settled at {self.settling:.6g} s."
        rows = [(name, f"{float(value):.9g}") for name, value in self.parameters.items()]
        return Summary(title, (found, tried), ((("parameter", "value"), rows),))

    def plot(self) -> NDArray[np.object_]:
        """Draw the least peak so far, N m, against candidates simulated; matplotlib axes, (1,).

        Raises
        ------
        InputError
            If no candidate settled in time.
        """
        best: Array = np.array(self.history.best_so_far)
        known = np.flatnonzero(np.isfinite(best))
        if not known.size:
            raise InputError(f"nothing to draw: {self.tuned.reason}")
        line = Line("least peak so far", (known + 1).astype(float), best[known])
        title = f"Search of {self.tuned.label}"
        y = Axis(f"least peak, {self.tuned.norm.key}", "N m", log=True)
        return draw([Chart("search", title, Axis("candidates simulated"), y, (line,), "")])

    def to_dataframe(self) -> Any:
        """Every candidate as a pandas DataFrame: its parameters, peak (N m), whether it settles in time.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        rows = [
            {name: float(value) for name, value in trial.parameters}
            | {"peak [N m]": trial.peak, "settles": trial.settles}
            for trial in self.history.trials
        ]
        return needed("pandas", "to_dataframe()").DataFrame(rows)
