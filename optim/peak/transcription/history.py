"""The torque history an optimum is: plain numbers in the user's units, independent of any solver."""

from __future__ import annotations

from dataclasses import dataclass
from functools import cached_property
from typing import final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ....models.norms import Norm
from ....models.types import Array


@final
@dataclass(frozen=True)
class TorqueHistory:
    """torque(t) = w(t) B control_k on cell k, body frame, N m; zero outside the windows.

    Attributes
    ----------
    edges : (n + 1,)
        Cell edges, s.
    profile : (n, d + 1)
        w on each cell in s = (t - start) / length, lowest power first; zero outside the windows.
    control : (n, m)
        Control on each cell, in the norm's unit; zero outside the windows.
    norm : Norm
        What the control's effort is measured in.
    """

    edges: Array
    profile: Array
    control: Array
    norm: Norm

    @cached_property
    def base_torque(self) -> Array:
        """B control, torque before the factor w, (n, 3), N m."""
        return np.asarray(self.control @ self.norm.control_matrix.T)

    @cached_property
    def peak(self) -> float:
        """Largest effort of any cell: the least p with effort(control) <= p on every open cell."""
        return float(self.norm.effort(self.control[self.open]).max(initial=0.0))

    @property
    def open(self) -> NDArray[np.bool_]:
        """Whether the cell lies in a window, (n,)."""
        return np.asarray(np.any(self.profile != 0.0, axis=1))

    @cached_property
    def impulse(self) -> float:
        """Integral of w consumption(control) over the transfer: N m s (N s for thrusters)."""
        share = self.profile @ (1.0 / np.arange(1, self.profile.shape[1] + 1))
        spent = np.where(self.open, self.norm.consumption(self.control), 0.0)
        return float((np.diff(self.edges) * share * spent).sum())

    def torque(self, t: ArrayLike) -> Array:
        """Torque at times t (...,) in s, (..., 3), N m; at an edge that of the cell after it."""
        return np.asarray(self.window(t)[..., None] * self.base_torque[self._cell(t)])

    def window(self, t: ArrayLike) -> Array:
        """W at times t (...,) in s, (...,); at an edge that of the cell after it."""
        cell = self._cell(t)
        s = (np.asarray(t, dtype=float) - self.edges[cell]) / np.diff(self.edges)[cell]
        return np.asarray(
            (self.profile[cell] * s[..., None] ** np.arange(self.profile.shape[1])).sum(axis=-1)
        )

    def _cell(self, t: ArrayLike) -> NDArray[np.int64]:
        found = np.searchsorted(self.edges, np.asarray(t, dtype=float), side="right") - 1
        return np.asarray(np.clip(found, 0, len(self.control) - 1))
