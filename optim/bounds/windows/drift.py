r"""How far torque takes a body from its coast, component by component, in cells of time.

Let the coast have the attitude C and the body momentum h, the body R and H, and D = H - h in body
components. The path s -> R(s) C(s)' C(c), s in [0, c], leads from C(c) to R(c), with the momentum
J Q J^-1 D(s), Q = C(c)' C(s): a rotation that the coast alone decides. And

    D' = torque + X(h) D + D x J^-1 D,      X(h) y = h x J^-1 y - (J^-1 h) x y.

With |X(h)_ij| <= G_ij (i != j), X(h)_ii <= G_ii, nu the growth of the gauge N of K under X(h), and
|(Y x J^-1 Y)_i| <= kappa_i for Y in K, |Y_j| <= B_j, |Y_i| >= floor,

    N(D) <= p n,   n' = w + nu n,        |D_i| <= p m_i,   m' = w (1, 1, 1) + G m + kappa p n^2.

Over up = int w that is n/up <= scale and m_i/up <= rise_i + p (swell kappa)_i: at rest 1, 1 and
int up^2/up. Between two nodes of the coast h and Q are within (step^2/8) |h''|, (step^2/8) |Q''| of
the chord, |h''| <= 2 |h| w^2, |Q''| <= 2 w^2 for w = |J^-1| |h|. All in floats, rounded up by a margin
that covers every operation; the checker does the same in rationals.
"""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from fractions import Fraction
from itertools import pairwise
from typing import Any, final

import numpy as np

from ....models.laws import FreeMotion
from ....models.schedule.polynomial import ZERO
from ....models.simulation import Phase
from ....models.types import Array
from ....verify.exact.ball import ball, exact_above
from ....verify.flow.run_enclosure import EnclosedRun, ExactStart, NoEnclosureError
from ...problem import TransferProblem
from ..sets.gauge import GaugeSet
from .coast import Coast, near_unit, rounded_coast
from .travel import WindowTravel

CELLS = 96
MARGIN = 1 + 1e-10
"""Of a few hundred float operations on numbers >= 0, generously."""
_FINEST = 1e-13
_MOST_GROWTH = 0.5
"""Growth within a cell beyond which a coast is not followed."""


@final
@dataclass(frozen=True)
class Nodes:
    """A coast at equal steps from the start.

    Attributes
    ----------
    step : Fraction
        s.
    coasts : tuple of Coast
        Where it leads; the start itself first.
    frames : array (n, 3, 3)
        Rotation matrices, body to space.
    turns : array (n,)
        Rotation angles between those and the coast, rad, at most.
    momenta : array (n, 3)
        Body momentum, N m s.
    off : array (n,)
        Its distance from that of the coast, at most.
    """

    step: Fraction
    coasts: tuple[Coast, ...]
    frames: Array
    turns: Array
    momenta: Array
    off: Array

    def __len__(self) -> int:
        """Return the number of steps."""
        return len(self.coasts) - 1


def nodes_of(problem: TransferProblem, step: Fraction, count: int) -> Nodes:
    """Enclose the coast of a start that moves at so many steps, or as many as can be enclosed."""
    run = EnclosedRun(FreeMotion(), problem.body, ExactStart(near_unit(problem.attitude), problem.rate))
    found, momenta, off = [Coast(Fraction(0), problem.attitude)], [_momentum(problem, run.state[4:7])], []
    off.append(momenta[0][1])
    for start, end in pairwise(step * k for k in range(count + 1)):
        try:
            run.cross(Phase(start, end, start, (ZERO,)))
        except NoEnclosureError:
            break
        found.append(rounded_coast(end, run.state[:4]))
        momenta.append(_momentum(problem, run.state[4:7]))
        off.append(momenta[-1][1])
    frames = np.array([_frame([float(c) for c in coast.attitude]) for coast in found])
    turns = np.array([float(coast.turn) for coast in found]) + _FINEST
    return Nodes(step, tuple(found), frames, turns, np.array([H for H, _ in momenta]), np.array(off))


