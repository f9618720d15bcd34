"""One law's run from a scenario's initial state, as `intermit.simulate` returns it."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any, final

import numpy as np

from ..errors import InputError
from ..models.simulation import Figures, Trajectory
from ..models.types import Array
from ..reports.content.blocks import Axis, Chart, Line
from ..reports.numbers import write
from ..reports.summary import Shown, Summary
from ..scenario import Scenario
from .plots import TIME, components, draw, needed, windows_of
from .simulated_run import Run, metrics, run_entry

if TYPE_CHECKING:
    from numpy.typing import NDArray


@final
@dataclass(frozen=True, repr=False, eq=False)
class Simulation(Shown):
    """A run to the scenario's horizon, sampled at its output step; n instants.

    Attributes
    ----------
    scenario : what was simulated
    label : of the law
    run : the run itself; `run.trajectory` has the dense states at any time
    """

    scenario: Scenario
    label: str
    run: Run

    @property
    def trajectory(self) -> Trajectory:
        """The dense run: `state(t)` (8 or so,) or (8, m), `signals(t)`; t in s.

        Raises
        ------
        InputError
            If the run stopped before the horizon, with the reason.
        """
        if self.run.trajectory is None:
            raise InputError(f"{self.label}: {self.run.failure}")
        return self.run.trajectory

    @property
    def figures(self) -> Figures:
        """Settling time, s; torque peaks, N m; impulse, N m s; least filter state, s.

        Raises
        ------
        InputError
            If the run stopped before the horizon, with the reason.
        """
        if self.run.figures is None:
            raise InputError(f"{self.label}: {self.run.failure}")
        return self.run.figures

    @cached_property
    def _arrays(self) -> dict[str, Array]:
        _ = self.trajectory
        return run_entry(self.scenario, self.run, "run", self.label)[1]

    @property
    def time(self) -> Array:
        """Instants, (n,), s."""
        return self._arrays["run.time"]

    @property
    def quaternion(self) -> Array:
        """Error attitude, unit quaternion, scalar first, (n, 4)."""
        return self._arrays["run.quaternion"]

    @property
    def angle(self) -> Array:
        """Error angle 2 acos |b0|, (n,), rad."""
        q = self.quaternion
        return np.asarray(2.0 * np.arctan2(np.linalg.norm(q[:, 1:], axis=1), np.abs(q[:, 0])))

    @property
    def rate(self) -> Array:
        """Body rate, body frame, (n, 3), rad/s."""
        return self._arrays["run.rate"]

    @property
    def command(self) -> Array:
        """Commanded torque u, body frame, (n, 3), N m."""
        return self._arrays["run.command"]

    @property
    def torque(self) -> Array:
        """Applied torque g u, body frame, (n, 3), N m."""
        return self._arrays["run.torque"]

    @property
    def gain(self) -> Array:
        """Thruster availability g, (n,), 0 to 1."""
        return self._arrays["run.gain"]

    @property
    def controller(self) -> dict[str, Array]:
        """Controller states by name, (n,) each: R in s, k in 1/s."""
        prefix = "run.controller."
        return {k.removeprefix(prefix): v for k, v in self._arrays.items() if k.startswith(prefix)}

    @property
    def summary(self) -> Summary:
        """The figures of the run, as `intermit check` prints them."""
        title = f"{self.label} in {self.scenario.name}"
        if self.run.trajectory is None:
            return Summary(title, (self.run.failure,))
        rows = [(entry.name.replace("_", " "), write(entry).ascii) for entry in metrics(self.run)]
        line = f"Simulated from the initial state over [0, {float(self.scenario.horizon):g}] s."
        return Summary(title, (line,), ((("Figure", self.label), rows),))

    def plot(self) -> NDArray[np.object_]:
        """Draw error angle (deg), body rate (rad/s) and applied torque (N m); matplotlib axes, (3,)."""
        t, shaded = self.time, windows_of(self.scenario.schedule, self.scenario.horizon)
        angle = (Line(self.label, t, np.degrees(self.angle)),)
        charts = [
            Chart("angle", self.label, TIME, Axis("error angle", "deg"), angle, "", shaded),
            Chart("rate", "Body rate", TIME, Axis("w", "rad/s"), components(t, self.rate), "", shaded),
            Chart(
                "torque", "Applied torque", TIME, Axis("g u", "N m"), components(t, self.torque), "", shaded
            ),
        ]
        return draw(charts)

    def to_dataframe(self) -> Any:
        """All histories as a pandas DataFrame, one row an instant; units stand in the columns' names.

        Raises
        ------
        ImportError
            If pandas is not installed.
        """
        columns: dict[str, Array] = {"time [s]": self.time, "g": self.gain}
        for name, values, axes, unit in (
            ("b", self.quaternion, "0123", ""), ("w", self.rate, "xyz", " [rad/s]"),
            ("u", self.command, "xyz", " [N m]"), ("gu", self.torque, "xyz", " [N m]"),
        ):  # fmt: skip
            columns |= {f"{name}{axis}{unit}": values[:, i] for i, axis in enumerate(axes)}
        return needed("pandas", "to_dataframe()").DataFrame(columns | self.controller)
