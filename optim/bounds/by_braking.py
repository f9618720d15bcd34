"""Path and momentum together: the transfer is compared with a coast that slows down.

Let the momentum s(t) H0, fixed in space, 0 <= s <= 1, move a body: that is the coast at the time
theta = int s. In the ball |H - H0| <= p up and |H| <= n = end + p dn, so for any s

    |H - s H0|^2 = s |H - H0|^2 + (1 - s) |H|^2 - s (1 - s) |H0|^2 <= rho^2,

and the distance e to it grows at most by rho + s mu e, mu that of `deviation`. So the travel from the
attitude after a coast of theta to the target is at most e at the end. s = 1 until an instant and 0 after
it is the bound after a coast; where p int w is hardly enough to absorb H0, rho is small all along.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import final

import numpy as np

from ...models.types import Array
from ...verify.exact.rounding import grid_near, rounded_down
from ..problem import TransferProblem
from .argument import BrakingArgument, NamedBound
from .potential.path import PathOptions
from .prepare import Measured
from .proof import path_of
from .sets.chart import arc_to_identity
from .windows.deviation import MAX_GROWTH, growth_of_deviations
from .windows.drift import MARGIN, nodes_of

CELLS = 64
"""Equal parts of a transfer, cut further at the window's knots; as many as the checker takes."""
_SLOPES = 33
_BENT = 0.99
"""The shortest way over the straight one."""


@final
@dataclass(frozen=True)
class Cells:
    """Cells of a transfer: length, up at the end, dn at the start (open time), each (n,)."""

    length: Array
    up: Array
    dn: Array
    start: float
    end: float
    growth: float

    @classmethod
    def of(cls, measured: Measured, growth: Fraction) -> Cells:
        """Cut a transfer."""
        windows, edges = measured.prepared.windows, _edges(measured.prepared.problem)
        return cls(
            np.array([float(b - a) for a, b in pairwise(edges)]),
            np.array([float(windows.up(b)) for b in edges[1:]]),
            np.array([float(windows.total - windows.up(a)) for a in edges[:-1]]),
            rounded_down(measured.start[0]),
            float(measured.end) * MARGIN,
            float(growth) * MARGIN,
        )

    def rho(self, p: float, s: Array) -> Array:
        """Upper bounds of |H - s H0|, (..., n)."""
        away, back = p * self.up, self.end + p * self.dn
        square = s * away**2 + (1 - s) * back**2 - s * (1 - s) * self.start**2
        return np.asarray(np.sqrt(np.maximum(square + 1e-13 * (away**2 + back**2 + self.start**2), 0.0)))

    def factors(self, s: Array) -> Array:
        """exp(mu int s) from the start of each cell on."""
        return np.asarray(np.exp(np.minimum(self.growth * np.cumsum((s * self.length)[::-1])[::-1], 200.0)))

    def distance(self, p: float, s: Array) -> float:
        """Upper bound of e at the end."""
        return float((self.rho(p, s) * self.length * self.factors(s)).sum() * MARGIN)

    def shares(self, p: float, slope: float) -> Array:
        """The s that keep rho least where a coast of one second more is worth `slope`."""
        grid = np.linspace(0.0, 1.0, 65)[:, None]
        rho, weight = self.rho(p, grid), np.ones(len(self.length))
        s = np.zeros(len(self.length))
        for _ in range(3):
            s = grid[(rho * weight - slope * grid).argmin(axis=0), 0]
            weight = self.factors(s)
        return s


def _edges(problem: TransferProblem) -> list[Fraction]:
    marks = {problem.horizon * k / CELLS for k in range(CELLS + 1)}
    return sorted(marks | set(problem.window.knots))


def by_braking(measured: Measured, options: PathOptions, known: Fraction, name: str) -> NamedBound | None:
    """Bound of a start that moves, in the ball; None if not even straight ways ask for more than known."""
    problem, windows = measured.prepared.problem, measured.prepared.windows
    mu = growth_of_deviations(measured.momenta, measured.prepared.momentum).distance
    if problem.starts_at_rest or not windows.total:
        return None
    cells = Cells.of(measured, mu)
    at_least = float(known * measured.radius[1]) / _BENT
    chosen = _promising(measured, cells, at_least)
    if chosen is None:
        return None
    shares = tuple(grid_near(Fraction(float(s)), 20) for s in chosen)
    lengths = (b - a for a, b in pairwise(_edges(problem)))
    theta = sum((s * x for s, x in zip(shares, lengths, strict=True)), Fraction(0))
    nodes = nodes_of(problem, theta, 1)
    if not len(nodes) or mu * theta > MAX_GROWTH:
        return None
    coast = nodes.coasts[-1]
    path = path_of(problem, coast.attitude, measured.momenta, options)
    slack = measured.momenta.size_of_rate(coast.turn)
    peak = _largest_peak(cells, chosen, rounded_down(path.travel - slack))
    argument = BrakingArgument(measured, path, coast, shares, mu, slack)
    return NamedBound(name, Fraction(peak) / measured.radius[1], argument)


def _promising(measured: Measured, cells: Cells, at_least: float) -> Array | None:
    """Shares for which straight ways, a guess of the shortest, ask for the largest peak, above `at_least`."""
    problem, momenta = measured.prepared.problem, measured.momenta
    step = problem.horizon / 96
    nodes = nodes_of(problem, step, 96)
    travels = []
    for coast in nodes.coasts:
        q = np.array([float(c) for c in coast.attitude])
        q /= np.linalg.norm(q)
        axis = q[1:] if q[1:].any() else np.array([1.0, 0.0, 0.0])
        travels.append(min(momenta.straight_travel(axis, 2 * arc_to_identity(x * q)) for x in problem.signs))
    times = float(step) * np.arange(len(travels))

    def impossible(p: float) -> Array | None:
        for slope in np.linspace(-1.0, 1.0, _SLOPES) * cells.start:
            s = cells.shares(p, slope)
            theta = float(s @ cells.length)
            if 0 < theta <= times[-1] and cells.distance(p, s) < np.interp(theta, times, travels):
                return s
        return None

    low, high, best = at_least, 4 * at_least, impossible(at_least)
    if best is None:
        return None
    for _ in range(14):
        middle = (low * high) ** 0.5
        found = impossible(middle)
        low, high, best = (middle, high, found) if found is not None else (low, middle, best)
    return best


def _largest_peak(cells: Cells, shares: Array, travel: float) -> float:
    """Largest p found whose distance is at most the travel: it grows with p."""
    low, high = 0.0, 1.0
    rounded = np.round(shares * 2**20) / 2**20
    if cells.distance(0.0, rounded) > travel:
        return 0.0
    while cells.distance(high, rounded) <= travel and high < 1e300:
        low, high = high, 2 * high
    while cells.distance(high, rounded) > travel and high > 1e-300 and low == 0.0:
        high /= 2
    low, high = (high, 2 * high) if low == 0.0 else (low, high)
    for _ in range(60):
        middle = (low + high) / 2
        low, high = (middle, high) if cells.distance(middle, rounded) <= travel else (low, middle)
    return low if cells.distance(low, rounded) <= travel else 0.0