def _momentum(problem: TransferProblem, rate: list[Any]) -> tuple[list[float], float]:
    """J w as floats, and how far it may be off."""
    H = [
        sum((ball(x) * w for x, w in zip(row, rate, strict=True)), ball(0))
        for row in problem.body.exact_inertia
    ]
    middle = [float(x.mid()) for x in H]
    away = sum((exact_above(abs(x - ball(m))) for x, m in zip(H, middle, strict=True)), Fraction(0))
    return middle, float(away) * MARGIN


def _frame(q: list[float]) -> Array:
    """Rotation matrix of a quaternion of any length."""
    s, r = q[0], np.array(q[1:])
    return np.asarray(np.eye(3) + 2 * (s * _skew(r) + _skew(r) @ _skew(r)) / (s * s + r @ r))


def _skew(a: Array) -> Array:
    return np.array([[0.0, -a[2], a[1]], [a[2], 0.0, -a[0]], [-a[1], a[0], 0.0]])


@final
@dataclass(frozen=True)
class Growths:
    """What grows between neighbouring nodes: G (n, 3, 3) and nu (n,), 1/s."""

    components: Array
    gauge: Array

    @classmethod
    def at_rest(cls) -> Growths:
        """Nothing, in one stretch."""
        return cls(np.zeros((1, 3, 3)), np.zeros(1))

    @classmethod
    def along(cls, nodes: Nodes, momenta: GaugeSet) -> Growths:
        """Bound both along a coast."""
        inverse = momenta.body.inverse_inertia
        bases = np.array([_skew(h) @ inverse - _skew(inverse @ h) for h in np.eye(3)])
        size, turn = _size_and_turn(nodes, momenta)
        chord = size * (float(nodes.step) * turn) ** 2 / 4
        off = chord + np.maximum(nodes.off[1:], nodes.off[:-1]) + _FINEST * size
        X = np.einsum("nk,kij->nij", nodes.momenta, bases)
        X = np.where(np.eye(3, dtype=bool), np.maximum(X, 0.0), np.abs(X))
        reach = np.sqrt((bases**2).sum(axis=0))
        components = np.maximum(X[1:], X[:-1]) + off[:, None, None] * reach
        M, levels = momenta.float_rows
        parts = np.einsum("rij,kjl->rkil", M, bases)
        parts = (parts + parts.transpose(0, 1, 3, 2)) / 2
        ends = np.sqrt((np.einsum("nk,rkij->nrij", nodes.momenta, parts) ** 2).sum(axis=(2, 3)) * 2 / 3)
        rest = np.sqrt((parts**2).sum(axis=(1, 2, 3)) * 2 / 3)
        rates = (np.maximum(ends[1:], ends[:-1]) + off[:, None] * rest) * levels[0] / levels
        return cls(components * MARGIN, rates.max(axis=1) * MARGIN)


def _size_and_turn(nodes: Nodes, momenta: GaugeSet) -> tuple[float, float]:
    """Return |h| of a coast and an upper bound of |J^-1 h|; the checker's own is 3^(1/8) times the norm."""
    size = float(np.linalg.norm(nodes.momenta[0])) + nodes.off[0]
    return size * MARGIN, 1.15 * float(np.linalg.norm(momenta.body.inverse_inertia, 2)) * size


@final
@dataclass(frozen=True)
class Cells:
    """Parts of [0, c]: int up (n,), scale (n,), rise (n, 3), swell (n, 3, 3), and their stretch."""

    area: Array
    scale: Array
    rise: Array
    swell: Array
    stretch: Array

    def before(self, stretch: int) -> Cells:
        """Return the cells of the first stretches."""
        used = self.stretch < stretch
        return Cells(self.area[used], self.scale[used], self.rise[used], self.swell[used], self.stretch[used])


