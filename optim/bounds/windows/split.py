"""Where to cut a transfer that is bounded by components: after a coast that promises most."""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from math import floor, log2
from typing import final

import numpy as np

from ....verify.exact.ball import length
from ...problem import TransferProblem
from ..sets.chart import arc_to_identity
from ..sets.gauge import GaugeSet
from .coast import Coast
from .components import ComponentBounds, Sides, closing_cells, widths_of
from .drift import Cells, Growths, Nodes, Ways, nodes_of, opening_cells
from .travel import WindowTravel

_INSTANTS = 64
"""At least so many in a transfer, while the coast can be enclosed."""
_NODES = 48
"""Of the coast until the cut; as many as the checker takes."""
_BENT = 0.97
"""The shortest way over the straight one: shorter where it matters."""


@final
@dataclass(frozen=True)
class Split:
    """A transfer cut at the end of a coast.

    Attributes
    ----------
    coast : Coast
        From the start until the cut.
    sides : Sides
        What a peak allows on both sides.
    slack : Fraction
        Upper bound of the travel between the coast's end and the attitude written down.
    """

    coast: Coast
    sides: Sides
    slack: Fraction


@final
class Splits:
    """The cuts of one transfer."""

    def __init__(self, problem: TransferProblem, momenta: GaugeSet, windows: WindowTravel) -> None:
        self.problem, self.momenta, self.windows = problem, momenta, windows
        self._widths = np.array([float(w) for w in widths_of(momenta)[0]])
        inertia = problem.body.exact_inertia
        self._ends = [problem.terminal.rate * length(row)[1] for row in inertia]
        # at least each component of it, so that a small tolerance widens no box
        self.end = max(momenta.size_of_rate(problem.terminal.rate), *self._ends)
        self._inertia = length(x for row in inertia for x in row)[1]

    def at_rest(self, until: Fraction) -> Split:
        """Cut a transfer that starts at rest."""
        cells = opening_cells(self.windows, until, Growths.at_rest())
        sides = self._sides(cells, Ways.at_rest(cells), until)
        return Split(Coast(until, self.problem.attitude), sides, Fraction(0))

    def after(self, until: Fraction) -> Split | None:
        """Cut a transfer whose start moves; None if the coast or what grows on it cannot be followed."""
        nodes = nodes_of(self.problem, until / _NODES, _NODES)
        if len(nodes) < _NODES:
            return None
        cells = opening_cells(self.windows, until, Growths.along(nodes, self.momenta))
        if float(cells.area.sum()) < float(self.windows.opened_area(until)):
            return None
        coast = nodes.coasts[-1]
        sides = self._sides(cells, Ways.to_node(_NODES, nodes, cells, self.momenta), until)
        return Split(coast, sides, coast.turn * self._inertia)

    def _sides(self, cells: Cells, ways: Ways, until: Fraction) -> Sides:
        closing = closing_cells(self.problem.window, self.problem.horizon - until)
        ends = np.array([float(x) for x in self._ends])
        return Sides(self.momenta, self._widths, cells, ways, closing, float(self.end), ends)

    def promising(self, bounds: ComponentBounds, share: float, known: float) -> Split | None:
        """Cut where straight ways, a guess of the shortest, ask for the largest peak.

        None if the coast cannot be followed that far, or if not even straight ways ask for more than known.
        """
        step = Fraction(2) ** floor(log2(self.problem.horizon / _INSTANTS))
        nodes = nodes_of(self.problem, step, floor(self.problem.horizon / step))
        if not len(nodes):
            return None
        until = step * len(nodes)
        cells = opening_cells(self.windows, until, Growths.along(nodes, self.momenta))
        closing = closing_cells(self.problem.window, self.problem.horizon)
        last = (
            len(nodes)
            if cells.area.sum() >= float(self.windows.opened_area(until))
            else max(cells.stretch, default=0)
        )
        peaks = [self._promise(k, nodes, cells.before(k), closing, bounds, share) for k in range(1, last + 1)]
        best = int(np.argmax(peaks)) if peaks else -1
        return self.after(step * (best + 1)) if peaks and _BENT * peaks[best] > known else None

    def _promise(
        self, k: int, nodes: Nodes, cells: Cells, closing: np.ndarray, bounds: ComponentBounds, share: float
    ) -> float:
        """Peak that a straight way from node k would ask for."""
        rest = float(self.problem.horizon - k * nodes.step)
        after = closing[closing[:, 3] <= rest * (1 + 1e-12)]
        ends = np.array([float(x) for x in self._ends])
        ways = Ways.to_node(k, nodes, cells, self.momenta)
        sides = Sides(self.momenta, self._widths, cells, ways, after, float(self.end), ends)
        box = np.maximum(1 + share * (sides.components(bounds.rates, bounds.trial) - 1), 1.0)
        part = self.momenta.with_box([Fraction(float(b)) for b in box])
        q = np.array([float(c) for c in nodes.coasts[k].attitude])
        q /= np.linalg.norm(q)
        axis = q[1:] if q[1:].any() else np.array([1.0, 0.0, 0.0])
        straight = min(part.straight_travel(axis, 2 * arc_to_identity(s * q)) for s in self.problem.signs)
        allowed = sides.allowed(bounds.trial, bounds.rates, box)
        return float(bounds.trial * straight / allowed) if allowed > 0 else 0.0