def opening_cells(windows: WindowTravel, until: Fraction, growths: Growths) -> Cells:
    """Bound n and m on cells of [0, until]; they end early where something grows too fast for them."""
    count = len(growths.gauge)
    n, m, Z, plain = 0.0, np.zeros(3), np.zeros((3, 3)), True
    rows: list[tuple[float, float, Array, Array, int]] = []
    for a, b in pairwise(_edges(windows, until, count)):
        up, area = windows.up(a), windows.opened_area(b) - windows.opened_area(a)
        if area == 0:
            continue
        stretch = min(int(a * count / until), count - 1) if until else 0
        X, x = growths.components[stretch] * float(b - a), growths.gauge[stretch] * float(b - a)
        if max(X.sum(axis=1).max(), x) > _MOST_GROWTH:
            break
        E, e = np.eye(3) + X + X @ X / 2 + X.sum(axis=1).max() ** 3 / 5, 1 + x + x * x / 2 + x**3 / 4
        plain = plain and not X.any() and not x
        before, opened = float(up), float(windows.up(b) - up)
        scale = e * (n / before if up else 1.0) * MARGIN
        rise = E @ (m / before if up else np.ones(3)) * MARGIN
        square = windows.opened_square(b)
        Z = E @ (Z + scale * scale * float(square - windows.opened_square(a)) * np.eye(3))
        ratio = float(min(windows.opened_area(b), square / up) if up else windows.opened_area(b))
        swell = ratio * np.eye(3) if plain else Z / before if up else scale * scale * ratio * E
        n, m = e * (n + opened), E @ (m + opened)
        rows.append((float(area) * MARGIN, scale, rise, swell * MARGIN, stretch))
    return Cells(
        np.array([row[0] for row in rows]),
        np.array([row[1] for row in rows]),
        np.array([row[2] for row in rows]).reshape(-1, 3),
        np.array([row[3] for row in rows]).reshape(-1, 3, 3),
        np.array([row[4] for row in rows], dtype=int),
    )


def _edges(windows: WindowTravel, until: Fraction, count: int) -> list[Fraction]:
    inside = {k for k in windows.window.knots if 0 < k < until}
    marks = {until * k / parts for parts in (CELLS, count) for k in range(parts + 1)}
    return sorted(marks | inside)


@final
@dataclass(frozen=True)
class Ways:
    """J Q J^-1 on cells, near a mean of two ends (n, 2, 3, 3), within `bend` (n,) in the spectral norm."""

    ends: Array
    bend: Array

    @classmethod
    def at_rest(cls, cells: Cells) -> Ways:
        """Return those of a body that stays where it is."""
        count = len(cells.area)
        return cls(np.broadcast_to(np.eye(3), (count, 2, 3, 3)), np.zeros(count))

    @classmethod
    def to_node(cls, k: int, nodes: Nodes, cells: Cells, momenta: GaugeSet) -> Ways:
        """Compute those to node k."""
        J, inverse = momenta.body.inertia, momenta.body.inverse_inertia
        A = J @ (nodes.frames[k].T @ nodes.frames) @ inverse
        turn = _size_and_turn(nodes, momenta)[1]
        off = (float(nodes.step) * turn) ** 2 / 4 + nodes.turns + nodes.turns[k] + _FINEST
        i = cells.stretch
        bend = np.linalg.norm(J) * np.linalg.norm(inverse) * np.maximum(off[i], off[i + 1])
        return cls(np.stack([A[i], A[i + 1]], axis=1), bend * MARGIN)


def box_for(ratios: Iterable[float], share: float) -> tuple[Fraction, Fraction, Fraction]:
    """Half widths between 1 and the largest ratios; steps of 1/50 let sweeps share their potentials."""
    x, y, z = (max(Fraction(round((1 + share * (float(r) - 1)) * 50), 50), Fraction(1)) for r in ratios)
    return x, y, z
